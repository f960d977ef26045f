// Samples become texels: depth and outward normal, quantised as the map's format has it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/mesh/mesh.h"
#include "bake/plan/view.h"
#include "bake/texels/ray_scene.h"
#include "bake/texels/scan_convert.h"
#include "formats/depth_map.h"

namespace relief {

/// The encoded outward normal of every triangle: encoding is dear, and texels mostly outnumber triangles.
class NormalTable {
  public:
    /// \param mesh  borrowed; must outlive the table.
    /// \param winding  orientation(mesh)
    /// \param texels  of all maps that will be encoded: with fewer than triangles, normals are encoded when
    ///                they are asked for.
    NormalTable(const TriangleMesh& mesh, double winding, std::uint64_t texels);

    /// \param from_behind  the normal of the side from which the corners run clockwise.
    [[nodiscard]] NormalIndex index(std::uint32_t triangle, bool from_behind) const;

  private:
    const TriangleMesh& mesh_;
    bool from_behind_;  // the side that the table holds
    std::vector<NormalIndex> table_;
};

/// Encodes rows of a map from the hits of both ends (empty for an end that the map does not keep).
///
/// Normals are the triangles' own and point out of the solid: towards the free space in which the ray
/// started. Where it may have started inside, a surface met from its inner side is left out; of a cube
/// whose centre lies on the surface the texel then holds the centre, behind which all is inside. Runs on the
/// calling thread. \return the number of texels with a surface.
std::uint64_t encodeRows(const RayScene& scene, const NormalTable& normals, const View& view,
                         const RowRange& rows, std::span<const Hit> near_hits, std::span<const Hit> far_hits,
                         DepthMap& map);

}  // namespace relief
