// SPDX-License-Identifier: Apache-2.0
// The geometry of a map: its frame, its volume, and one ray per texel.
//
// The frame of an orthographic view along d is r (right), u (up), d with r = d × u, so that the image is not mirrored and the
// camera (r, u, −d) is right-handed. u is +y projected along d, or ∓z for a view within 2.6° of ±y, so that -y (from above)
// has +x to the right and −z upwards in the image. A spec's `up` replaces +y.
//
// The volume of an orthographic map is the box's extent along r, u and d. The texels inside the border cover it exactly:
//
//     texels across      0 |  1 … width−2  | width−1           texel = extent / (width − 2)
//     map x              0  1/w         1−1/w  1
//
// Tight volumes leave free space round the mesh, 1e-4 of its longest side, and are at least 1 % of that side thick.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>

#include "bake/mesh/prepared_mesh.h"
#include "bake/views/map_spec.h"
#include "formats/base/result.h"
#include "formats/depth_map.h"
#include "formats/plane.h"

namespace relief {

/// The two surfaces of a ray that a map can keep: those of the smallest and of the largest depth.
enum class RayEnd : std::uint8_t { kNear = 0, kFar = 1 };
[[nodiscard]] constexpr RayEnd otherEnd(RayEnd end) {
    return end == RayEnd::kNear ? RayEnd::kFar : RayEnd::kNear;
}

/// An interval; empty at first.
struct Range {
    double min = std::numeric_limits<double>::max();
    double max = std::numeric_limits<double>::lowest();

    void add(double value) {
        min = std::min(min, value);
        max = std::max(max, value);
    }
    [[nodiscard]] double size() const { return max - min; }
    [[nodiscard]] Range padded(double by) const { return {min - by, max + by}; }
    [[nodiscard]] bool holds(const Range& other, double slack) const {
        return min - slack <= other.min && other.max <= max + slack;
    }
};

struct View {
    MapFormat format = MapFormat::kFixed8;
    Compare compare = Compare::kLess;
    std::uint32_t width = 0;  ///< texels
    std::uint32_t height = 0;
    /// Orthographic: the point of map coordinates (0, 0, 0). Cube: the centre. Object space.
    glm::dvec3 origin{0.0};
    /// Object vectors of one unit along each map axis. A cube's are along the axes of object space.
    glm::dvec3 axis[3] = {glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0)};
    Affine object_to_map;
    glm::vec3 object_per_map{1.0F};
    bool encloses = true;  ///< every vertex lies in the volume
    /// By RayEnd: the rays towards this surface start in free space. Those of kNear start at depth 0, those of kFar at the
    /// far end of the volume, backwards.
    bool starts_free[2] = {true, true};
    /// For a cube that keeps the nearest surface: rays may start on either side of the surface. Set by bake().
    bool centre_on_surface = false;

    [[nodiscard]] Projection projection() const {
        return format == MapFormat::kCube8 ? Projection::kCube : Projection::kOrthographic;
    }
    [[nodiscard]] std::uint32_t faceCount() const { return projection() == Projection::kCube ? 6 : 1; }
    [[nodiscard]] bool keeps(RayEnd end) const {
        return compare == Compare::kBoth || (compare == Compare::kLess) == (end == RayEnd::kNear);
    }
    [[nodiscard]] bool startsFree(RayEnd end) const { return starts_free[static_cast<std::size_t>(end)]; }
    /// Texels without a surface mean "outside": one of the kept ends saw the whole ray from free space.
    [[nodiscard]] bool emptyIsOutside() const;

    /// Orthographic: the offsets from `origin` at which the rays of a column, and of a row, start.
    [[nodiscard]] glm::dvec3 columnOffset(std::uint32_t x) const;
    [[nodiscard]] glm::dvec3 rowOffset(std::uint32_t y) const;
    /// The ray of a texel's centre.
    [[nodiscard]] TexelRay ray(std::uint32_t face, std::uint32_t x, std::uint32_t y) const;
    /// Depth at which the texel's ray leaves the volume.
    [[nodiscard]] double depthMax(const TexelRay& ray) const;

    /// One unit of depth in object units; of a cube on average.
    [[nodiscard]] double depthUnit() const {
        return projection() == Projection::kCube ? (length(axis[0]) + length(axis[1]) + length(axis[2])) / 3.0
                                                 : length(axis[2]);
    }
    /// The same view with `factor` times as many texels each way.
    [[nodiscard]] View scaled(std::uint32_t factor) const {
        View view = *this;
        view.width *= factor;
        view.height *= factor;
        return view;
    }
    /// A map of this view, all texels zero.
    [[nodiscard]] DepthMap emptyMap() const;
};

/// Upwards in an orthographic view along a unit direction whose spec has no `up`.
[[nodiscard]] glm::dvec3 defaultUp(const glm::dvec3& direction);

/// Sets what a spec leaves open for this mesh: size, a cube's centre, and compare.
/// Errors: kUsage, kLimit (as checkMapSize).
[[nodiscard]] Result<MapSpec> completeSpec(MapSpec spec, const PreparedMesh& mesh, std::uint32_t resolution);

/// \param spec  complete.
/// Errors: kUsage (a box where floats do not resolve its texels, up along the direction).
[[nodiscard]] Result<View> makeView(const MapSpec& spec, const TriangleMesh& mesh);

}  // namespace relief
