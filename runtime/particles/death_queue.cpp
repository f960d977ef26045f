// SPDX-License-Identifier: Apache-2.0
#include "runtime/particles/death_queue.h"

#include <algorithm>
#include <utility>

namespace relief {
namespace {

constexpr float kDaysPerSecond = 64.0F;
// The day of all later times: far below the range of 32 bits, and later than any clock reaches before it is set back
// (ParticleSystemOptions::epoch_seconds).
constexpr float kLastDay = 0x1p30F;

/// Returns the day of a time since time 0; the last day for NaN.
std::uint32_t dayOf(float time) {
    const float day = time * kDaysPerSecond;  // exact
    return static_cast<std::uint32_t>(day < kLastDay ? std::max(day, 0.0F) : kLastDay);
}

}  // namespace

void DeathQueue::push(float time, std::uint32_t index) {
    file({time, index});
    ++size_;
}

void DeathQueue::file(const Death& death) {
    Day& day = days_[std::max(dayOf(death.time), today_) % kDays];
    // A lower bound of the times. If it is NaN, the day is always opened.
    day.earliest = day.deaths.empty() || death.time < day.earliest ? death.time : day.earliest;
    day.deaths.push_back(death);
}

void DeathQueue::popUntil(float now, std::vector<std::uint32_t>& dead) {
    const std::uint32_t last = std::max(dayOf(now), today_);
    // One cycle of the calendar visits every day.
    const std::uint32_t days = std::min(last - today_, kDays - 1) + 1;
    const std::uint32_t first = std::exchange(today_, last);
    for (std::uint32_t i = 0; i < days; ++i) {
        openDay((first + i) % kDays, now, dead);
    }
}

void DeathQueue::openDay(std::uint32_t day, float now, std::vector<std::uint32_t>& dead) {
    if (days_[day].deaths.empty() || now < days_[day].earliest) {
        return;
    }
    for (const Death& death : std::exchange(days_[day].deaths, {})) {
        if (now >= death.time) {
            dead.push_back(death.index);
            --size_;
        } else {
            file(death);
        }
    }
}

void DeathQueue::rebase(float shift) {
    std::vector<Day> days = std::exchange(days_, std::vector<Day>(kDays));
    today_ = 0;  // starting early is safe: the days up to now are empty
    for (const Day& day : days) {
        for (const Death& death : day.deaths) {
            file({death.time - shift, death.index});
        }
    }
}

}  // namespace relief
