// SPDX-License-Identifier: Apache-2.0
// Sorts particles back to front for blending, on the GPU, without read-back or waits.
//
// StepPath::kCompute uses a radix sort, which is exact after every update(). The rest of this comment describes the
// fragment path: Batcher's odd-even merge sort in fragment passes, spread over any number of frames (paper, section
// 3.4). After a complete sequence, both paths give the same order.
//
//     bytes on the GPU = 16 · texels, texels = capacity rounded up to a power of two (and to whole rows of kWidth):
//         order  2 × RG32UI (double-buffered)    index of a particle, key: float bits of the squared distance to eye
//
// Every update() recomputes all keys and continues the sequence. No pass makes the order worse, and shrinking the
// number of ranks loses no particle (proofs: runtime/METHOD.md, "The depth sort"). If keys and extent do not change,
// the order is exact after one complete sequence; otherwise the order lags one to two sequences behind the motion.
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

    /// Needs a current context, as all non-const members do.
    /// \param capacity  maximum number of particles, 1…kCapacityMax; normally the capacity of the particle system.
    /// \param path      normally the path of the particle system.
    /// Errors: kUsage (capacity), kLimit (GL limits), kUnsupported, kFailure.
    [[nodiscard]] static Result<DepthSorter> create(std::uint32_t capacity, StepPath path = StepPath::kAuto);

    /// Recomputes the keys, then runs the next passes of the sequence; after its last pass, the next sequence starts.
    /// The compute path sorts completely. Call update() after each step that is drawn. Restores the GL state.
    /// \param positions  RGBA32F, particle i at texel (i mod width, i / width): xyz in object space, w < 0 for
    ///                   dead particles. Only used during the call.
    /// \param width      texels in a row of `positions`, > 0.
    /// \param extent     only particles with lower indices are sorted; clamped to the capacity.
    /// \param eye        object space.
    /// \param passes     any number; 0 only refreshes the keys. See passesPerFrame(). Ignored on the compute path.
    void update(const GlTexture& positions, std::uint32_t width, std::uint32_t extent, const glm::vec3& eye,
                std::uint32_t passes);

    /// Makes the next update() start a sequence, which sorts exactly if given sequencePasses(extent) passes. Keeps the
    /// current order.
    void restart();

    /// Returns the particles in drawing order, RG32UI or RGBA32UI (a usampler2D). Texel (i mod kWidth, i / kWidth) of
    /// rank i < count() holds the particle index (x) and its key at the last update() (y; 0: no particle). A renderer
    /// draws all count() ranks and skips ranks with key 0, because live particles may have any rank until a sequence is
    /// complete. Valid until the next update() or the destruction of the sorter.
    [[nodiscard]] const GlTexture& order() const;
    /// Returns the number of ranks. Compute path: the extent. Fragment path: the least power of two not below the
    /// extent, or a larger one for up to two sequences after the extent has shrunk; 0 before the first particle.
    [[nodiscard]] std::uint32_t count() const { return count_; }
    /// Returns the number of finished passes of the current sequence: 0…sequencePasses(count()) − 1, or 0 if
    /// count() < 2. Always 0 on the compute path.
    [[nodiscard]] std::uint32_t passesDone() const { return passes_done_; }

    /// Returns the number of passes of a complete sequence: 210 for 2^20 particles.
    [[nodiscard]] static std::uint32_t sequencePasses(std::uint32_t extent);
    /// Returns the number of passes per update() that complete a sequence within `frames` updates; `frames` > 0.
    [[nodiscard]] static std::uint32_t passesPerFrame(std::uint32_t extent, std::uint32_t frames);

  private:
    explicit DepthSorter(std::uint32_t capacity);
    [[nodiscard]] Result<void> createFragmentPath();
    void merge(const GlTexture& positions, std::uint32_t width, std::uint32_t extent, const glm::vec3& eye,
               std::uint32_t passes);
    void drawPass();
    void endSequence(std::uint32_t extent);
    void drawNext(const GlProgram& program);

    std::uint32_t capacity_ = 0;
    std::uint32_t count_ = 0;
    std::uint32_t peak_ = 0;  // largest extent since the start of the sequence
    std::uint32_t passes_done_ = 0;
    std::uint32_t block_ = 2;   // of the next pass
    std::uint32_t stride_ = 1;  // of the next pass
    int current_ = 0;           // buffer with the current order
    GlTexture order_[2];
    GlFramebuffer target_[2];
    GlProgram keys_;
    GlProgram pass_;
    std::unique_ptr<RadixSort> radix_;  // compute path; replaces the members above
};

}  // namespace relief
