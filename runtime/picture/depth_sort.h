// SPDX-License-Identifier: Apache-2.0
// The order in which particles are to be drawn so that they blend: farthest from the viewer first. Nothing is read
// back and nothing waits for the GPU.
//
// On StepPath::kCompute it is exact after every update(): a radix sort. What follows is about the other
// path, Batcher's odd-even merge sort in fragment passes, spread over as many frames as one likes (paper, section 3.4).
// Where that has ended a sequence both give the same order.
//
//     bytes on the GPU = 16 · texels, texels = capacity rounded up to a power of two (and to whole rows of kWidth):
//         order  2 × RG32UI (double-buffered)    index of a particle, key
//
// Every update() computes all keys afresh and goes on with the sequence. No pass makes an order worse, and the sorted region
// grows and shrinks by powers of two (runtime/METHOD.md, "The depth sort", has the proofs). If keys and extent do not change,
// the order is sorted after one whole sequence; else it lags behind by the motion of one to two sequences.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/particles/step_path.h"

namespace relief {

class RadixSort;

class DepthSorter {
  public:
    ~DepthSorter();
    DepthSorter(DepthSorter&&) noexcept;
    DepthSorter& operator=(DepthSorter&&) noexcept;

    static constexpr std::uint32_t kWidth = 1024;  ///< texels in a row of order()
    static constexpr std::uint32_t kCapacityMax = 1U << 24;

    /// Needs a current context, as every call does that is not const.
    /// \param capacity  particles that there may be at once, 1…kCapacityMax: that of the particle system.
    /// \param path      how it sorts: the system's, as a rule.
    /// Errors: kUsage (capacity), kLimit (above what this GL takes), kUnsupported, kFailure.
    [[nodiscard]] static Result<DepthSorter> create(std::uint32_t capacity, StepPath path = StepPath::kAuto);

    /// Computes the keys afresh, then makes the next passes of the sequence; after its last pass the next one
    /// begins. On the compute path: sorts. To be called after every step of the particles that is drawn. Restores the GL state that it
    /// touches.
    /// \param positions  RGBA32F, particle i at texel (i mod width, i / width): xyz in object space, w < 0 for
    ///                   the dead. Not kept.
    /// \param width      texels in a row of `positions`, > 0.
    /// \param extent     the particles are those of the indices below it. At most the capacity; what is beyond
    ///                   that is left out.
    /// \param eye        object space.
    /// \param passes     any number; 0 refreshes the keys alone. See passesPerFrame(). On the compute path, which has
    ///                   no sequence to spread, it has no effect.
    void update(const GlTexture& positions, std::uint32_t width, std::uint32_t extent, const glm::vec3& eye,
                std::uint32_t passes);

    /// Lets the next update() begin a sequence: with sequencePasses(extent) passes it then sorts exactly. The
    /// order is kept.
    void restart();

    /// The particles in drawing order, RG32UI or RGBA32UI (a usampler2D): rank i < count() at texel (i mod kWidth,
    /// i / kWidth) holds x: the particle's index, and y: its key as of the last update(), 0 where there is
    /// nothing to draw. A renderer draws all count() ranks and drops those of key 0: until a sequence has
    /// ended, live particles may lie at any of them. Valid until the next update() or the sorter's end.
    [[nodiscard]] const GlTexture& order() const;
    /// The ranks that hold an order. On the compute path the extent; on the other the least power of two not below the extent, or a larger one for up to
    /// two sequences after the extent has fallen; 0 before the first particle.
    [[nodiscard]] std::uint32_t count() const { return count_; }
    /// Passes that the sequence under way has had (none on the compute path), below sequencePasses(count()) unless both are 0.
    [[nodiscard]] std::uint32_t passesDone() const { return passes_done_; }

    /// The passes of a whole sequence for so many particles: 210 for 2^20.
    [[nodiscard]] static std::uint32_t sequencePasses(std::uint32_t extent);
    /// The passes for each update() so that a sequence ends within `frames` of them; `frames` > 0.
    [[nodiscard]] static std::uint32_t passesPerFrame(std::uint32_t extent, std::uint32_t frames);

  private:
    explicit DepthSorter(std::uint32_t capacity);
    [[nodiscard]] Result<void> createTextures();
    [[nodiscard]] Result<void> createPrograms();
    void merge(const GlTexture& positions, std::uint32_t width, std::uint32_t extent, const glm::vec3& eye,
               std::uint32_t passes);
    void drawPass();
    void endSequence(std::uint32_t extent);
    void drawNext(const GlProgram& program);

    std::uint32_t capacity_ = 0;
    std::uint32_t count_ = 0;
    std::uint32_t peak_ = 0;  // the largest extent since the sequence began
    std::uint32_t passes_done_ = 0;
    std::uint32_t block_ = 2;   // of the next pass
    std::uint32_t stride_ = 1;  // of the next pass
    int current_ = 0;           // which of the two buffers holds the order
    GlTexture order_[2];
    GlFramebuffer target_[2];
    GlProgram keys_;
    GlProgram pass_;
    std::unique_ptr<RadixSort> radix_;  // instead of all the above
};

}  // namespace relief
