// SPDX-License-Identifier: Apache-2.0
// Emits from triangles, uniformly by area; the surface may move and deform with its vertices.
//
//     EmitterSurface surface = *EmitterSurface::create(triangles, weights, positions);
//     surface.move(before, now, dt);               // each step with births
//     EmitterSurface::Place at = surface.draw(random, age);
//
// Between the two ends of a step, vertices move along straight lines at constant speed. For rotation at ω rad/s at
// distance r from the axis, positions are off by at most r (ω dt)² / 8 and velocities by r ω² dt / 2. Areas are those
// at the end of the step. On a stretching surface, some births therefore fall on other triangles if the step length
// changes; their fraction is of the order of the stretch within a step.
#pragma once

#include <cstddef>
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

    /// Creates a surface without triangles, which emits nothing.
    EmitterSurface() = default;
    /// Creates a surface at rest.
    /// \param triangles  indices into positions, counter-clockwise seen from outside. Triangles without area or weight
    /// are ignored.
    /// \param weights    density of births at each position, ≥ 0, interpolated linearly; empty: 1 everywhere.
    /// Errors: kUsage (an invalid index or weight), kLimit (more than kTrianglesMax), kInvalidInput (no weighted area).
    [[nodiscard]] static Result<EmitterSurface> create(std::span<const glm::uvec3> triangles,
                                                       std::vector<float> weights,
                                                       std::vector<glm::vec3> positions);

    [[nodiscard]] std::size_t vertices() const { return end_.size(); }

    [[nodiscard]] std::unique_ptr<BirthSurface> clone() const override {
        return std::make_unique<EmitterSurface>(*this);
    }
    /// Takes time proportional to the number of triangles. \param before, now  vertices() positions each.
    void move(std::span<const glm::vec3> before, std::span<const glm::vec3> now, double seconds) override;
    [[nodiscard]] double area() const override { return upto_.empty() ? 0.0 : upto_.back(); }
    [[nodiscard]] Bounds bounds() const override;
    [[nodiscard]] Place draw(Pcg32& random, float age) const override;

  private:
    void weigh();
    [[nodiscard]] glm::vec3 sampleBarycentric(Pcg32& random, const glm::uvec3& triangle) const;

    std::vector<glm::uvec3> triangles_;
    std::vector<float> weights_;
    std::vector<glm::vec3> begin_;  // empty if at rest
    std::vector<glm::vec3> end_;
    std::vector<double> upto_;  // prefix sums of area · weight, up to and including triangle i
    double seconds_ = 0.0;
};

}  // namespace relief
