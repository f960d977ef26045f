// SPDX-License-Identifier: Apache-2.0
#include "runtime/command_line/progress.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>
#include <utility>

#include "formats/base/temporary_file.h"
#include "formats/base/text.h"
#include "runtime/command_line/command_line.h"

namespace relief {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kBarWidth = 30;  // characters
constexpr auto kFirst = std::chrono::milliseconds(500);
constexpr auto kInterval = std::chrono::milliseconds(100);
constexpr double kUnknown = -1.0;  // progress of the stage

std::string secondsText(double seconds) {
    return formatted("%.3g s", seconds);
}

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

struct Progress::Impl {
    ProgressOptions options;
    Clock::time_point start = Clock::now();
    std::mutex mutex;
    std::condition_variable changed;
    std::string stage;
    Clock::time_point stage_start = start;
    std::atomic<double> fraction{kUnknown};
    bool shown = false;  ///< the line is on the terminal
    bool stopping = false;
    std::thread thread;

    explicit Impl(ProgressOptions wanted) : options(std::move(wanted)) {
        options.drawn = options.drawn && ::isatty(STDERR_FILENO) == 1;
        if (options.drawn || options.seconds) {
            thread = std::thread([this] { watch(); });
        }
    }

    [[nodiscard]] Clock::time_point deadline() const {
        return start + std::chrono::duration_cast<Clock::duration>(
                           std::chrono::duration<double>(double{*options.seconds}));
    }

    void watch() {
        std::unique_lock lock(mutex);
        Clock::time_point next = start + kFirst;
        while (!stopping) {
            const bool limited = options.seconds.has_value();
            changed.wait_until(lock, !options.drawn ? deadline()
                                     : limited      ? std::min(next, deadline())
                                                    : next);
            if (stopping) {
                return;
            }
            if (limited && Clock::now() >= deadline()) {
                onTimeout();
            }
            if (options.drawn && Clock::now() >= next) {
                draw();
                next = Clock::now() + kInterval;
            }
        }
    }

    /// Keeps the lock, so that other threads wait for the exit.
    [[noreturn]] void onTimeout() {
        wipe();
        TemporaryFile::removeAll();
        reportError({ErrorCode::kLimit,
                     options.name + ": the bake did not finish within " +
                         secondsText(double{*options.seconds}) + "; it was " + stage + ", for " +
                         secondsText(secondsSince(stage_start)) +
                         "; simplify the mesh, lower the budget or resolution, or raise --timeout"});
        ::_exit(static_cast<int>(ErrorCode::kLimit));
    }

    void draw() {
        std::string line = options.name + ": " + stage;
        const double done = std::clamp(fraction.load(), kUnknown, 1.0);
        if (done >= 0.0) {
            const auto filled = static_cast<std::size_t>(done * kBarWidth);
            line += " [" + std::string(filled, '#') + std::string(kBarWidth - filled, '.') + "] " +
                    std::to_string(static_cast<int>(done * 100.0)) + " %";
        }
        line += ", " + std::to_string(static_cast<int>(secondsSince(stage_start))) + " s";
        std::fprintf(stderr, "\r%s\033[K", line.c_str());
        std::fflush(stderr);
        shown = true;
    }

    void wipe() {
        if (std::exchange(shown, false)) {
            std::fputs("\r\033[K", stderr);
            std::fflush(stderr);
        }
    }
};

Progress::Progress(ProgressOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}

Progress::~Progress() {
    finish();
}

void Progress::begin(const std::string& stage) {
    const std::lock_guard lock(impl_->mutex);
    impl_->stage = stage;
    impl_->stage_start = Clock::now();
    impl_->fraction = kUnknown;
}

void Progress::set(double fraction) {
    impl_->fraction = fraction;
}

void Progress::print(const std::function<void()>& print) {
    const std::lock_guard lock(impl_->mutex);
    impl_->wipe();
    print();
}

void Progress::finish() {
    {
        const std::lock_guard lock(impl_->mutex);
        impl_->stopping = true;
        impl_->wipe();
    }
    impl_->changed.notify_all();
    if (impl_->thread.joinable()) {
        impl_->thread.join();
    }
}

}  // namespace relief
