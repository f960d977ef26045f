// SPDX-License-Identifier: Apache-2.0
#include "runtime/particles/index_allocator.h"

#include <algorithm>
#include <bit>

namespace relief {
namespace {

constexpr std::uint32_t kBits = 64;

std::uint64_t bit(std::uint32_t index) {
    return std::uint64_t{1} << (index % kBits);
}

}  // namespace

IndexAllocator::IndexAllocator(std::uint32_t capacity)
    : capacity_(capacity), live_((std::size_t{capacity} + kBits - 1) / kBits) {}

std::optional<std::uint32_t> IndexAllocator::acquire() {
    if (live_count_ == capacity_) {
        return std::nullopt;
    }
    while (~live_[first_] == 0) {
        ++first_;
    }
    const auto index = static_cast<std::uint32_t>(first_) * kBits +
                       static_cast<std::uint32_t>(std::countr_one(live_[first_]));
    live_[first_] |= bit(index);
    ++live_count_;
    extent_ = std::max(extent_, index + 1);
    return index;
}

bool IndexAllocator::release(std::uint32_t index) {
    if (!isLive(index)) {
        return false;
    }
    live_[index / kBits] &= ~bit(index);
    --live_count_;
    first_ = std::min<std::size_t>(first_, index / kBits);
    // Amortized: the extent also grew index by index.
    while (extent_ > 0 && !isLive(extent_ - 1)) {
        --extent_;
    }
    return true;
}

bool IndexAllocator::isLive(std::uint32_t index) const {
    return index < capacity_ && (live_[index / kBits] & bit(index)) != 0;
}

}  // namespace relief
