// SPDX-License-Identifier: Apache-2.0
// The geometry of a map: its frame, its volume, and one ray per texel.
//
// The frame of an orthographic view along d is r (right), u (up), d with r = d × u. The image is thus not mirrored, and
// the camera (r, u, −d) is right-handed. u is +y projected perpendicular to d, or ±z for a view within 2.6° of ±y: a
// view along -y (from above) has +x to the right and −z up. `up` of a spec replaces +y.
//
// The volume of an orthographic map is the extent along r, u and d of the spec's `box`, or of the mesh plus a margin:
// 1e-4 of the mesh's longest side, or more if the volume would be thinner than 1 % of that side. The texels inside the
// border cover the volume exactly:
//
//     texels across      0 |  1 … width−2  | width−1           texel = extent / (width − 2)
//     map x              0  1/w         1−1/w  1
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

/// A surface on a ray: the one with the smallest depth or the one with the largest. A map keeps one or both of them.
enum class RayEnd : std::uint8_t { kNear = 0, kFar = 1 };
[[nodiscard]] constexpr RayEnd otherEnd(RayEnd end) {
    return end == RayEnd::kNear ? RayEnd::kFar : RayEnd::kNear;
}

/// An interval; initially empty.
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
    /// Object-space vectors from map coordinate 0 to 1 along each map axis. A cube's are parallel to the object axes.
    glm::dvec3 axis[3] = {glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0)};
    Affine object_to_map;
    glm::vec3 object_per_map{1.0F};
    bool encloses = true;  ///< every vertex is in the volume
    /// Indexed by RayEnd: the rays to that surface start in free space. Rays of kNear start at depth 0. Rays of kFar
    /// start at the far end of the volume and run backwards.
    bool starts_free[2] = {true, true};
    /// For a cube with kLess: the centre lies on the mesh's surface, so that rays may start on either side. Set by
    /// bake().
    bool centre_on_surface = false;

    [[nodiscard]] Projection projection() const {
        return format == MapFormat::kCube8 ? Projection::kCube : Projection::kOrthographic;
    }
    [[nodiscard]] std::uint32_t faceCount() const { return projection() == Projection::kCube ? 6 : 1; }
    [[nodiscard]] bool keeps(RayEnd end) const {
        return compare == Compare::kBoth || (compare == Compare::kLess) == (end == RayEnd::kNear);
    }
    [[nodiscard]] bool startsFree(RayEnd end) const { return starts_free[static_cast<std::size_t>(end)]; }
    /// Returns whether texels without a surface mean "outside": the rays to a stored surface start in free space, and
    /// cross the whole volume if they meet none.
    [[nodiscard]] bool emptyIsOutside() const;

    /// Orthographic: the offsets from `origin` at which the rays of a column, and of a row, start.
    [[nodiscard]] glm::dvec3 columnOffset(std::uint32_t x) const;
    [[nodiscard]] glm::dvec3 rowOffset(std::uint32_t y) const;
    /// The ray through the centre of a texel.
    [[nodiscard]] TexelRay ray(std::uint32_t face, std::uint32_t x, std::uint32_t y) const;
    /// The depth at which the ray of a texel leaves the volume.
    [[nodiscard]] double depthMax(const TexelRay& ray) const;

    /// The length of one unit of depth, object units; the mean of all axes for a cube.
    [[nodiscard]] double depthUnit() const {
        return projection() == Projection::kCube ? (length(axis[0]) + length(axis[1]) + length(axis[2])) / 3.0
                                                 : length(axis[2]);
    }
    /// The same view with `factor` times as many texels along each side.
    [[nodiscard]] View scaled(std::uint32_t factor) const {
        View view = *this;
        view.width *= factor;
        view.height *= factor;
        return view;
    }
    /// A map of this view with all texels zero.
    [[nodiscard]] DepthMap emptyMap() const;
};

/// The direction that points up in an orthographic view along a unit direction, if the spec has no `up`.
[[nodiscard]] glm::dvec3 defaultUp(const glm::dvec3& direction);

/// Fills in the settings that a spec leaves open: size, the centre of a cube, and compare.
/// Errors: kUsage, kLimit (as checkMapSize).
[[nodiscard]] Result<MapSpec> completeSpec(MapSpec spec, const PreparedMesh& mesh, std::uint32_t resolution);

/// Makes the view of a spec.
/// \param spec  from completeSpec().
/// Errors: kUsage (a volume too small or too large for floats; `up` parallel to the direction).
[[nodiscard]] Result<View> makeView(const MapSpec& spec, const TriangleMesh& mesh);

}  // namespace relief
