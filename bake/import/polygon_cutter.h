// SPDX-License-Identifier: Apache-2.0
// Triangulates polygons.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace relief {

/// Triangulates polygons, including concave ones and those with corners on straight edges. Reuses its memory between
/// polygons.
///
/// Clips ears in corner order, in the coordinate plane closest to the polygon's plane. Every ear has a nonzero area: a
/// corner on a straight edge becomes part of such an ear, because a triangle without area would be dropped and leave a
/// slit. If no such triangulation exists, because the polygon crosses itself or has no area, the result has the fewest
/// flipped or flat triangles. The projection only drops a coordinate, so precision does not depend on the distance from
/// the origin.
///
/// The first attempt repeats assimp's tests in float precision, so that baked files stay byte-identical. Its result is
/// used unless another attempt is better.
class PolygonCutter {
  public:
    /// Triangulates a polygon.
    /// \param corners  at least 3, in order.
    /// \return corners.size() − 2 triangles as indices into `corners`, with the polygon's winding; valid until the next
    /// call.
    [[nodiscard]] std::span<const glm::uvec3> cut(std::span<const glm::vec3> corners);

  private:
    /// The other corners that disqualify an ear: corners inside it (rounded or exact), or also corners on its edges.
    enum class Test : std::uint8_t { kRounded, kInside, kTouching };

    void project(std::span<const glm::vec3> corners);
    [[nodiscard]] double area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
    void cutQuad(std::span<const glm::vec3> corners);
    void cutEars(Test test);
    [[nodiscard]] bool isEar(std::uint32_t corner, Test test) const;
    [[nodiscard]] bool isRoundedEar(std::uint32_t corner) const;
    [[nodiscard]] bool holds(std::uint32_t ear, const glm::dvec2& point, Test test) const;
    void cutOff(std::uint32_t ear);
    [[nodiscard]] std::uint32_t largestCorner(std::uint32_t start) const;
    void markReflex(std::uint32_t corner);
    /// Counts triangles that have no area in space or are flipped in the plane.
    [[nodiscard]] std::size_t wrongTriangles(std::span<const glm::vec3> corners) const;

    std::vector<glm::dvec2> points_;  // counter-clockwise
    std::vector<std::uint32_t> before_;
    std::vector<std::uint32_t> next_;
    std::vector<std::uint8_t> reflex_;     // 1: a remaining corner that is reflex
    std::vector<std::uint32_t> reflexes_;  // all corners that were reflex at some time
    std::size_t sorted_ = 0;               // length of the prefix of reflexes_ that is sorted by x
    std::vector<glm::uvec3> triangles_;
    std::vector<glm::uvec3> best_;
};

/// Rotates the corners of triangles so that consecutive triangles have the same first vertex only if they form a
/// quadrilateral; shapes do not change. assimp marks polygons this way; imitating it keeps baked files byte-identical.
class TriangleStarts {
  public:
    /// \param polygon  its triangles, as vertex indices of the mesh.
    void turn(std::span<glm::uvec3> polygon);

  private:
    std::uint32_t last_ = ~std::uint32_t{0};
};

}  // namespace relief
