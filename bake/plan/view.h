// Where a map looks from: its frame, its volume, and one ray for every texel. Pure mathematics.
//
// An orthographic view looks along its direction d. Its frame is r (to the right), u (upwards), d, as a
// person who looks that way sees it: r = d × u, so the image is not mirrored, and the camera (r, u, −d) is
// right-handed. u is what is left of +y when seen along d, or of ∓z for a view within 2.6° of ±y, so that -y
// (from above) has +x to the right and −z upwards in the image. A spec's `up` takes the place of +y; its part
// along d does not count.
//
// The volume of an orthographic map is the box's extent along r, u and d. The texels inside the border cover
// it exactly; the border lies outside:
//
//     texels across      0 |  1 … width−2  | width−1           texel = extent / (width − 2)
//     map x              0  1/w         1−1/w  1
//
// Tight volumes leave a little free space round the mesh, 1e-4 of its longest side, and are at least 1 % of
// that side thick.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "bake/mesh/prepared_mesh.h"
#include "bake/mesh/vertex_blocks.h"
#include "bake/plan/map_spec.h"
#include "formats/base/result.h"
#include "formats/depth_map.h"
#include "formats/plane.h"

namespace relief {

/// The two surfaces that a map can keep of a ray: the one with the smallest and the one with the largest
/// depth.
enum class RayEnd : std::uint8_t { kNear = 0, kFar = 1 };

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
    /// By RayEnd: the rays that look for this surface start in free space. The one of kNear starts at depth
    /// 0; the one of kFar at the far end of the volume, and runs backwards.
    bool starts_free[2] = {true, true};
    /// Of a cube that keeps the nearest surface: its rays may start on either side of the surface. bake() sets it.
    bool centre_on_surface = false;

    [[nodiscard]] Projection projection() const {
        return format == MapFormat::kCube8 ? Projection::kCube : Projection::kOrthographic;
    }
    [[nodiscard]] std::uint32_t faceCount() const { return projection() == Projection::kCube ? 6 : 1; }
    [[nodiscard]] bool keeps(RayEnd end) const {
        return keepsTwo(compare) || (compare == Compare::kLess) == (end == RayEnd::kNear);
    }
    /// A texel without surface says "outside": one of the kept ends saw the whole ray from free space.
    [[nodiscard]] bool emptyIsOutside() const;

    /// Of an orthographic view: what its origin is moved by to where the rays of a column, and of a row, begin.
    [[nodiscard]] glm::dvec3 columnOffset(std::uint32_t x) const;
    [[nodiscard]] glm::dvec3 rowOffset(std::uint32_t y) const;
    /// The ray of a texel's centre.
    [[nodiscard]] TexelRay ray(std::uint32_t face, std::uint32_t x, std::uint32_t y) const;
    /// Depth at which the texel's ray leaves the volume.
    [[nodiscard]] double depthMax(const TexelRay& ray) const;

    /// A map of this view, all texels zero.
    [[nodiscard]] DepthMap emptyMap() const;
};

/// What an orthographic view along a unit direction has upwards if its spec names no `up`.
[[nodiscard]] glm::dvec3 defaultUp(const glm::dvec3& direction);

/// The settings of a spec that were left open, decided for this mesh: size, a cube's centre, and compare.
/// Errors: kUsage, kLimit (as checkMapSize).
[[nodiscard]] Result<MapSpec> completeSpec(MapSpec spec, const PreparedMesh& mesh, std::uint32_t resolution);

/// \param spec    complete.
/// \param blocks  of the mesh's positions, where many views are made; the view is the same without.
/// Errors: kUsage: a box that lies where floats cannot tell its texels apart; up along the direction.
[[nodiscard]] Result<View> makeView(const MapSpec& spec, const TriangleMesh& mesh,
                                    const VertexBlocks* blocks = nullptr);

}  // namespace relief
