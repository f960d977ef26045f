// SPDX-License-Identifier: Apache-2.0
// Encodes hits as texels: depth and outward normal, quantised by the map's format.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/mesh/mesh.h"
#include "bake/named_maps/ray_scene.h"
#include "bake/named_maps/scan_convert.h"
#include "bake/views/view.h"
#include "formats/depth_map.h"

namespace relief {

/// The encoded outward normals of all triangles: encoding is expensive, and texels mostly outnumber triangles.
class NormalTable {
  public:
    /// \param mesh  borrowed.
    /// \param winding  PreparedMesh::orientation
    /// \param texels  of all maps: with fewer than triangles, normals are encoded on demand.
    NormalTable(const TriangleMesh& mesh, double winding, std::uint64_t texels);

    /// \param from_behind  the normal of the side from which the corners run clockwise.
    [[nodiscard]] NormalIndex index(std::uint32_t triangle, bool from_behind) const;

  private:
    const TriangleMesh& mesh_;
    bool from_behind_;  // the side in the table
    std::vector<NormalIndex> table_;
};

/// Encodes rows of a map from the hits of both ends (empty for an end that the map does not keep), on the calling thread.
///
/// Normals are those of the triangles, towards the free space in which the ray started. Where a ray may start inside,
/// surfaces met from their inner side are left out; of a cube whose centre lies on the surface the texel then holds the
/// centre, behind which all is inside. \return the number of texels with a surface.
std::uint64_t encodeRows(const RayScene& scene, const NormalTable& normals, const View& view,
                         const RowRange& rows, std::span<const Hit> near_hits, std::span<const Hit> far_hits,
                         DepthMap& map);

}  // namespace relief
