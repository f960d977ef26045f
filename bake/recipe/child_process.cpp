#include "bake/recipe/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <utility>

namespace relief {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::array<int, 3> kEndSignals = {SIGINT, SIGTERM, SIGHUP};
constexpr auto kPatience = std::chrono::milliseconds(1000);
constexpr int kOomScore = 500;

bool isIgnored(int signal) {
    struct sigaction action {};
    return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

struct ChildProcesses::Child {
    Process process;
    Descriptor out;  ///< the ends of its pipes, not blocking; closed at their end
    Descriptor err;
    Clock::time_point start;
    Clock::time_point deadline = Clock::time_point::max();
    ChildEnd end;

    /// Takes what lies in a pipe.
    void drain(Descriptor& pipe, std::string& text) {
        std::array<char, 1 << 16> buffer;
        while (pipe) {
            const ssize_t got = ::read(pipe.get(), buffer.data(), buffer.size());
            if (got > 0) {
                text.append(buffer.data(), static_cast<std::size_t>(got));
                trim();
            } else if (got == 0 || (errno != EINTR && errno != EAGAIN)) {
                pipe.reset();
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
    void kill(int signal) const { ::kill(-process.pid(), signal); }
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
    signals_ = Descriptor(::signalfd(-1, &wanted, SFD_CLOEXEC | SFD_NONBLOCK));
}

ChildProcesses::~ChildProcesses() {
    endAll();
    if (asked_ != 0) {
        readSignals();  // to ask again is to ask once; what nobody was told of is delivered now
    }
    ::sigprocmask(SIG_SETMASK, &mask_before_, nullptr);
}

Result<void> ChildProcesses::startSelf(const std::vector<std::string>& arguments, double seconds_max,
                                       std::size_t tag) {
    const auto failed = [](const char* what, int code) {
        return fail(ErrorCode::kFailure, std::string("cannot ") + what + ": " +
                                             std::system_category().message(code) +
                                             "; choose a smaller -j, or raise the limits (ulimit -n -u)");
    };
    Child child;
    const Descriptor nothing(openRetry("/dev/null", O_RDONLY));
    Descriptor out;
    Descriptor err;
    int code = nothing ? makePipe(child.out, out) : errno;
    code = code == 0 ? makePipe(child.err, err) : code;
    if (code != 0) {
        return failed("make a pipe", code);
    }
    ::fcntl(child.out.get(), F_SETFL, O_NONBLOCK);
    ::fcntl(child.err.get(), F_SETFL, O_NONBLOCK);
    ProcessStart start;
    start.program = "/proc/self/exe";
    start.arguments = {"relief"};
    start.arguments.insert(start.arguments.end(), arguments.begin(), arguments.end());
    start.files = {nothing.get(), out.get(), err.get()};
    start.blocked_signals = mask_before_;
    start.signal_on_orphan = SIGTERM;
    start.own_group = true;
    start.oom_score = kOomScore;
    code = child.process.start(start);
    if (code != 0) {
        return failed("start a process", code);
    }
    child.start = Clock::now();
    if (seconds_max > 0.0) {
        child.deadline = child.start + std::chrono::duration_cast<Clock::duration>(
                                           std::chrono::duration<double>(seconds_max));
    }
    child.end.tag = tag;
    child.end.pid = child.process.pid();
    children_.push_back(std::move(child));
    return {};
}

std::size_t ChildProcesses::running() const {
    return children_.size();
}

void ChildProcesses::readSignals() {
    signalfd_siginfo info{};
    while (::read(signals_.get(), &info, sizeof(info)) == static_cast<ssize_t>(sizeof(info))) {
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
        if (::waitid(P_PID, static_cast<id_t>(child->process.pid()), &info, WEXITED | WNOHANG | WNOWAIT) !=
                0 ||
            info.si_pid == 0) {
            ++child;
            continue;
        }
        child->kill(SIGKILL);  // what it has started and left behind; while its number is still its own
        const ProcessEnd how = child->process.wait();
        child->drain();
        ChildEnd end = std::move(child->end);
        if (end.err.size() > kChildErrorMax) {
            end.err.erase(0, end.err.size() - kChildErrorMax);
        }
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
        std::vector<pollfd> watched{{signals_.get(), POLLIN, 0}};
        for (const Child& child : children_) {
            next = std::min(next, child.deadline);
            for (const Descriptor* pipe : {&child.out, &child.err}) {
                if (*pipe) {
                    watched.push_back({pipe->get(), POLLIN, 0});
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
