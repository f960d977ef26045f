// SPDX-License-Identifier: Apache-2.0
// The state of long work: a line on standard error, for people, only where that is a terminal; and an end to it when its time is
// up.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace relief {

struct ProgressOptions {
    std::string name;                   ///< of what is baked: its path, as messages quote it
    bool drawn = true;                  ///< false: no line
    std::optional<float> seconds = {};  ///< that may pass from here to finish(); none: any
};

/// The line names the stage, how much of it is done where that is known, and how long it has taken. It is drawn ten times
/// a second, by a thread of its own, and not in the first half second: short work shows none.
///
/// When the time is up, that thread removes the temporary files of outputs, reports an error (kLimit) that names the stage,
/// and ends the program with its exit code. The import worker ends with the program.
///
/// All members are for the thread that made it, but set(), which any may call.
class Progress {
  public:
    /// Throws std::system_error where no thread can be had to draw or to watch the time.
    explicit Progress(ProgressOptions options);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    /// As finish().
    ~Progress();

    /// \param stage  "planning the maps"
    void begin(const std::string& stage);
    /// \param share  of the stage that is done, in [0, 1].
    void set(double share);
    /// Prints something else, which the line gives way to.
    void print(const std::function<void()>& print);
    /// Wipes the line; from here on the time is no longer limited. For the moment before the first output is written, so
    /// that of several outputs all are new or none.
    void finish();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relief
