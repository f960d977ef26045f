// SPDX-License-Identifier: Apache-2.0
// Starts other programs and waits for them.
#pragma once

#include <sys/types.h>

#include <csignal>
#include <string>
#include <utility>
#include <vector>

#include "formats/base/descriptor.h"

namespace relief {

/// Start parameters. The program inherits the environment and working folder, but no signal handlers.
struct ProcessStart {
    std::string program;                 ///< a path; names without '/' are looked up in PATH
    std::vector<std::string> arguments;  ///< argv, starting with the program's name
    /// files[n], borrowed, becomes descriptor n; -1 means /dev/null. No other descriptors are inherited.
    std::vector<int> files;
    /// Resets all signals that this process ignores. If false, resets only SIGPIPE; the others stay ignored, as under
    /// nohup.
    bool reset_ignored_signals = false;
    sigset_t blocked_signals{};  ///< empty by default
    bool own_group = false;      ///< makes the program the leader of a new process group
};

struct ProcessEnd {
    int exit_code = 0;  ///< valid if signal is 0
    int signal = 0;     ///< terminating signal, or 0
};

/// A running program. The destructor kills it and waits for its end. Movable.
class Process {
  public:
    Process() = default;
    Process(Process&& other) noexcept : pid_(std::exchange(other.pid_, -1)) {}
    Process& operator=(Process&& other) noexcept {
        std::swap(pid_, other.pid_);
        return *this;
    }
    ~Process();

    /// Starts the program and returns once exec has succeeded. \return 0, or the errno of fork or exec.
    [[nodiscard]] int start(const ProcessStart& start);

    [[nodiscard]] bool running() const { return pid_ > 0; }  ///< started but not yet waited for
    [[nodiscard]] pid_t pid() const { return pid_; }
    void kill(int signal) const { ::kill(pid_, signal); }
    /// Waits for the program's end. Call it once.
    ProcessEnd wait();

  private:
    pid_t pid_ = -1;
};

}  // namespace relief
