// SPDX-License-Identifier: Apache-2.0
#include "runtime/player/watchdog.h"

#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <mutex>

#include "formats/base/result.h"
#include "formats/base/text.h"

namespace relief {
namespace {

std::mutex mutex;
std::string last_line;  // message if the timer expires; empty while the timer is stopped

/// Runs on a thread of the timer.
void onExpired(sigval /*value*/) {
    const std::lock_guard lock(mutex);
    // Do not use streams: the stuck thread may hold their locks.
    if (!last_line.empty() && ::write(STDERR_FILENO, last_line.data(), last_line.size()) != 0) {
        ::_exit(static_cast<int>(ErrorCode::kFailure));
    }
}

}  // namespace

Watchdog::Watchdog(const std::string& program, std::chrono::milliseconds limit)
    : program_(program), limit_(limit) {
    sigevent event{};
    event.sigev_notify = SIGEV_THREAD;
    event.sigev_notify_function = onExpired;
    has_timer_ = ::timer_create(CLOCK_MONOTONIC, &event, &timer_) == 0;
    if (!has_timer_) {
        std::fprintf(stderr, "%s: warning: the system has no timer for --gpu-timeout; raise ulimit -i\n",
                     program.c_str());
    }
}

Watchdog::~Watchdog() {
    rest();
    if (has_timer_) {
        ::timer_delete(timer_);
    }
}

void Watchdog::feed(const std::string& what) {
    const std::string seconds = formatted("%g", static_cast<double>(limit_.count()) / 1000.0);
    const std::lock_guard lock(mutex);
    last_line = program_ + ": error: the GPU has not finished " + what + " within " + seconds +
                " seconds; if it is only slow, raise --gpu-timeout (0: no limit)\n";
    set(limit_);  // 0 stops the timer
}

void Watchdog::rest() {
    const std::lock_guard lock(mutex);
    set(std::chrono::milliseconds(0));
    last_line.clear();
}

void Watchdog::set(std::chrono::milliseconds limit) {
    if (!has_timer_) {
        return;
    }
    itimerspec wait{};
    wait.it_value.tv_sec = limit.count() / 1000;
    wait.it_value.tv_nsec = limit.count() % 1000 * 1'000'000;
    ::timer_settime(timer_, 0, &wait, nullptr);
}

}  // namespace relief
