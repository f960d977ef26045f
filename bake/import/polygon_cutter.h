// SPDX-License-Identifier: Apache-2.0
// Polygons as triangles.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace relief {

/// Cuts polygons into triangles, concave ones and such with corners on straight edges too. Its memory serves one polygon
/// after the other.
///
/// Ears are cut off in the plane of two axes that the polygon leans least against, in the order of the corners. Each has an
/// area: a corner on a straight edge becomes the corner of a triangle that has one, as a triangle without would be left out
/// and leave a slit. Where the polygon has no such triangles, because it crosses itself or has no area, it gets those with
/// the fewest that are turned over or flat. Projected coordinates are those of the polygon: they lose nothing far from the
/// origin.
///
/// The first try has the tests of assimp in its precision, of floats, so that bakes keep their bytes; its result counts only
/// where every triangle has an area.
class PolygonCutter {
  public:
    /// \param corners  at least 3, in order.
    /// \return corners.size() − 2 triangles, as indices into `corners`, wound as the polygon is. Valid until the next call.
    [[nodiscard]] std::span<const glm::uvec3> cut(std::span<const glm::vec3> corners);

  private:
    /// Which other corners keep three in a row from being an ear: those inside of it, up to roundings or exactly, or those
    /// on its edges too.
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
    /// Triangles without area in space, or turned over in the plane.
    [[nodiscard]] std::size_t wrongTriangles(std::span<const glm::vec3> corners) const;

    std::vector<glm::dvec2> points_;  // counter-clockwise
    std::vector<std::uint32_t> before_;
    std::vector<std::uint32_t> next_;
    std::vector<std::uint8_t> reflex_;     // 1: of the corners that are left, one that is not convex
    std::vector<std::uint32_t> reflexes_;  // those that were once
    std::size_t sorted_ = 0;               // of reflexes_, the first, by their x
    std::vector<glm::uvec3> triangles_;
    std::vector<glm::uvec3> best_;
};

/// Turns the triangles of a mesh's polygons so that none begins at the vertex where the one before it began; the shape is the
/// same. assimp tells polygons apart so, and bakes that go on to begin each triangle where they always did keep their bytes.
class TriangleStarts {
  public:
    /// \param polygon  its triangles, of the mesh's vertices.
    void turn(std::span<glm::uvec3> polygon);

  private:
    std::uint32_t last_ = ~std::uint32_t{0};
};

}  // namespace relief
