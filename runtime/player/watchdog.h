// Notices that the GPU no longer answers. For programs: the library waits without end.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>

namespace relief {

/// The limit where none is given. A software renderer does not hang, it takes its time.
[[nodiscard]] std::chrono::milliseconds defaultGpuTimeout(bool software);

/// A thread that must be fed while the GPU works. All members are for the thread that made it.
class Watchdog {
  public:
    /// \param limit    longest time between feed and the next feed or rest; 0: none, the thread is not made.
    /// \param starved  called on the watchdog's thread, at most once, with what was waited for. feed, rest
    /// and
    ///                 the destructor wait until it returns, so that it may end the process undisturbed.
    using Starved = std::function<void(const std::string& what, std::chrono::milliseconds limit)>;
    Watchdog(std::chrono::milliseconds limit, Starved starved);
    ~Watchdog();
    Watchdog(const Watchdog&) = delete;
    Watchdog& operator=(const Watchdog&) = delete;

    /// The GPU is about to do, or goes on with, "steps 1 to 16".
    void feed(const std::string& what);
    /// What comes is not for the GPU.
    void rest();
    /// From the next feed on.
    void setLimit(std::chrono::milliseconds limit);
    /// Called before `starved`, as long as the owner of what it removes lives; empty: nothing.
    void setCleanUp(std::function<void()> clean_up);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace relief
