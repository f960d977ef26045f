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

/// Encodes rows of a map from the hits of both ends (empty for an end that the map does not keep), on the calling
/// thread.
///
/// Normals are those of the triangles, towards the free space in which the ray started. If a ray may start inside,
/// surfaces hit from their inner side are omitted. A cube whose centre lies on the surface stores the centre as the
/// surface for such a ray instead: everything behind the centre is inside.
/// \return the number of texels with a surface.
std::uint64_t encodeRows(const RayScene& scene, const NormalTable& normals, const View& view,
                         const RowRange& rows, std::span<const Hit> near_hits, std::span<const Hit> far_hits,
                         DepthMap& map);

}  // namespace relief
