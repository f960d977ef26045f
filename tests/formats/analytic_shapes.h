// SPDX-License-Identifier: Apache-2.0
// Shapes whose rays have closed-form hits, and depth maps made of them in double precision: the truth that
// the code under test is held against. Nothing here calls vote(), cubeCoordinates() or cubeDirection().
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
    /// All hits, the nearest first.
    [[nodiscard]] virtual std::vector<Hit> hits(const glm::dvec3& origin,
                                                const glm::dvec3& direction) const = 0;
    [[nodiscard]] virtual bool inside(const glm::dvec3& p) const = 0;
};

[[nodiscard]] std::unique_ptr<Shape> makeSphere(const glm::dvec3& center, double radius);
[[nodiscard]] std::unique_ptr<Shape> makeBox(const glm::dvec3& center, const glm::dvec3& half);
/// Around the z axis of object space. Only for rays through its centre or parallel to its axis, whose hits
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

inline const glm::dmat3 kTurned = rotation({1.0, 2.0, -0.5}, 37.0);  ///< along no axis

/// The centred volume of the given sides.
[[nodiscard]] OrthographicFrame centeredFrame(const glm::dvec3& center, const glm::dmat3& axes,
                                              const glm::dvec3& sides);

/// A map without surfaces; the frame alone.
[[nodiscard]] DepthMap emptyMap(const OrthographicFrame& frame, MapFormat format, Compare compare,
                                std::uint32_t width, std::uint32_t height);
[[nodiscard]] DepthMap emptyMap(const CubeFrame& frame, Compare compare, std::uint32_t size);

/// Hits of the ray through a texel's centre that lie in the volume, the nearest first.
[[nodiscard]] std::vector<Hit> texelHits(const Shape& shape, const OrthographicFrame& frame,
                                         const DepthMap& map, std::uint32_t x, std::uint32_t y);

/// The direction in map space, not of unit length, through a texel's centre: OpenGL 3.3, table 3.21, solved
/// for the direction.
[[nodiscard]] glm::dvec3 cubeTexelDirection(std::uint32_t face, std::uint32_t x, std::uint32_t y,
                                            std::uint32_t size);

[[nodiscard]] DepthMap makeMap(const Shape& shape, const OrthographicFrame& frame, MapFormat format,
                               Compare compare, std::uint32_t width, std::uint32_t height);
[[nodiscard]] DepthMap makeMap(const Shape& shape, const CubeFrame& frame, Compare compare,
                               std::uint32_t size);

/// Front-back maps that look along the three axes in turn. Each leaves three texels around a box of this half side.
[[nodiscard]] Collider threeMaps(const Shape& shape, const glm::dvec3& center, const glm::dmat3& axes,
                                 double half, std::uint32_t size, MapFormat format,
                                 Decode decode = Decode::kProjected);

[[nodiscard]] double angleInDegrees(const glm::dvec3& a, const glm::dvec3& b);

/// What an orthographic map may be.
struct Encoding {
    MapFormat format;
    Compare compare;
};
inline constexpr Encoding kOrthographic[] = {
    {MapFormat::kFloat32, Compare::kLess},       {MapFormat::kFloat32, Compare::kGreater},
    {MapFormat::kFixed8, Compare::kLess},        {MapFormat::kFixed8, Compare::kGreater},
    {MapFormat::kFrontBackHalf, Compare::kBoth}, {MapFormat::kFrontBackFixed, Compare::kBoth}};
[[nodiscard]] std::string nameOf(const Encoding& encoding);

/// A unit normal as a texel of this format holds it.
[[nodiscard]] glm::dvec3 storedNormal(MapFormat format, const glm::dvec3& normal);

/// How far a stored depth may be from the given depth, in map units.
[[nodiscard]] double depthQuantum(MapFormat format, double depth);

/// Rounding of a row of T·P in float, in map units: the row's entries, three products, three sums.
[[nodiscard]] double transformSlack(const glm::vec4& row, const glm::vec3& p);

/// Rounding of the distance of a plane in float, in object units: of T·P and of the products and sums behind it.
[[nodiscard]] double roundingSlack(const DepthMap& map, const glm::vec3& p, double from_surface);

}  // namespace relief::test
