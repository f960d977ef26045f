// SPDX-License-Identifier: Apache-2.0
// Other programs, started and waited for.
#pragma once

#include <sys/types.h>

#include <csignal>
#include <string>
#include <utility>
#include <vector>

#include "formats/base/descriptor.h"

namespace relief {

/// What a program is started with. It has this process's environment and working folder, and handles no signal.
struct ProcessStart {
    std::string program;                 ///< a path; a name without '/' is looked for on PATH
    std::vector<std::string> arguments;  ///< its own name first
    /// files[n], borrowed, becomes its descriptor n; -1 stands for /dev/null. It gets no other descriptor.
    std::vector<int> files;
    /// Signals that this process ignores: false: SIGPIPE has its default action, the others stay ignored (as by
    /// nohup); true: all have their default actions.
    bool reset_ignored_signals = false;
    sigset_t blocked_signals{};  ///< none, unless set
    bool own_group = false;      ///< it leads a process group of its own
};

/// How a program ended.
struct ProcessEnd {
    int exit_code = 0;  ///< valid if signal is 0
    int signal = 0;     ///< that ended it
};

/// A running program, which is killed and waited for by the destructor. Movable.
class Process {
  public:
    Process() = default;
    Process(Process&& other) noexcept : pid_(std::exchange(other.pid_, -1)) {}
    Process& operator=(Process&& other) noexcept {
        std::swap(pid_, other.pid_);
        return *this;
    }
    ~Process();

    /// Returns when the program has begun to run. \return 0 or an errno: no process, no such program, …
    [[nodiscard]] int start(const ProcessStart& start);

    [[nodiscard]] bool running() const { return pid_ > 0; }  ///< started and not waited for
    [[nodiscard]] pid_t pid() const { return pid_; }
    void kill(int signal) const { ::kill(pid_, signal); }
    /// Waits for its end; call once.
    ProcessEnd wait();

  private:
    pid_t pid_ = -1;
};

}  // namespace relief
