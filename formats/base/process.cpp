#include "formats/base/process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <span>

#include "formats/base/descriptor.h"
#include "formats/base/retry.h"

namespace relief {
namespace {

constexpr int kNotStarted = 127;

/// All that the child needs, made before the fork: behind it, only what is safe in a signal handler may be called.
struct Prepared {
    const ProcessStart& start;
    std::vector<char*> arguments;
    std::vector<int> files;
    char oom_score[16] = "";
    pid_t parent = ::getpid();
    int failure = -1;  // a pipe that takes the errno
};

/// Puts the files at their numbers, the pipe for failures behind them, and closes all else.
bool placeFiles(Prepared& child) {
    const int count = static_cast<int>(child.files.size());
    // First out of the way of the numbers, each of which may be another's.
    const auto raise = [count](int& file) {
        file = file >= count ? file : ::fcntl(file, F_DUPFD_CLOEXEC, count);
        return file >= 0;
    };
    for (int& file : child.files) {
        file = file >= 0 ? file : ::open("/dev/null", O_RDWR | O_CLOEXEC);
        if (!raise(file)) {
            return false;
        }
    }
    if (!raise(child.failure)) {
        return false;
    }
    for (int number = 0; number < count; ++number) {
        if (::dup2(child.files[static_cast<std::size_t>(number)], number) < 0) {
            return false;
        }
    }
    if (child.failure != count && ::dup3(child.failure, count, O_CLOEXEC) < 0) {
        return false;
    }
    child.failure = count;
    ::closefrom(count + 1);
    return true;
}

/// This process's handlers must not run in the child, which would remove temporary files of ours.
void resetSignals(bool ignored_too) {
    struct sigaction standard {};
    standard.sa_handler = SIG_DFL;
    for (int signal = 1; signal < NSIG; ++signal) {
        struct sigaction now {};
        if (::sigaction(signal, nullptr, &now) == 0 &&
            (ignored_too || signal == SIGPIPE || now.sa_handler != SIG_IGN)) {
            ::sigaction(signal, &standard, nullptr);
        }
    }
}

/// The child, which all signals are blocked for. Comes back, with errno set, where the program cannot be run.
void become(Prepared& child) {
    const ProcessStart& start = child.start;
    if (start.signal_on_orphan != 0) {
        ::prctl(PR_SET_PDEATHSIG, start.signal_on_orphan);
        if (::getppid() != child.parent) {
            ::_exit(kNotStarted);
        }
    }
    if (start.own_group) {
        ::setpgid(0, 0);
    }
    if (start.oom_score != 0) {
        if (const int file = ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC); file >= 0) {
            const std::span text(child.oom_score);
            static_cast<void>(writeAll(file, std::as_bytes(text.first(std::strlen(child.oom_score)))));
        }
    }
    if (!placeFiles(child)) {
        // A number beyond the limit of open files is "invalid" or "bad" to the kernel.
        errno = errno == EINVAL || errno == EBADF ? EMFILE : errno;
        return;
    }
    resetSignals(start.reset_ignored_signals);
    ::sigprocmask(SIG_SETMASK, &start.blocked_signals, nullptr);
    const bool searched = start.program.find('/') == std::string::npos;
    (searched ? ::execvp : ::execv)(start.program.c_str(), child.arguments.data());
}

}  // namespace

Process::~Process() {
    if (running()) {
        kill(SIGKILL);
        wait();
    }
}

int Process::start(const ProcessStart& start) {
    return retryTransient([&] { return startOnce(start); });
}

int Process::startOnce(const ProcessStart& start) {
    Descriptor failure;
    Descriptor failure_end;
    if (const int code = makePipe(failure, failure_end)) {
        return code;
    }
    Prepared child{start, {}, start.files};
    child.failure = failure_end.get();
    std::snprintf(child.oom_score, sizeof(child.oom_score), "%d", start.oom_score);
    std::vector<std::string> arguments = start.arguments;
    for (std::string& argument : arguments) {
        child.arguments.push_back(argument.data());
    }
    child.arguments.push_back(nullptr);

    sigset_t all;
    sigset_t before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    const pid_t pid = ::_Fork();  // no handlers of pthread_atfork: the child calls nothing that needs them
    if (pid == 0) {
        become(child);
        const int code = errno;
        static_cast<void>(writeAll(child.failure, std::as_bytes(std::span(&code, 1))));
        ::_exit(kNotStarted);
    }
    int code = pid < 0 ? errno : 0;
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    if (pid < 0) {
        return code;
    }
    failure_end.reset();
    pid_ = pid;
    // The pipe closes as the program begins to run.
    ssize_t got = 0;
    do {
        got = ::read(failure.get(), &code, sizeof(code));
    } while (got < 0 && errno == EINTR);
    if (got > 0) {
        wait();
    }
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
    // Nothing is known where this process ignores SIGCHLD: callers look at what the program has left.
    return {got > 0 ? WEXITSTATUS(status) : 0, 0};
}

}  // namespace relief
