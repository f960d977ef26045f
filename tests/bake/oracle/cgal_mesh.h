// SPDX-License-Identifier: Apache-2.0
// Conversion of meshes to CGAL.
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <vector>

#include "bake/mesh/mesh_edges.h"
#include "tests/bake/meshes.h"

namespace relief::test {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;

/// Merges vertices with equal positions. Fails the test if the mesh is not manifold.
[[nodiscard]] inline SurfaceMesh toCgal(const TriangleMesh& mesh) {
    SurfaceMesh out;
    const std::vector<std::uint32_t> welded = weldedVertices(mesh);
    std::vector<SurfaceMesh::Vertex_index> vertices(welded.size());
    for (std::size_t i = 0; i < welded.size(); ++i) {
        const glm::vec3& p = mesh.positions[i];
        vertices[i] = welded[i] == i ? out.add_vertex(Kernel::Point_3(p.x, p.y, p.z)) : vertices[welded[i]];
    }
    for (const glm::uvec3& t : mesh.triangles) {
        EXPECT_NE(out.add_face(vertices[t.x], vertices[t.y], vertices[t.z]), SurfaceMesh::null_face());
    }
    return out;
}

}  // namespace relief::test
