// SPDX-License-Identifier: Apache-2.0
// Shapes with closed-form ray hits, and depth maps computed from them in double precision: the ground truth of these
// tests. No code here calls vote(), cubeCoordinates() or cubeDirection().
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "formats/collider.h"
#include "formats/depth_map.h"
#include "tests/formats/rotation.h"

namespace relief::test {

struct Hit {
    double t;           // object units along a ray of unit direction, > 0
    glm::dvec3 normal;  // unit length, outwards
};

class Shape {
  public:
    virtual ~Shape() = default;
    /// All hits, nearest first.
    [[nodiscard]] virtual std::vector<Hit> hits(const glm::dvec3& origin,
                                                const glm::dvec3& direction) const = 0;
    [[nodiscard]] virtual bool inside(const glm::dvec3& p) const = 0;
};

[[nodiscard]] std::unique_ptr<Shape> makeSphere(const glm::dvec3& center, double radius);
[[nodiscard]] std::unique_ptr<Shape> makeBox(const glm::dvec3& center, const glm::dvec3& half);
/// A torus around the z axis of object space. Supports only rays through its centre or parallel to its axis, whose hits
/// are roots of a quadratic.
[[nodiscard]] std::unique_ptr<Shape> makeTorus(double ring_radius, double tube_radius);

/// The volume of an orthographic map: p = origin + axes · (sides ∘ p').
struct OrthographicFrame {
    glm::dvec3 origin;
    glm::dmat3 axes;  // columns: orthonormal
    glm::dvec3 sides;

    [[nodiscard]] glm::dvec3 toObject(const glm::dvec3& map) const { return origin + axes * (sides * map); }
    [[nodiscard]] glm::dvec3 toMap(const glm::dvec3& p) const;
};

/// The volume of a cube map: p = center + axes · (half ∘ p').
struct CubeFrame {
    glm::dvec3 center;
    glm::dmat3 axes;
    glm::dvec3 half;

    [[nodiscard]] glm::dvec3 toObject(const glm::dvec3& map) const { return center + axes * (half * map); }
};

inline const glm::dmat3 kTurned = rotation({1.0, 2.0, -0.5}, 37.0);  ///< not aligned with any axis

/// A centred volume with the given side lengths.
[[nodiscard]] OrthographicFrame centeredFrame(const glm::dvec3& center, const glm::dmat3& axes,
                                              const glm::dvec3& sides);

/// A map with this frame and no surfaces.
[[nodiscard]] DepthMap emptyMap(const OrthographicFrame& frame, MapFormat format, Compare compare,
                                std::uint32_t width, std::uint32_t height);
[[nodiscard]] DepthMap emptyMap(const CubeFrame& frame, Compare compare, std::uint32_t size);

/// Hits of the ray through the texel's centre that lie inside the volume, nearest first.
[[nodiscard]] std::vector<Hit> texelHits(const Shape& shape, const OrthographicFrame& frame,
                                         const DepthMap& map, std::uint32_t x, std::uint32_t y);

/// The direction in map space through the texel's centre, not of unit length. Solves OpenGL 3.3, table 3.21, for the
/// direction.
[[nodiscard]] glm::dvec3 cubeTexelDirection(std::uint32_t face, std::uint32_t x, std::uint32_t y,
                                            std::uint32_t size);

[[nodiscard]] DepthMap makeMap(const Shape& shape, const OrthographicFrame& frame, MapFormat format,
                               Compare compare, std::uint32_t width, std::uint32_t height);
[[nodiscard]] DepthMap makeMap(const Shape& shape, const CubeFrame& frame, Compare compare,
                               std::uint32_t size);

/// Front-back maps along the three axes. Each has a margin of three texels around a box of this half side.
[[nodiscard]] Collider threeMaps(const Shape& shape, const glm::dvec3& center, const glm::dmat3& axes,
                                 double half, std::uint32_t size, MapFormat format,
                                 Decode decode = Decode::kProjected);

[[nodiscard]] double angleInDegrees(const glm::dvec3& a, const glm::dvec3& b);

/// Settings of an orthographic map.
struct Encoding {
    MapFormat format;
    Compare compare;
};
inline constexpr Encoding kOrthographic[] = {
    {MapFormat::kFloat32, Compare::kLess},       {MapFormat::kFloat32, Compare::kGreater},
    {MapFormat::kFixed8, Compare::kLess},        {MapFormat::kFixed8, Compare::kGreater},
    {MapFormat::kFrontBackHalf, Compare::kBoth}, {MapFormat::kFrontBackFixed, Compare::kBoth}};
[[nodiscard]] std::string nameOf(const Encoding& encoding);

/// A unit normal after rounding to this format.
[[nodiscard]] glm::dvec3 storedNormal(MapFormat format, const glm::dvec3& normal);

/// The largest error of a stored depth, in map units.
[[nodiscard]] double depthQuantum(MapFormat format, double depth);

/// Bound on the float rounding of a row of T·P, in map units: the row's entries, three products, three sums.
[[nodiscard]] double transformSlack(const glm::vec4& row, const glm::vec3& p);

/// Bound on the float rounding of a plane's distance, in object units: T·P and the products and sums after it.
[[nodiscard]] double roundingSlack(const DepthMap& map, const glm::vec3& p, double from_surface);

}  // namespace relief::test
