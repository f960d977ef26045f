// SPDX-License-Identifier: Apache-2.0
// This program run again, several times at once: each in a process group of its own, which shares nothing with this
// process but its arguments, so that a crash affects that child alone.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <csignal>
#include <string>
#include <vector>

#include "formats/base/descriptor.h"
#include "formats/base/process.h"
#include "formats/base/result.h"

namespace relief {

/// How a child ended.
struct ChildEnd {
    std::size_t tag = 0;  ///< as given to start()
    pid_t pid = 0;
    int exit_code = 0;  ///< valid if signal is 0
    int signal = 0;     ///< that ended it
    double ms = 0.0;    ///< from its start
    std::string out;    ///< its standard output: the end of it, at most kChildOutputMax
    std::string err;    ///< its standard error: the end of it, at most kChildErrorMax
};

inline constexpr std::size_t kChildOutputMax = std::size_t{64} << 20;
inline constexpr std::size_t kChildErrorMax = std::size_t{64} << 10;

/// Signals that ask this process to end (INT, TERM, HUP) are held back while one of these lives, and returned by
/// askedToEnd(); ignored ones stay ignored. Use one at a time, and from one thread.
class ChildProcesses {
  public:
    ChildProcesses();
    ChildProcesses(const ChildProcesses&) = delete;
    ChildProcesses& operator=(const ChildProcesses&) = delete;
    /// Ends what still runs, as endAll().
    ~ChildProcesses();

    /// Runs this same program again. Its standard input is empty. If this process dies, it is ended too; where
    /// memory runs out, the system ends it before others.
    /// \param arguments  without the program's name.
    /// Errors: kFailure: no process, or no pipe.
    [[nodiscard]] Result<void> startSelf(const std::vector<std::string>& arguments, std::size_t tag);

    [[nodiscard]] std::size_t running() const;

    /// Waits until a child has ended, a signal arrives, or a while has passed.
    /// \return the children that have ended.
    [[nodiscard]] std::vector<ChildEnd> wait(std::chrono::milliseconds at_most);

    /// The signal that asked this process to end, 0 if none did. Looks without waiting.
    [[nodiscard]] int askedToEnd();

    /// Ends all children and theirs: politely, and after a second by force. \return how they ended.
    std::vector<ChildEnd> endAll();

    /// For the start of main(): a process that startSelf() has started ends with the process that started it (SIGTERM).
    static void endWithRecipe();

    /// After everything is cleaned up: ends this process by the signal that asked for it.
    [[noreturn]] static void endBySignal(int signal);

  private:
    struct Child;

    /// Waits for a signal. \return whether one came.
    bool takeSignal(std::chrono::nanoseconds at_most);
    void collect(std::vector<ChildEnd>& ended);

    std::vector<Child> children_;
    int asked_ = 0;
    sigset_t wanted_{};
    sigset_t mask_before_{};
};

}  // namespace relief
