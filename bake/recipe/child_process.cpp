#include "bake/recipe/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <system_error>
#include <utility>

namespace relief {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::array<int, 3> kEndSignals = {SIGINT, SIGTERM, SIGHUP};
constexpr auto kPatience = std::chrono::milliseconds(1000);
constexpr int kExecFailed = 127;

bool isIgnored(int signal) {
    struct sigaction action {};
    return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

void closeIf(int& fd) {
    if (fd >= 0) {
        ::close(fd);
        fd = -1;
    }
}

}  // namespace

struct ChildProcesses::Child {
    pid_t pid = 0;
    int out = -1;  ///< the ends of its pipes, not blocking; -1 at their end
    int err = -1;
    Clock::time_point start;
    Clock::time_point deadline = Clock::time_point::max();
    ChildEnd end;

    /// Takes what lies in a pipe.
    void drain(int& fd, std::string& text) {
        std::array<char, 1 << 16> buffer;
        while (fd >= 0) {
            const ssize_t got = ::read(fd, buffer.data(), buffer.size());
            if (got > 0) {
                text.append(buffer.data(), static_cast<std::size_t>(got));
                trim();
            } else if (got == 0 || (errno != EINTR && errno != EAGAIN)) {
                closeIf(fd);
            } else if (errno == EAGAIN) {
                return;
            }
        }
    }
    void drain() {
        drain(out, end.out);
        drain(err, end.err);
    }
    void trim() {
        end.out.resize(std::min(end.out.size(), kChildOutputMax));
        if (end.err.size() > 2 * kChildErrorMax) {
            end.err.erase(0, end.err.size() - kChildErrorMax);
        }
    }
    void kill(int signal) const { ::kill(-pid, signal); }
};

ChildProcesses::ChildProcesses() {
    sigset_t wanted;
    ::sigemptyset(&wanted);
    ::sigaddset(&wanted, SIGCHLD);
    for (const int signal : kEndSignals) {
        if (!isIgnored(signal)) {
            ::sigaddset(&wanted, signal);
        }
    }
    ::sigprocmask(SIG_BLOCK, &wanted, &mask_before_);
    signal_fd_ = ::signalfd(-1, &wanted, SFD_CLOEXEC | SFD_NONBLOCK);
}

ChildProcesses::~ChildProcesses() {
    endAll();
    if (asked_ != 0) {
        readSignals();  // to ask again is to ask once; what nobody was told of is delivered now
    }
    closeIf(signal_fd_);
    ::sigprocmask(SIG_SETMASK, &mask_before_, nullptr);
}

Result<void> ChildProcesses::startSelf(const std::vector<std::string>& arguments, double seconds_max,
                                       std::size_t tag) {
    const auto failed = [](const char* what, int code) {
        return fail(ErrorCode::kFailure, std::string("cannot ") + what + ": " +
                                             std::system_category().message(code) +
                                             "; choose a smaller -j, or raise the limits (ulimit -n -u)");
    };
    // All that the child needs is made before the fork: behind it, only what is safe in a signal handler.
    std::string self = "/proc/self/exe";
    std::string name = "relief";
    std::vector<std::string> copies = arguments;
    std::vector<char*> argv{name.data()};
    for (std::string& argument : copies) {
        argv.push_back(argument.data());
    }
    argv.push_back(nullptr);

    std::array<int, 2> out{-1, -1};
    std::array<int, 2> err{-1, -1};
    int null = -1;
    const auto closeAll = [&] {
        for (int* fd : {&out[0], &out[1], &err[0], &err[1], &null}) {
            closeIf(*fd);
        }
    };
    null = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (null < 0 || ::pipe2(out.data(), O_CLOEXEC) != 0 || ::pipe2(err.data(), O_CLOEXEC) != 0) {
        const int code = errno;
        closeAll();
        return failed("make a pipe", code);
    }
    const pid_t parent = ::getpid();
    const pid_t pid = ::fork();
    if (pid == 0) {
        ::prctl(PR_SET_PDEATHSIG, SIGTERM);
        if (::getppid() != parent) {
            ::_exit(kExecFailed);
        }
        ::setpgid(0, 0);
        if (const int adjust = ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC); adjust >= 0) {
            [[maybe_unused]] const ssize_t written = ::write(adjust, "500", 3);
        }
        ::sigprocmask(SIG_SETMASK, &mask_before_, nullptr);
        std::signal(SIGPIPE, SIG_DFL);
        if (::dup2(null, STDIN_FILENO) < 0 || ::dup2(out[1], STDOUT_FILENO) < 0 ||
            ::dup2(err[1], STDERR_FILENO) < 0) {
            ::_exit(kExecFailed);
        }
        ::execv(self.c_str(), argv.data());
        ::_exit(kExecFailed);
    }
    if (pid < 0) {
        const int code = errno;
        closeAll();
        return failed("start a process", code);
    }
    ::setpgid(pid, pid);  // here too: whoever is first
    Child child;
    child.pid = pid;
    child.out = std::exchange(out[0], -1);
    child.err = std::exchange(err[0], -1);
    closeAll();
    ::fcntl(child.out, F_SETFL, O_NONBLOCK);
    ::fcntl(child.err, F_SETFL, O_NONBLOCK);
    child.start = Clock::now();
    if (seconds_max > 0.0) {
        child.deadline = child.start + std::chrono::duration_cast<Clock::duration>(
                                           std::chrono::duration<double>(seconds_max));
    }
    child.end.tag = tag;
    child.end.pid = pid;
    children_.push_back(std::move(child));
    return {};
}

std::size_t ChildProcesses::running() const {
    return children_.size();
}

void ChildProcesses::readSignals() {
    signalfd_siginfo info{};
    while (::read(signal_fd_, &info, sizeof(info)) == static_cast<ssize_t>(sizeof(info))) {
        const int signal = static_cast<int>(info.ssi_signo);
        if (asked_ == 0 && std::find(kEndSignals.begin(), kEndSignals.end(), signal) != kEndSignals.end()) {
            asked_ = signal;
        }
    }
}

int ChildProcesses::askedToEnd() {
    readSignals();
    return asked_;
}

void ChildProcesses::collect(std::vector<ChildEnd>& ended) {
    for (auto child = children_.begin(); child != children_.end();) {
        siginfo_t info{};
        if (::waitid(P_PID, static_cast<id_t>(child->pid), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
            info.si_pid == 0) {
            ++child;
            continue;
        }
        child->kill(SIGKILL);  // what it has started and left behind; while its number is still its own
        int status = 0;
        pid_t got = 0;
        do {
            got = ::waitpid(child->pid, &status, 0);
        } while (got < 0 && errno == EINTR);
        child->drain();
        closeIf(child->out);
        closeIf(child->err);
        ChildEnd end = std::move(child->end);
        if (end.err.size() > kChildErrorMax) {
            end.err.erase(0, end.err.size() - kChildErrorMax);
        }
        end.signal = got > 0 && WIFSIGNALED(status) ? WTERMSIG(status) : 0;
        end.exit_code = got > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : kExecFailed;
        end.ms = std::chrono::duration<double, std::milli>(Clock::now() - child->start).count();
        ended.push_back(std::move(end));
        child = children_.erase(child);
    }
}

std::vector<ChildEnd> ChildProcesses::wait(std::chrono::milliseconds at_most) {
    std::vector<ChildEnd> ended;
    const Clock::time_point until = Clock::now() + at_most;
    while (true) {
        readSignals();
        for (Child& child : children_) {
            child.drain();
            if (Clock::now() >= child.deadline) {
                child.end.timed_out = true;
                child.deadline = Clock::time_point::max();
                child.kill(SIGKILL);
            }
        }
        collect(ended);
        const Clock::time_point now = Clock::now();
        if (!ended.empty() || asked_ != 0 || now >= until || children_.empty()) {
            return ended;
        }
        Clock::time_point next = until;
        std::vector<pollfd> watched{{signal_fd_, POLLIN, 0}};
        for (const Child& child : children_) {
            next = std::min(next, child.deadline);
            for (const int fd : {child.out, child.err}) {
                if (fd >= 0) {
                    watched.push_back({fd, POLLIN, 0});
                }
            }
        }
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(next - now).count();
        ::poll(watched.data(), watched.size(), static_cast<int>(std::max<std::int64_t>(left, 1)));
    }
}

std::vector<ChildEnd> ChildProcesses::endAll() {
    std::vector<ChildEnd> ended;
    for (const Child& child : children_) {
        child.kill(SIGTERM);
    }
    const Clock::time_point until = Clock::now() + kPatience;
    while (!children_.empty()) {
        const bool late = Clock::now() >= until;
        for (Child& child : children_) {
            child.drain();
            if (late) {
                child.kill(SIGKILL);
            }
        }
        collect(ended);
        if (!children_.empty()) {
            ::poll(nullptr, 0, 10);
        }
    }
    return ended;
}

void ChildProcesses::endBySignal(int signal) {
    sigset_t set;
    ::sigemptyset(&set);
    ::sigaddset(&set, signal);
    ::sigprocmask(SIG_UNBLOCK, &set, nullptr);
    ::raise(signal);
    // A handler came back.
    std::signal(signal, SIG_DFL);
    ::raise(signal);
    ::_exit(128 + signal);
}

}  // namespace relief
