// SPDX-License-Identifier: Apache-2.0
#include "formats/base/process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

#include "formats/base/descriptor.h"

namespace relief {

Process::~Process() {
    if (running()) {
        kill(SIGKILL);
        wait();
    }
}

int Process::start(const ProcessStart& start) {
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawnattr_init(&attributes);
    const int count = static_cast<int>(start.files.size());
    const Descriptor nothing(openRetry("/dev/null", O_RDWR));
    std::vector<Descriptor> copies;  // avoids overwriting a descriptor that is still needed
    int code = 0;
    for (int number = 0; number < count && code == 0; ++number) {
        const int file = start.files[static_cast<std::size_t>(number)];
        copies.emplace_back(::fcntl(file >= 0 ? file : nothing.get(), F_DUPFD_CLOEXEC, count));
        // The kernel reports a number beyond the limit of open files as invalid.
        code = copies.back() ? ::posix_spawn_file_actions_adddup2(&actions, copies.back().get(), number)
                             : (errno == EINVAL || errno == EBADF ? EMFILE : errno);
    }
    ::posix_spawn_file_actions_addclosefrom_np(&actions, count);
    sigset_t standard;
    ::sigemptyset(&standard);
    ::sigaddset(&standard, SIGPIPE);
    if (start.reset_ignored_signals) {
        ::sigfillset(&standard);
    }
    ::posix_spawnattr_setsigdefault(&attributes, &standard);
    ::posix_spawnattr_setsigmask(&attributes, &start.blocked_signals);
    const int flags =
        POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK | (start.own_group ? POSIX_SPAWN_SETPGROUP : 0);
    ::posix_spawnattr_setflags(&attributes, static_cast<short>(flags));
    std::vector<std::string> words = start.arguments;
    std::vector<char*> arguments;
    for (std::string& word : words) {
        arguments.push_back(word.data());
    }
    arguments.push_back(nullptr);
    pid_t pid = -1;
    code = code != 0 ? code
                     : ::posix_spawnp(&pid, start.program.c_str(), &actions, &attributes, arguments.data(),
                                      environ);
    pid_ = code == 0 ? pid : -1;
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&actions);
    return code;
}

ProcessEnd Process::wait() {
    int status = 0;
    pid_t got = 0;
    do {
        got = ::waitpid(pid_, &status, 0);
    } while (got < 0 && errno == EINTR);
    pid_ = -1;
    if (got > 0 && WIFSIGNALED(status)) {
        return {0, WTERMSIG(status)};
    }
    // No status is available if this process ignores SIGCHLD: callers check the program's output.
    return {got > 0 ? WEXITSTATUS(status) : 0, 0};
}

}  // namespace relief
