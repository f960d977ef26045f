// Nearly closed meshes are solids with holes: a scan without its bottom, a model whose exporter lost a
// triangle. Views look through such a hole at the inner side of the surface and would declare the inside
// free.
#pragma once

#include <cstddef>

#include "bake/mesh/mesh_query.h"
#include "bake/mesh/prepared_mesh.h"
#include "formats/base/result.h"

namespace relief {

/// Points of the surface that are asked by default.
inline constexpr std::size_t kEnclosureProbes = 512;

/// How well a mesh encloses its inside: by the parity of the crossings of rays from both sides of kEnclosureProbes points,
/// evenly spread over the surface. The rays go in opposite pairs.
struct Enclosure {
    /// Share of the points whose inside, by the majority of the rays, is on exactly one side; 0 to 1.
    double one_sided = 0.0;
    /// Mean share of the rays that agree with the majority; 0.5 for a sheet, 1 for a closed mesh, in between
    /// 1 less the share of the directions that lead out by a hole.
    double agreement = 0.0;
};

/// Least Enclosure of a nearly closed mesh. Half a sphere has an agreement of 0.8, a cube without lid 0.9, a
/// head cut off at its neck 0.88.
inline constexpr double kOneSided = 0.9;
inline constexpr double kAgreement = 0.85;

[[nodiscard]] Enclosure measureEnclosure(const MeshQuery& query);

/// \return the mesh with fans of triangles over its holes, wound as their neighbours, at the end of its triangles,
/// and counted in cap_triangles and closed_holes. MeshQuery::watertight is then true, unless a hole is too
/// small for a fan of floats. Name, hash and bounds stay. A hole is a loop of odd edges (mesh_edges.h) that
/// comes to no vertex twice.
///
/// The mesh comes back as it is if it is closed, if it is not nearly closed (terrains, sheets, bowls without
/// thickness up to half a sphere: about one ray in seven may lead out by a hole), or if the caps would turn
/// parts of the inside to the outside or back (patches whose seams do not meet).
/// Errors: those of MeshQuery::build.
/// \param probes  points of the surface, and as many of its box, that are asked: fewer will do for a small part of a mesh.
[[nodiscard]] Result<PreparedMesh> closeHoles(const PreparedMesh& mesh,
                                              std::size_t probes = kEnclosureProbes);

}  // namespace relief
