// SPDX-License-Identifier: Apache-2.0
// Pending deaths: a calendar queue (Brown 1988) with days of fixed length. A step processes only the deaths due in it
// and later deaths filed under the same days. A heap costs log n cache misses per death; a hierarchical timing wheel
// stalls whenever a coarse slot is redistributed.
#pragma once

#include <cstdint>
#include <vector>

namespace relief {

/// The calendar has kDays days of 1/64 s, used cyclically: a death beyond the last day is filed under its day modulo
/// kDays and waits for a later cycle.
class DeathQueue {
  public:
    DeathQueue() : days_(kDays) {}

    /// Adds a death. \param time  seconds; past times are due at once, NaN and infinity never.
    void push(float time, std::uint32_t index);

    /// Removes all deaths with a time at or before `now`. `now` must not decrease except through rebase().
    /// \param dead  the indices are appended to it, in an order that depends only on previous calls.
    void popUntil(float now, std::vector<std::uint32_t>& dead);

    /// Moves the clock back: every time becomes time − shift, as a float. Re-sorts all pending deaths.
    void rebase(float shift);

    [[nodiscard]] std::uint32_t size() const { return size_; }

  private:
    static constexpr std::uint32_t kDays = 4096;
    struct Death {
        float time;
        std::uint32_t index;
    };
    struct Day {
        std::vector<Death> deaths;
        float earliest = 0.0F;  // of the deaths
    };

    void file(const Death& death);
    void openDay(std::uint32_t day, float now, std::vector<std::uint32_t>& dead);

    std::vector<Day> days_;
    std::uint32_t today_ = 0;  // day number since time 0; no earlier day has due deaths
    std::uint32_t size_ = 0;
};

}  // namespace relief
