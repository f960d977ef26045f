// SPDX-License-Identifier: Apache-2.0
// Triangles that give birth: uniform by their area, which moves and bends with its vertices.
//
//     EmitterSurface surface = *EmitterSurface::create(triangles, weights, positions);
//     surface.move(before, now, dt);               // each step in which something is born
//     EmitterSurface::Place at = surface.draw(random, age);
//
// Between the two ends of a step a vertex goes along a straight line at an even speed. Of one that goes round at ω radians a second at a
// distance r from its axis that is off by r (ω dt)² / 8 at most, and its velocity by r ω² dt / 2. Areas are those of the end; so where time is
// cut differently, of the births that a stretching surface makes a share as small as its stretch within a step lies on another triangle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "runtime/particles/birth_surface.h"

namespace relief {

class EmitterSurface : public BirthSurface {
  public:
    static constexpr std::size_t kTrianglesMax = std::size_t{1} << 22;

    /// Without triangles: nothing is born.
    EmitterSurface() = default;
    /// At rest.
    /// \param triangles  of indices of positions, anticlockwise seen from outside. Those without area or weight are left out.
    /// \param weights    density of the births at each position, ≥ 0, linear in between; empty: 1 everywhere.
    /// Errors: kUsage (an index, a number), kLimit (more than kTrianglesMax), kInvalidInput (no area that has a weight).
    [[nodiscard]] static Result<EmitterSurface> create(std::span<const glm::uvec3> triangles,
                                                       std::vector<float> weights,
                                                       std::vector<glm::vec3> positions);

    [[nodiscard]] std::size_t vertices() const { return end_.size(); }

    [[nodiscard]] std::unique_ptr<BirthSurface> clone() const override {
        return std::make_unique<EmitterSurface>(*this);
    }
    /// \param before, now  vertices() each. Takes a time by its triangles.
    void move(std::span<const glm::vec3> before, std::span<const glm::vec3> now, double seconds) override;
    [[nodiscard]] double area() const override { return upto_.empty() ? 0.0 : upto_.back(); }
    [[nodiscard]] Bounds bounds() const override;
    [[nodiscard]] Place draw(Pcg32& random, float age) const override;

  private:
    void weigh();
    [[nodiscard]] glm::vec3 cornersShare(Pcg32& random, const glm::uvec3& triangle) const;

    std::vector<glm::uvec3> triangles_;
    std::vector<float> weights_;
    std::vector<glm::vec3> begin_;  // empty: it does not move
    std::vector<glm::vec3> end_;
    std::vector<double> upto_;  // of triangle i: Σ area · weight of those up to it
    double seconds_ = 0.0;
};

}  // namespace relief
