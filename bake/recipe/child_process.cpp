// SPDX-License-Identifier: Apache-2.0
#include "bake/recipe/child_process.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <utility>

namespace relief {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::array<int, 3> kEndSignals = {SIGINT, SIGTERM, SIGHUP};
constexpr auto kPatience = std::chrono::milliseconds(1000);
constexpr int kOomScore = 500;
constexpr const char* kParentVariable = "RELIEF_RECIPE_PROCESS";

bool isIgnored(int signal) {
    struct sigaction action {};
    return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

/// Returns at most the last `most` bytes of a file.
std::string tailOf(const Descriptor& file, std::size_t most) {
    const auto size = static_cast<std::size_t>(std::max<off_t>(::lseek(file.get(), 0, SEEK_END), 0));
    std::string text(std::min(size, most), '\0');
    const ssize_t got = ::pread(file.get(), text.data(), text.size(), static_cast<off_t>(size - text.size()));
    text.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    return text;
}

}  // namespace

struct ChildProcesses::Child {
    Process process;
    Descriptor out;  ///< in-memory files
    Descriptor err;
    Clock::time_point start = Clock::now();
    ChildEnd end = {};

    void kill(int signal) const { ::kill(-process.pid(), signal); }
};

void ChildProcesses::endWithParent() {
    if (const char* const parent = std::getenv(kParentVariable)) {
        ::prctl(PR_SET_PDEATHSIG, SIGTERM);
        if (std::to_string(::getppid()) != parent) {  // the parent died before prctl()
            std::_Exit(128 + SIGTERM);
        }
    }
}

ChildProcesses::ChildProcesses() {
    ::setenv(kParentVariable, std::to_string(::getpid()).c_str(), 1);
    ::sigemptyset(&wanted_);
    ::sigaddset(&wanted_, SIGCHLD);
    for (const int signal : kEndSignals) {
        if (!isIgnored(signal)) {
            ::sigaddset(&wanted_, signal);
        }
    }
    ::sigprocmask(SIG_BLOCK, &wanted_, &mask_before_);
}

ChildProcesses::~ChildProcesses() {
    endAll();
    if (termination_signal_ != 0) {
        static_cast<void>(terminationSignal());  // discards further requests, which would be delivered below
    }
    ::sigprocmask(SIG_SETMASK, &mask_before_, nullptr);
    ::unsetenv(kParentVariable);
}

Result<void> ChildProcesses::startSelf(const std::vector<std::string>& arguments, std::size_t tag) {
    Child child;
    const Descriptor nothing(openRetry("/dev/null", O_RDONLY));
    child.out = Descriptor(::memfd_create("stdout", MFD_CLOEXEC));
    child.err = Descriptor(::memfd_create("stderr", MFD_CLOEXEC));
    ProcessStart start;
    start.program = "/proc/self/exe";
    start.arguments = {"relief"};
    start.arguments.insert(start.arguments.end(), arguments.begin(), arguments.end());
    start.files = {nothing.get(), child.out.get(), child.err.get()};
    start.blocked_signals = mask_before_;
    start.own_group = true;
    if (const int code = nothing && child.out && child.err ? child.process.start(start) : errno) {
        return fail(ErrorCode::kFailure, "cannot start a process: " + std::system_category().message(code) +
                                             "; choose a smaller -j, or raise the limits (ulimit -n -u)");
    }
    std::ofstream("/proc/" + std::to_string(child.process.pid()) + "/oom_score_adj") << kOomScore;
    child.end.tag = tag;
    child.end.pid = child.process.pid();
    children_.push_back(std::move(child));
    return {};
}

std::size_t ChildProcesses::running() const {
    return children_.size();
}

bool ChildProcesses::takeSignal(std::chrono::nanoseconds at_most) {
    const auto seconds = std::chrono::floor<std::chrono::seconds>(at_most);
    const timespec time{seconds.count(), (at_most - seconds).count()};
    const int signal = ::sigtimedwait(&wanted_, nullptr, &time);
    termination_signal_ =
        termination_signal_ == 0 && signal > 0 && signal != SIGCHLD ? signal : termination_signal_;
    return signal > 0;
}

int ChildProcesses::terminationSignal() {
    while (takeSignal({})) {
    }
    return termination_signal_;
}

void ChildProcesses::collect(std::vector<ChildEnd>& ended) {
    for (auto child = children_.begin(); child != children_.end();) {
        siginfo_t info{};
        if (::waitid(P_PID, static_cast<id_t>(child->process.pid()), &info, WEXITED | WNOHANG | WNOWAIT) !=
                0 ||
            info.si_pid == 0) {
            ++child;
            continue;
        }
        child->kill(SIGKILL);  // ends descendants left behind, while the process group is still valid
        const ProcessEnd how = child->process.wait();
        ChildEnd end = std::move(child->end);
        end.out = tailOf(child->out, kChildOutputMax);
        end.err = tailOf(child->err, kChildErrorMax);
        end.signal = how.signal;
        end.exit_code = how.exit_code;
        end.ms = std::chrono::duration<double, std::milli>(Clock::now() - child->start).count();
        ended.push_back(std::move(end));
        child = children_.erase(child);
    }
}

std::vector<ChildEnd> ChildProcesses::wait(std::chrono::milliseconds at_most) {
    std::vector<ChildEnd> ended;
    const Clock::time_point until = Clock::now() + at_most;
    while (true) {
        collect(ended);
        const Clock::time_point now = Clock::now();
        if (!ended.empty() || terminationSignal() != 0 || now >= until || children_.empty()) {
            return ended;
        }
        takeSignal(until - now);
    }
}

std::vector<ChildEnd> ChildProcesses::endAll() {
    std::vector<ChildEnd> ended;
    for (const Child& child : children_) {
        child.kill(SIGTERM);
    }
    const Clock::time_point until = Clock::now() + kPatience;
    while (!children_.empty()) {
        takeSignal(std::chrono::milliseconds(10));
        if (Clock::now() >= until) {
            std::ranges::for_each(children_, [](const Child& child) { child.kill(SIGKILL); });
        }
        collect(ended);
    }
    return ended;
}

void ChildProcesses::endBySignal(int signal) {
    sigset_t set;
    ::sigemptyset(&set);
    ::sigaddset(&set, signal);
    ::sigprocmask(SIG_UNBLOCK, &set, nullptr);
    ::raise(signal);
    // A handler caught the signal and returned.
    std::signal(signal, SIG_DFL);
    ::raise(signal);
    ::_exit(128 + signal);
}

}  // namespace relief
