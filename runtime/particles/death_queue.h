// SPDX-License-Identifier: Apache-2.0
// The deaths to come: a calendar queue (Brown 1988) of fixed days, so that no step pays for more than its own
// deaths and a sixty-fourth of a second's share of the rest. A heap costs log n cache misses a death, and a
// hierarchy of wheels stalls whenever a coarse slot is poured out.
#pragma once

#include <cstdint>
#include <vector>

namespace relief {

/// The calendar has kDays days of 1 / 64 s, used in turn: a death beyond the last waits on its day for the turn that is its own.
class DeathQueue {
  public:
    DeathQueue() : days_(kDays) {}

    /// \param time  seconds, any float: one that has passed is due at once, NaN and infinity never are.
    void push(float time, std::uint32_t index);

    /// Takes out every death whose time is at or before `now`, which never goes back but by rebase().
    /// \param dead  the indices are added at its end, in an order that depends on nothing but the calls so
    /// far.
    void popUntil(float now, std::vector<std::uint32_t>& dead);

    /// Sets the clock back: every time becomes time − shift, in float. Sorts all that wait anew.
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
        float earliest = 0.0F;  // of them
    };

    void file(const Death& death);
    void openDay(std::uint32_t day, float now, std::vector<std::uint32_t>& dead);

    std::vector<Day> days_;
    std::uint32_t today_ = 0;  // since time 0: the first that may hold deaths that are due
    std::uint32_t size_ = 0;
};

}  // namespace relief
