#include "runtime/player/watchdog.h"

#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace relief {

using Clock = std::chrono::steady_clock;

struct Watchdog::Impl {
    std::mutex mutex;
    std::condition_variable changed;
    std::chrono::milliseconds limit{0};
    Starved starved;
    std::function<void()> clean_up;
    std::string what;
    std::optional<Clock::time_point> deadline;  // none at rest
    bool ends = false;
    std::thread thread;

    void watch() {
        std::unique_lock lock(mutex);
        while (!ends) {
            if (!deadline) {
                changed.wait(lock);
                continue;
            }
            const Clock::time_point until = *deadline;
            changed.wait_until(lock, until);
            if (!ends && deadline && Clock::now() >= *deadline) {
                // The lock stays held: other threads wait for the end.
                if (clean_up) {
                    clean_up();
                }
                starved(what, limit);
                deadline.reset();
                return;
            }
        }
    }
};

std::chrono::milliseconds defaultGpuTimeout(bool software) {
    return std::chrono::seconds(software ? 600 : 60);
}

Watchdog::Watchdog(std::chrono::milliseconds limit, Starved starved) : impl_(std::make_unique<Impl>()) {
    impl_->starved = std::move(starved);
    setLimit(limit);
}

Watchdog::~Watchdog() {
    {
        const std::lock_guard lock(impl_->mutex);
        impl_->ends = true;
    }
    impl_->changed.notify_all();
    if (impl_->thread.joinable()) {
        impl_->thread.join();
    }
}

void Watchdog::feed(const std::string& what) {
    {
        const std::lock_guard lock(impl_->mutex);
        if (impl_->limit.count() <= 0) {
            impl_->deadline.reset();
            return;
        }
        impl_->what = what;
        impl_->deadline = Clock::now() + impl_->limit;
    }
    impl_->changed.notify_all();
}

void Watchdog::rest() {
    const std::lock_guard lock(impl_->mutex);
    impl_->deadline.reset();
}

void Watchdog::setLimit(std::chrono::milliseconds limit) {
    const std::lock_guard lock(impl_->mutex);
    impl_->limit = limit;
    if (limit.count() > 0 && !impl_->thread.joinable()) {
        impl_->thread = std::thread([impl = impl_.get()] { impl->watch(); });
    }
}

void Watchdog::setCleanUp(std::function<void()> clean_up) {
    const std::lock_guard lock(impl_->mutex);
    impl_->clean_up = std::move(clean_up);
}

}  // namespace relief
