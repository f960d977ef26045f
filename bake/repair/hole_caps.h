// SPDX-License-Identifier: Apache-2.0
// Closes the holes of nearly closed meshes: a scan without its bottom, a model whose exporter lost a triangle.
// Rays through an open hole would hit the back of the surface and classify the inside as free.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bake/mesh/mesh_edges.h"
#include "bake/mesh/mesh_query.h"
#include "bake/mesh/prepared_mesh.h"
#include "formats/base/result.h"

namespace relief {

inline constexpr std::size_t kEnclosureProbes = 512;

/// How well a mesh encloses its inside. Probes are points spread evenly over the surface. Pairs of opposite rays
/// classify both sides of each probe by crossing parity.
struct Enclosure {
    double one_sided =
        0.0;  ///< fraction of the probes with the inside on exactly one side, by majority of rays
    /// Mean fraction of rays that agree with the majority: 0.5 for a sheet, 1 for a closed mesh. In between, it is 1
    /// minus the fraction of directions that lead out through a hole.
    double agreement = 0.0;
};

/// Minimum Enclosure of a nearly closed mesh. Half a sphere has an agreement of 0.8, a cube without lid 0.9.
inline constexpr double kOneSided = 0.9;
inline constexpr double kAgreement = 0.85;

[[nodiscard]] Enclosure measureEnclosure(const MeshQuery& query);

struct BorderStep {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    std::uint32_t edge = 0;
    /// The edge's triangle runs in the direction of the step, so a cap's triangle runs against it.
    bool against = false;
};
using BorderLoop = std::vector<BorderStep>;

/// Partitions the odd edges of a mesh into loops that visit no vertex twice.
[[nodiscard]] std::vector<BorderLoop> borderLoops(const std::vector<OddEdge>& edges);

/// Closes holes with triangle fans, wound like their neighbours. Appends them to the mesh and counts them in
/// cap_triangles and closed_holes. MeshQuery::watertight is then true, unless a hole is too small for a fan in float
/// precision. Keeps name, hash and bounds. A hole is a loop of odd edges (mesh_edges.h) that visits no vertex twice.
///
/// Returns the mesh unchanged if it is closed or not nearly closed: a terrain, a sheet, or a bowl without thickness, up
/// to half a sphere. In a nearly closed mesh, at most about one ray in seven leads out through a hole. Also returns the
/// mesh unchanged if the caps would swap parts of inside and outside, as with panels whose seams do not meet.
/// \param probes  number of test points on the surface, and as many in the bounds; fewer suffice for a small part.
/// Errors: those of MeshQuery::build.
[[nodiscard]] Result<PreparedMesh> closeHoles(const PreparedMesh& mesh,
                                              std::size_t probes = kEnclosureProbes);

}  // namespace relief
