#include "runtime/particles/index_allocator.h"

#include <bit>
#include <cassert>

namespace relief {
namespace {

constexpr std::uint32_t kBits = 64;
constexpr std::uint64_t kFull = ~std::uint64_t{0};

std::uint64_t bit(std::uint32_t index) {
    return std::uint64_t{1} << (index % kBits);
}

std::uint32_t words(std::uint32_t bits) {
    return bits / kBits + (bits % kBits != 0 ? 1 : 0);
}

}  // namespace

IndexAllocator::IndexAllocator(std::uint32_t capacity) : capacity_(capacity), live_(words(capacity)) {
    std::uint32_t bits = words(capacity);
    while (bits > 1) {
        const std::uint32_t count = words(bits);
        any_.emplace_back(count);
        full_.emplace_back(count);
        // Bits beyond the end count as full, so that no walk leads there.
        if (bits % kBits != 0) {
            full_.back().back() = kFull << (bits % kBits);
        }
        bits = count;
    }
}

std::optional<std::uint32_t> IndexAllocator::acquire() {
    if (live_count_ == capacity_) {
        return std::nullopt;
    }
    std::uint32_t word = 0;
    for (std::size_t level = full_.size(); level-- > 0;) {
        word = word * kBits + static_cast<std::uint32_t>(std::countr_one(full_[level][word]));
    }
    const std::uint32_t index = word * kBits + static_cast<std::uint32_t>(std::countr_one(live_[word]));
    assert(index < capacity_);

    live_[word] |= bit(index);
    ++live_count_;
    extent_ = index + 1 > extent_ ? index + 1 : extent_;
    // The last word is full when its part below the capacity is.
    const std::uint32_t tail = capacity_ % kBits;
    const bool last = word + 1 == live_.size() && tail != 0;
    bool full = (last ? live_[word] | kFull << tail : live_[word]) == kFull;
    std::uint32_t below = word;
    for (std::size_t level = 0; level < any_.size(); ++level) {
        const std::uint32_t at = below / kBits;
        any_[level][at] |= bit(below);
        if (full) {
            full_[level][at] |= bit(below);
            full = full_[level][at] == kFull;
        }
        below = at;
    }
    return index;
}

bool IndexAllocator::release(std::uint32_t index) {
    if (!isLive(index)) {
        return false;
    }
    std::uint32_t below = index / kBits;
    live_[below] &= ~bit(index);
    --live_count_;
    bool empty = live_[below] == 0;
    for (std::size_t level = 0; level < any_.size(); ++level) {
        const std::uint32_t at = below / kBits;
        full_[level][at] &= ~bit(below);
        if (empty) {
            any_[level][at] &= ~bit(below);
            empty = any_[level][at] == 0;
        }
        below = at;
    }
    if (index + 1 == extent_) {
        extent_ = live_count_ == 0 ? 0 : highestLive() + 1;
    }
    return true;
}

bool IndexAllocator::isLive(std::uint32_t index) const {
    return index < capacity_ && (live_[index / kBits] & bit(index)) != 0;
}

std::uint32_t IndexAllocator::highestLive() const {
    const auto highest = [](std::uint64_t bits) {
        return kBits - 1 - static_cast<std::uint32_t>(std::countl_zero(bits));
    };
    std::uint32_t word = 0;
    for (std::size_t level = any_.size(); level-- > 0;) {
        word = word * kBits + highest(any_[level][word]);
    }
    return word * kBits + highest(live_[word]);
}

}  // namespace relief
