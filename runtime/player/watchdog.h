// SPDX-License-Identifier: Apache-2.0
// Ends a program if the GPU stops responding. The library itself waits without a limit.
#pragma once

#include <time.h>

#include <chrono>
#include <string>

namespace relief {

/// A timer that must be fed while the GPU works. When it expires, it prints "PROGRAM: error: the GPU …" and ends the
/// process with exit code 4 without running destructors, which could hang in the driver, too. Only one Watchdog may
/// exist at a time.
class Watchdog {
  public:
    /// \param limit  maximum time between feed() and the next feed() or rest(); 0: no limit. If the system has no timer
    ///               left, prints a warning to standard error and sets no limit.
    Watchdog(const std::string& program, std::chrono::milliseconds limit);
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// Restarts the timer. \param what  current GPU work: "steps 1 to 16".
    void feed(const std::string& what);
    /// Stops the timer until the next feed().
    void rest();
    /// Sets the limit from the next feed() on.
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
/// \param what      GPU work, for the message: "steps 1 to 16".
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
