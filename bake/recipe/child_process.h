// SPDX-License-Identifier: Apache-2.0
// Runs this program several times concurrently. Each child has its own process group, and shares only its arguments
// with this process, so that a crash affects only that child.
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

struct ChildEnd {
    std::size_t tag = 0;  ///< as passed to start()
    pid_t pid = 0;
    int exit_code = 0;  ///< valid if signal is 0
    int signal = 0;     ///< signal that ended the child; 0: it exited
    double ms = 0.0;    ///< duration
    std::string out;    ///< standard output: the last kChildOutputMax bytes
    std::string err;    ///< standard error: the last kChildErrorMax bytes
};

inline constexpr std::size_t kChildOutputMax = std::size_t{64} << 20;
inline constexpr std::size_t kChildErrorMax = std::size_t{64} << 10;

/// Starts and waits for children. While an object exists, signals that request termination (INT, TERM, HUP) are
/// deferred, and returned by terminationSignal(); ignored signals remain ignored. Only one object may exist at a time,
/// used by one thread.
class ChildProcesses {
  public:
    ChildProcesses();
    ChildProcesses(const ChildProcesses&) = delete;
    ChildProcesses& operator=(const ChildProcesses&) = delete;
    /// Ends running children, like endAll().
    ~ChildProcesses();

    /// Starts this program with other arguments. The child's standard input is empty. The child ends if this process
    /// dies. If memory runs out, the system ends the child before other processes.
    /// \param arguments  without the program's name.
    /// Errors: kFailure (no process or no pipe).
    [[nodiscard]] Result<void> startSelf(const std::vector<std::string>& arguments, std::size_t tag);

    [[nodiscard]] std::size_t running() const;

    /// Waits until a child ends, a signal arrives, or the time is up.
    /// \return the children that have ended.
    [[nodiscard]] std::vector<ChildEnd> wait(std::chrono::milliseconds at_most);

    /// Returns the signal that requested termination, or 0. Does not wait.
    [[nodiscard]] int terminationSignal();

    /// Ends all children and their descendants: by SIGTERM, and after a second by SIGKILL. \return how they ended.
    std::vector<ChildEnd> endAll();

    /// Call it at the start of main(): a process started by startSelf() then ends (SIGTERM) when its parent does.
    static void endWithParent();

    /// Ends this process with the signal that requested termination. Call it after cleanup.
    [[noreturn]] static void endBySignal(int signal);

  private:
    struct Child;

    /// Waits for a signal. \return whether one arrived.
    bool takeSignal(std::chrono::nanoseconds at_most);
    void collect(std::vector<ChildEnd>& ended);

    std::vector<Child> children_;
    int termination_signal_ = 0;
    sigset_t wanted_{};
    sigset_t mask_before_{};
};

}  // namespace relief
