// SPDX-License-Identifier: Apache-2.0
// Progress of long work: a line on standard error if that is a terminal, and an optional time limit.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace relief {

struct ProgressOptions {
    std::string name;                   ///< quoted path of the input file
    bool drawn = true;                  ///< false: never draw the line
    std::optional<float> seconds = {};  ///< time limit from construction to finish(); nullopt: none
};

/// The line shows the stage, its progress if known, and the elapsed time. A thread draws it ten times per second, after
/// the first half second, so short work shows no line.
///
/// At the time limit, the thread removes temporary output files, reports an error (kLimit) that names the stage, and
/// exits with the code of the error. The import worker ends with the program.
///
/// Only the creating thread may call the members, except set(), which is thread-safe.
class Progress {
  public:
    /// Throws std::system_error if it cannot start a thread.
    explicit Progress(ProgressOptions options);
    /// Calls finish().
    ~Progress();

    /// Starts a stage. \param stage  "planning the maps".
    void begin(const std::string& stage);
    /// \param fraction  completed fraction of the stage, in [0, 1].
    void set(double fraction);
    /// Clears the line and calls `print`.
    void print(const std::function<void()>& print);
    /// Clears the line and ends the time limit. Call it before writing the first output, so that a timeout never leaves
    /// a mix of old and new outputs.
    void finish();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relief
