// SPDX-License-Identifier: Apache-2.0
// Notices that the GPU no longer answers. For programs: the library waits without end.
#pragma once

#include <time.h>

#include <chrono>
#include <string>

namespace relief {

/// A timer that must be fed while the GPU works. Where it runs out, it prints one line, "PROGRAM: error: the GPU …", and
/// ends the process with exit code 4, at once: a driver that hangs would hang in every destructor too. One at a time.
class Watchdog {
  public:
    /// \param limit  longest time between feed and the next feed or rest; 0: none. Where the system has no timer left, a warning on
    ///               standard error, and no limit.
    Watchdog(const std::string& program, std::chrono::milliseconds limit);
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// The GPU is about to do, or goes on with, "steps 1 to 16".
    void feed(const std::string& what);
    /// The next work is not for the GPU.
    void rest();
    /// From the next feed on.
    void setLimit(std::chrono::milliseconds limit) { limit_ = limit; }

  private:
    void set(std::chrono::milliseconds limit);

    std::string program_;
    std::chrono::milliseconds limit_;
    timer_t timer_{};
    bool has_timer_ = false;
};

/// Calls `work` and returns its result. The watchdog is fed before it and rests after it.
/// \param watchdog  may be null.
/// \param what      what the GPU does meanwhile, for the watchdog's message: "steps 1 to 16".
template <class Work>
auto watched(Watchdog* watchdog, const std::string& what, const Work& work) {
    if (watchdog == nullptr) {
        return work();
    }
    watchdog->feed(what);
    auto result = work();
    watchdog->rest();
    return result;
}

}  // namespace relief
