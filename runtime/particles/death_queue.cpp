#include "runtime/particles/death_queue.h"

#include <algorithm>
#include <utility>

namespace relief {
namespace {

constexpr float kDaysPerSecond = 64.0F;
// The day of everything later, still far below what 32 bits count and beyond every clock that is set back in
// time (ParticleSystemOptions::epoch_seconds).
constexpr float kLastDay = 0x1p30F;

/// The day of a time since time 0; the last for NaN.
std::uint32_t dayOf(float time) {
    const float day = time * kDaysPerSecond;  // exact
    return static_cast<std::uint32_t>(day < kLastDay ? std::max(day, 0.0F) : kLastDay);
}

}  // namespace

DeathQueue::DeathQueue(std::uint32_t capacity) : days_(kDays) {
    // All blocks but one of each day are full, and one is in hand while a day is sorted.
    blocks_.reserve(capacity / kBlockSize + std::min(capacity, kDays) + 1);
}

void DeathQueue::push(float time, std::uint32_t index) {
    file({time, index});
    ++size_;
}

void DeathQueue::file(const Death& death) {
    Day& day = days_[std::max(dayOf(death.time), today_) % kDays];
    if (day.first == kNone) {
        day.earliest = death.time;
    }
    if (day.first == kNone || blocks_[day.first].count == kBlockSize) {
        const std::uint32_t block = takeBlock();
        blocks_[block].next = day.first;
        day.first = block;
    }
    Block& block = blocks_[day.first];
    block.deaths[block.count++] = death;
    // Never above the earliest time; where NaN makes it NaN the day is opened whenever it is met.
    day.earliest = death.time < day.earliest ? death.time : day.earliest;
}

std::uint32_t DeathQueue::takeBlock() {
    if (free_ == kNone) {
        blocks_.emplace_back();
        return static_cast<std::uint32_t>(blocks_.size() - 1);
    }
    const std::uint32_t block = std::exchange(free_, blocks_[free_].next);
    blocks_[block].count = 0;
    return block;
}

void DeathQueue::popUntil(float now, std::vector<std::uint32_t>& dead) {
    const std::uint32_t last = std::max(dayOf(now), today_);
    // A turn of the calendar meets every day there is.
    const std::uint32_t days = std::min(last - today_, kDays - 1) + 1;
    const std::uint32_t first = std::exchange(today_, last);
    for (std::uint32_t i = 0; i < days; ++i) {
        openDay((first + i) % kDays, now, dead);
    }
}

void DeathQueue::openDay(std::uint32_t day, float now, std::vector<std::uint32_t>& dead) {
    if (days_[day].first == kNone || now < days_[day].earliest) {
        return;
    }
    std::uint32_t at = std::exchange(days_[day].first, kNone);
    while (at != kNone) {
        const Block block = blocks_[at];
        blocks_[at].next = std::exchange(free_, at);
        for (std::uint32_t i = 0; i < block.count; ++i) {
            if (now >= block.deaths[i].time) {
                dead.push_back(block.deaths[i].index);
                --size_;
            } else {
                file(block.deaths[i]);
            }
        }
        at = block.next;
    }
}

void DeathQueue::rebase(float shift) {
    std::vector<Death> all;
    all.reserve(size_);
    for (Day& day : days_) {
        for (std::uint32_t at = day.first; at != kNone; at = blocks_[at].next) {
            all.insert(all.end(), blocks_[at].deaths, blocks_[at].deaths + blocks_[at].count);
        }
        day.first = kNone;
    }
    blocks_.clear();
    free_ = kNone;
    today_ = 0;  // nothing is lost by beginning early: the days up to now are empty
    for (const Death& death : all) {
        file({death.time - shift, death.index});
    }
}

}  // namespace relief
