// SPDX-License-Identifier: Apache-2.0
// Encodes hits as texels: depth and outward normal, quantised to the format of the map.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/mesh/mesh.h"
#include "bake/named_maps/ray_scene.h"
#include "bake/views/view.h"
#include "formats/depth_map.h"

namespace relief {

/// The encoded outward normals of all triangles. Encoding is expensive, and texels usually outnumber triangles.
class NormalTable {
  public:
    /// \param mesh  borrowed.
    /// \param winding  PreparedMesh::orientation
    /// \param texels  total of all maps; if fewer than the triangles, normals are encoded on demand.
    NormalTable(const TriangleMesh& mesh, double winding, std::uint64_t texels);

    /// \param from_behind  returns the normal of the side on which the corners are clockwise.
    [[nodiscard]] NormalIndex index(std::uint32_t triangle, bool from_behind) const;

  private:
    const TriangleMesh& mesh_;
    bool from_behind_;  // the side stored in table_
    std::vector<NormalIndex> table_;
};

/// Encodes rows of a map on the calling thread. The hits of a RayEnd are empty if the map does not keep that end.
///
/// Normals are those of the triangles, towards the free space in which the ray started. If a ray may start inside,
/// surfaces hit from their inner side are omitted. If a cube's centre is on the surface, a ray that hits an inner side
/// stores the centre instead: everything behind it is inside.
/// \return the number of texels with a surface.
std::uint64_t encodeRows(const RayScene& scene, const NormalTable& normals, const View& view,
                         const RowRange& rows, std::span<const Hit> near_hits, std::span<const Hit> far_hits,
                         DepthMap& map);

}  // namespace relief
