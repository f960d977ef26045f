// SPDX-License-Identifier: Apache-2.0
// Lists the events of a step on the GPU, and reads them back to the CPU some steps later.
//
// The step writes the event of each particle into two textures (shaders/events/step_event.glsl). On either StepPath,
// fragment shaders build each list with a histogram pyramid of kEventLevels levels (Ziegler et al. 2006): a texel of a
// level sums kEventsPerCount counts of the level below, and texel k of the list descends the levels to event k.
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

    /// The completed step, in the particle system's textures.
    struct Step {
        const GlTexture& velocity;         ///< written by step_event.glsl
        const GlTexture& surface;          ///< written by step_event.glsl
        const GlTexture& position_before;  ///< positions before the step
        const GlTexture& birth;
        std::uint32_t width = 0;   ///< width of the textures
        std::uint32_t extent = 0;  ///< number of particles stepped
        std::span<const ParticleType> types;
        std::uint64_t tag = 0;
        std::uint64_t number = 0;  ///< step number
        double begin = 0.0;        ///< start of the step, seconds
        double end = 0.0;
        std::uint32_t materials = 0;  ///< number of material names, WorldTextures::materialNames()
    };
    /// Maximum (bodies + 1) · (material names + 1) that events can distinguish.
    static constexpr std::size_t kPlacesMax = (std::size_t{1} << 24) / (kEventFlags * kEventDirections);
    /// The lists of one step, read back; ids are modulo 2^24.
    struct Collected {
        StepEvents events;
        std::uint64_t number = 0;
    };

    /// Creates the textures and programs of the lists.
    /// \param lists     1 to kEventLists. \param capacity  the capacity of the particle system.
    /// Errors: kUsage (invalid options), kLimit, kUnsupported, kFailure.
    [[nodiscard]] static Result<EventList> create(std::span<const EventOptions> lists,
                                                  std::uint32_t capacity);

    /// Builds the lists and requests their read-back. Call it inside a PassState.
    /// \return false, without effect, if kInFlightMax requests are pending.
    bool request(const Step& step);
    /// Returns the lists of the oldest pending request if the GPU has finished them; never waits.
    [[nodiscard]] std::optional<Collected> poll();
    /// Waits for the lists of the oldest pending request; nullopt if no request is pending.
    /// Errors: kFailure (no response from the GPU for ten seconds, or its memory cannot be read).
    [[nodiscard]] Result<std::optional<Collected>> wait();
    [[nodiscard]] int inFlight() const { return in_flight_; }
    /// Returns the number of the oldest pending step.
    [[nodiscard]] std::optional<std::uint64_t> oldestNumber() const {
        return in_flight_ == 0 ? std::nullopt : std::optional(requests_[oldest_].number);
    }

    /// Returns the lists of the last request as four RGBA32F textures with kEventsWidth texels per row: position,
    /// surface, velocity and identity (shaders/events/event_list.frag). Each list starts in a new row.
    [[nodiscard]] std::span<const GlTexture, 4> textures() const { return list_; }
    /// Returns a texture of one texel: the number of events of the first list in x, of the second in y, and so on. Each
    /// list stores at most EventOptions::max_per_step events.
    [[nodiscard]] const GlTexture& total() const { return counts_[kLevels - 1].texture; }

  private:
    static constexpr std::size_t kLevels = 4;
    struct Level {
        GlTexture texture;
        GlFramebuffer target;
    };
    /// The pending lists of one step. Requests are collected in order.
    struct Request {
        std::uint64_t tag = 0;  // copied from Step, as are the next three
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
    /// Assigns rows to the lists of a step of `particles` particles. \return the total number of rows.
    /// \param first_row  receives the first row of each list, and for missing lists a row beyond all lists.
    std::uint32_t layOut(std::uint32_t particles, std::array<std::uint32_t, kEventLists>& first_row) const;
    void useFilter(const GlProgram& program) const;
    void count(const Step& step) const;
    void makeLists(const Step& step, const Request& request, std::uint32_t rows) const;
    void read(std::uint32_t rows) const;
    /// Collects the oldest request, which the GPU has finished; nullopt if its memory was lost.
    [[nodiscard]] std::optional<Collected> collect();
    [[nodiscard]] static bool readFloats(const Request& request, std::size_t first, std::span<float> out);
    /// Appends the events of a list. \param values  its texels in each texture of list_, one texture after the other.
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
