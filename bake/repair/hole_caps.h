// SPDX-License-Identifier: Apache-2.0
// Caps over the holes of nearly closed meshes: a scan without its bottom, a model whose exporter lost a triangle. Without
// them, views through a hole see the inner side of the surface and take the inside for free.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bake/mesh/mesh_edges.h"
#include "bake/mesh/mesh_query.h"
#include "bake/mesh/prepared_mesh.h"
#include "formats/base/result.h"

namespace relief {

/// Default number of probes on the surface.
inline constexpr std::size_t kEnclosureProbes = 512;

/// How well a mesh encloses its inside, by the crossing parity of opposite pairs of rays from both sides of probes evenly
/// spread over the surface.
struct Enclosure {
    double one_sided =
        0.0;  ///< share of the probes with the inside, by the majority of rays, on exactly one side
    /// Mean share of the rays that agree with the majority: 0.5 for a sheet, 1 for a closed mesh, in between 1 less the
    /// share of the directions that lead out by a hole.
    double agreement = 0.0;
};

/// Least Enclosure of a nearly closed mesh. Half a sphere has an agreement of 0.8, a cube without lid 0.9.
inline constexpr double kOneSided = 0.9;
inline constexpr double kAgreement = 0.85;

[[nodiscard]] Enclosure measureEnclosure(const MeshQuery& query);

/// One step along the border of a hole.
struct BorderStep {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    std::uint32_t edge = 0;
    bool against = false;  ///< the edge's triangle runs the same way, and a cap's triangle the other
};
using BorderLoop = std::vector<BorderStep>;

/// Partitions the odd edges of a mesh into loops that visit no vertex twice.
[[nodiscard]] std::vector<BorderLoop> borderLoops(const std::vector<OddEdge>& edges);

/// Closes holes by fans of triangles, wound like their neighbours, at the end of the mesh, and counts them in cap_triangles
/// and closed_holes. MeshQuery::watertight is then true, unless a hole is too small for a fan of floats. Name, hash and
/// bounds stay. A hole is a loop of odd edges (mesh_edges.h) that visits no vertex twice.
///
/// Returns the mesh unchanged if it is closed, if it is not nearly closed (terrains, sheets, bowls without thickness up to
/// half a sphere: about one ray in seven may lead out by a hole), or if the caps would turn parts of the inside to the
/// outside or back (patches whose seams do not meet).
/// \param probes  on the surface, and as many in the box: fewer suffice for a small part of a mesh.
/// Errors: those of MeshQuery::build.
[[nodiscard]] Result<PreparedMesh> closeHoles(const PreparedMesh& mesh,
                                              std::size_t probes = kEnclosureProbes);

}  // namespace relief
