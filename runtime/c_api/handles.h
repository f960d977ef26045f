// Handles of C. A handle is a number in the shape of a pointer: kind, place in a table, and generation of that
// place. It is looked up, never followed, so that whatever a caller passes on is answered and cannot crash:
//
//     64 bits:  1 | generation, 30 bits | place, 30 bits | kind, 3 bits           (32 bits: 14 and 14)
//
// No number is given out twice: a place whose generations are used up is given up. Kinds begin at 1, so that no pointer to an
// aligned object is a handle; the highest bit keeps handles out of a program's own addresses. A look-up takes no lock: two
// loads and two comparisons, some nanoseconds. What is made and freed takes one.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>

namespace relief {

enum class HandleKind : std::uint8_t { kCollider = 1, kTextures, kParticles, kPicture };
inline constexpr std::size_t kHandleKinds = 4;

/// Why a handle means nothing.
enum class HandleFault : std::uint8_t {
    kNull,
    kFreed,
    kOtherKind,  ///< alive, but of another kind
    kNever,      ///< no such handle has been given out
};

/// All calls may be made by several threads at once. Whoever removes an object while another thread uses it has a race, as
/// with any object.
class HandleTable {
  public:
    HandleTable() = default;
    ~HandleTable();
    HandleTable(const HandleTable&) = delete;
    HandleTable& operator=(const HandleTable&) = delete;

    /// Never 0. Throws std::bad_alloc, also where all places are taken; nothing has changed then.
    [[nodiscard]] std::uintptr_t add(HandleKind kind, std::shared_ptr<void> object);
    /// Null: faultOf() has the reason.
    [[nodiscard]] const std::shared_ptr<void>* find(HandleKind kind, std::uintptr_t handle) const noexcept;
    /// The object, which the caller may be the last to hold; null as find().
    [[nodiscard]] std::shared_ptr<void> remove(HandleKind kind, std::uintptr_t handle) noexcept;
    /// Of one that find() does not find.
    [[nodiscard]] HandleFault faultOf(HandleKind kind, std::uintptr_t handle) const noexcept;

  private:
    static constexpr int kKindBits = 3;
    static constexpr int kPlaceBits = (static_cast<int>(8 * sizeof(std::uintptr_t)) - 1 - kKindBits) / 2;
    static constexpr std::uintptr_t kPlacesMax = std::uintptr_t{1} << kPlaceBits;
    static constexpr std::uintptr_t kGenerationsMax = kPlacesMax - 1;
    static constexpr std::uintptr_t kNoPlace = kPlacesMax;
    static constexpr int kFirstBlockBits = 6;

    struct Place {
        std::atomic<std::uintptr_t> handle{0};  // 0: nothing lives here
        std::shared_ptr<void> object;           // written before the handle is
        std::uintptr_t generation = 0;          // of the last one that lived here
        std::uintptr_t next_free = kNoPlace;
    };
    [[nodiscard]] static std::uintptr_t placeOf(std::uintptr_t handle) {
        return (handle >> kKindBits) & (kPlacesMax - 1);
    }
    [[nodiscard]] Place& at(std::uintptr_t place) const;

    // Block b has 2^(b + kFirstBlockBits) places, so that a place never moves. They go with the table.
    std::array<std::atomic<Place*>, kPlaceBits> blocks_{};
    std::atomic<std::uintptr_t> used_{0};  // places that have ever been taken
    mutable std::mutex mutex_;             // of what follows, and of all changes
    std::uintptr_t free_ = kNoPlace;
};

/// The process's own. It is never destroyed: what the program does not free goes with the process.
[[nodiscard]] HandleTable& handleTable();

}  // namespace relief
