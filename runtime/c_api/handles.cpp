#include "runtime/c_api/handles.h"

#include <bit>
#include <new>
#include <utility>

namespace relief {

HandleTable::Place& HandleTable::at(std::uintptr_t place) const {
    const std::uintptr_t shifted = place + (std::uintptr_t{1} << kFirstBlockBits);
    const int bits = static_cast<int>(std::bit_width(shifted)) - 1;
    Place* block = blocks_[static_cast<std::size_t>(bits - kFirstBlockBits)].load(std::memory_order_acquire);
    return block[shifted - (std::uintptr_t{1} << bits)];
}

HandleTable::~HandleTable() {
    for (const auto& block : blocks_) {
        delete[] block.load(std::memory_order_relaxed);
    }
}

std::uintptr_t HandleTable::add(HandleKind kind, std::shared_ptr<void> object) {
    const std::lock_guard lock(mutex_);
    std::uintptr_t index = free_;
    if (index == kNoPlace) {
        index = used_.load(std::memory_order_relaxed);
        // The last block would hold more places than a handle counts.
        if (index >= kPlacesMax - (std::uintptr_t{1} << kFirstBlockBits)) {
            throw std::bad_alloc();
        }
        const std::uintptr_t shifted = index + (std::uintptr_t{1} << kFirstBlockBits);
        if (std::has_single_bit(shifted)) {
            blocks_[static_cast<std::size_t>(std::bit_width(shifted)) - 1 - kFirstBlockBits].store(
                new Place[shifted], std::memory_order_release);
        }
        used_.store(index + 1, std::memory_order_release);
    }
    Place& place = at(index);
    free_ = std::exchange(place.next_free, kNoPlace);
    place.object = std::move(object);
    ++place.generation;
    const std::uintptr_t handle = ~(~std::uintptr_t{0} >> 1) | place.generation << (kKindBits + kPlaceBits) |
                                  index << kKindBits | static_cast<std::uintptr_t>(kind);
    place.handle.store(handle, std::memory_order_release);
    return handle;
}

const std::shared_ptr<void>* HandleTable::find(HandleKind kind, std::uintptr_t handle) const noexcept {
    const std::uintptr_t index = placeOf(handle);
    if ((handle & ((1U << kKindBits) - 1)) != static_cast<std::uintptr_t>(kind) ||
        index >= used_.load(std::memory_order_acquire)) {
        return nullptr;
    }
    const Place& place = at(index);
    return place.handle.load(std::memory_order_acquire) == handle ? &place.object : nullptr;
}

std::shared_ptr<void> HandleTable::remove(HandleKind kind, std::uintptr_t handle) noexcept {
    const std::lock_guard lock(mutex_);
    if (find(kind, handle) == nullptr) {
        return nullptr;
    }
    const std::uintptr_t index = placeOf(handle);
    Place& place = at(index);
    place.handle.store(0, std::memory_order_release);
    if (place.generation < kGenerationsMax) {
        place.next_free = std::exchange(free_, index);
    }
    return std::move(place.object);
}

HandleFault HandleTable::faultOf(HandleKind kind, std::uintptr_t handle) const noexcept {
    if (handle == 0) {
        return HandleFault::kNull;
    }
    const std::lock_guard lock(mutex_);
    const std::uintptr_t index = placeOf(handle);
    const std::uintptr_t kinds = handle & ((1U << kKindBits) - 1);
    const bool highest = (handle & ~(~std::uintptr_t{0} >> 1)) != 0;
    if (!highest || kinds == 0 || kinds > kHandleKinds || index >= used_.load(std::memory_order_relaxed)) {
        return HandleFault::kNever;
    }
    const Place& place = at(index);
    if (place.handle.load(std::memory_order_relaxed) == handle) {
        return kinds == static_cast<std::uintptr_t>(kind) ? HandleFault::kNull : HandleFault::kOtherKind;
    }
    const std::uintptr_t generation = (handle >> (kKindBits + kPlaceBits)) & kGenerationsMax;
    return generation != 0 && generation <= place.generation ? HandleFault::kFreed : HandleFault::kNever;
}

HandleTable& handleTable() {
    static auto* const table = new HandleTable;
    return *table;
}

}  // namespace relief
