// SPDX-License-Identifier: Apache-2.0
// The events of a step as lists on the GPU, and its way back to the CPU some steps later.
//
// The step writes what happened to each particle into two textures (shaders/events/step_event.glsl). The list is made of them
// by fragments alone, on either path: sums of kEventsCounted in kEventLevels levels count the events before each
// index, and every texel of the list looks its own event up (a histogram pyramid, Ziegler et al. 2006).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "runtime/events/particle_event.h"
#include "runtime/gl/gl_fence.h"
#include "runtime/gl/gl_object.h"
#include "runtime/particles/particle_type.h"
#include "shaders/events/constants.h"

namespace relief {

class EventList {
  public:
    static constexpr int kInFlightMax = 8;  ///< requests not yet collected

    /// A step that has just been made, in the particle system's textures.
    struct Step {
        const GlTexture& velocity;  ///< as step_event.glsl writes them
        const GlTexture& surface;
        const GlTexture& position_before;
        const GlTexture& birth;
        std::uint32_t width = 0;   ///< of the textures
        std::uint32_t extent = 0;  ///< particles that were stepped
        std::span<const ParticleType> types;
        std::uint64_t tag = 0;
        std::uint64_t number = 0;  ///< of the step
        double begin = 0.0;        ///< of the step, seconds
        double end = 0.0;
        std::uint32_t materials = 0;  ///< names of materials, WorldTextures::materialNames()
    };
    /// The most (bodies + 1) · (names of materials + 1) whose events a step can tell apart.
    static constexpr std::size_t kPlacesMax = (std::size_t{1} << 24) / (kEventFlags * kEventDirections);
    /// A list read back: ids are modulo 2^24.
    struct Collected {
        StepEvents events;
        std::uint64_t number = 0;
    };

    /// \param lists     1 to kEventLists. \param capacity  of the particle system.
    /// Errors: kUsage (the options), kLimit, kUnsupported, kFailure.
    [[nodiscard]] static Result<EventList> create(std::span<const EventOptions> lists,
                                                  std::uint32_t capacity);

    /// Makes the list, and requests its read-back. With the state of a pass (PassState).
    /// \return false, and nothing is made, while kInFlightMax are under way.
    bool request(const Step& step);
    /// The oldest list, if the GPU has finished it: never waits.
    [[nodiscard]] std::optional<Collected> poll();
    /// The oldest list, which the GPU is waited for; nullopt if none is under way.
    /// Errors: kFailure (the GPU has not answered for ten seconds, or its memory cannot be read).
    [[nodiscard]] Result<std::optional<Collected>> wait();
    [[nodiscard]] int inFlight() const { return in_flight_; }
    /// The number of the oldest step under way.
    [[nodiscard]] std::optional<std::uint64_t> oldestNumber() const {
        return in_flight_ == 0 ? std::nullopt : std::optional(requests_[oldest_].number);
    }

    /// The lists of the last request, four textures of RGBA32F, kEventsWidth texels in a row: position, surface,
    /// velocity and identity of shaders/events/event_list.frag. Each list begins with a row of its own.
    [[nodiscard]] std::span<const GlTexture, 4> textures() const { return list_; }
    /// A texel: x is the number of events of the first list, y that of the second, and so on; each list holds `most` of them.
    [[nodiscard]] const GlTexture& total() const { return counts_[kLevels - 1].texture; }

  private:
    static constexpr std::size_t kLevels = 4;
    struct Level {
        GlTexture texture;
        GlFramebuffer target;
    };
    /// A list on its way back. Requests are collected in their order.
    struct Request {
        std::uint64_t tag = 0;  // these as Step has them
        std::uint64_t number = 0;
        double begin = 0.0;
        double end = 0.0;
        std::size_t floats = 0;  // 0: nothing to wait for
        std::array<std::uint32_t, kEventLists> first_row{};
        GlBuffer buffer;
        GlFence fence;
    };
    EventList() = default;
    [[nodiscard]] Result<void> createTextures(std::uint32_t capacity);
    [[nodiscard]] Result<void> createPrograms();
    [[nodiscard]] std::uint32_t listWidth() const;
    [[nodiscard]] std::uint32_t longest() const;
    /// Of a system of so many particles. \return of all lists. \param first_row  of each; of those that do not exist, never met.
    std::uint32_t layOut(std::uint32_t particles, std::array<std::uint32_t, kEventLists>& first_row) const;
    void useFilter(const GlProgram& program) const;
    void count(const Step& step) const;
    void makeLists(const Step& step, const Request& request, std::uint32_t rows) const;
    void read(std::uint32_t rows) const;
    /// The oldest, which the GPU has finished; nullopt if its memory was lost.
    [[nodiscard]] std::optional<Collected> collect();
    [[nodiscard]] static bool readFloats(const Request& request, std::size_t first, std::span<float> out);
    /// Adds the events of a list. \param values  of them, plane by plane.
    void decode(const Request& request, std::span<const float> values, StepEvents& to) const;

    std::vector<EventOptions> lists_;
    std::array<Level, kLevels> counts_;
    std::array<GlTexture, 4> list_;
    GlFramebuffer list_target_;
    GlProgram count_program_;
    GlProgram sum_program_;
    GlProgram list_program_;
    std::array<Request, kInFlightMax> requests_;
    std::size_t oldest_ = 0;
    int in_flight_ = 0;
};

}  // namespace relief
