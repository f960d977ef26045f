// Floats that the GPU writes into buffers, on their way back to the CPU some frames later.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/base/result.h"
#include "runtime/gl/buffer_read.h"
#include "runtime/gl/gl_fault.h"

namespace relief {

/// Requests are collected in their order. \tparam Tag  comes back with the floats.
template <class Tag, int kMost>
class Readbacks {
  public:
    struct Done {
        Tag tag;
        std::vector<float> values;
    };

    [[nodiscard]] int inFlight() const { return in_flight_; }
    [[nodiscard]] bool full() const { return in_flight_ == kMost; }
    /// The oldest under way; null if there is none.
    [[nodiscard]] const Tag* oldest() const { return in_flight_ == 0 ? nullptr : &slots_[oldest_].tag; }

    /// A request, unless full(). \param floats  0: nothing to wait for.
    /// \param write  issues the commands that write them into GL_PIXEL_PACK_BUFFER, which is bound.
    template <class Write>
    void request(const Tag& tag, std::size_t floats, const Write& write) {
        Slot& slot = slots_[(oldest_ + static_cast<std::size_t>(in_flight_++)) % kMost];
        slot.tag = tag;
        slot.floats = floats;
        if (floats == 0) {
            return;
        }
        bindPackBuffer(slot.buffer, static_cast<GLsizeiptr>(floats * sizeof(float)));
        write();
        slot.fence.insert();
    }

    /// The oldest, if the GPU has finished it: never waits.
    [[nodiscard]] std::optional<Done> poll() {
        if (in_flight_ == 0 || (slots_[oldest_].floats > 0 && !slots_[oldest_].fence.passed())) {
            return std::nullopt;
        }
        return collect();
    }

    /// The oldest, which the GPU is waited for; nullopt if none is under way.
    /// \param what  for messages: "the statistics".
    /// Errors: kFailure (the GPU has not answered for ten seconds, or its memory cannot be read).
    [[nodiscard]] Result<std::optional<Done>> wait(const std::string& what) {
        if (in_flight_ == 0) {
            return std::optional<Done>();
        }
        constexpr GLuint64 kPatience = 10'000'000'000;  // nanoseconds
        if (slots_[oldest_].floats > 0 && !waitToRead(slots_[oldest_].fence, kPatience)) {
            RELIEF_TRY(checkGpu("reading " + what));
            return fail(ErrorCode::kFailure, "the GPU has not finished " + what + " within ten seconds");
        }
        auto done = collect();
        RELIEF_TRY(checkGpu("reading " + what));
        if (!done) {
            return fail(ErrorCode::kFailure,
                        what + " cannot be read from the GPU; choose a smaller capacity");
        }
        return done;
    }

  private:
    struct Slot {
        GlBuffer buffer;
        GlFence fence;
        std::size_t floats = 0;
        Tag tag{};
    };

    /// \return nullopt if the memory was lost.
    std::optional<Done> collect() {
        Slot& slot = slots_[oldest_];
        oldest_ = (oldest_ + 1) % kMost;
        --in_flight_;
        Done done{slot.tag, std::vector<float>(slot.floats)};
        if (slot.floats > 0) {
            slot.fence.remove();
            if (!readBuffer(slot.buffer, std::as_writable_bytes(std::span(done.values)))) {
                return std::nullopt;
            }
        }
        return done;
    }

    std::array<Slot, kMost> slots_;
    std::size_t oldest_ = 0;
    int in_flight_ = 0;
};

}  // namespace relief
