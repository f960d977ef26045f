// SPDX-License-Identifier: Apache-2.0
// Counts of inspectMesh() on real meshes compared with CGAL's halfedges.
#include <CGAL/Polygon_mesh_processing/connected_components.h>

#include <cstdlib>

#include "bake/import/mesh_import.h"
#include "bake/repair/mesh_health.h"
#include "tests/bake/oracle/cgal_mesh.h"

namespace relief::test {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

TEST(MeshHealthOracle, CountsMatchCgal) {
    const TemporaryFolder folder;
    const std::string unpack =
        "tar -xzf /usr/share/doc/libcgal-dev/data.tar.gz -C '" + folder.path().string() + "' data/meshes";
    ASSERT_EQ(std::system(unpack.c_str()), 0) << "Debian package libcgal-demo";
    for (const char* name :
         {"man", "lion-head", "mech-holes-shark", "blobby_3cc", "knot2", "mushroom", "pig"}) {
        const TriangleMesh mesh =
            required(importMesh(folder.path() / "data/meshes" / (std::string(name) + ".off")));
        const MeshHealth health = inspectMesh(mesh);
        const SurfaceMesh surface = toCgal(mesh);
        std::uint64_t borders = 0;
        for (const SurfaceMesh::Halfedge_index h : surface.halfedges()) {
            borders += surface.is_border(h) ? 1U : 0U;
        }
        EXPECT_EQ(health.boundary_edges, borders) << name;
        EXPECT_EQ(health.closed, CGAL::is_closed(surface)) << name;
        EXPECT_EQ(health.inconsistent_edges + health.nonmanifold_edges, 0U) << name;
        std::vector<std::size_t> component(surface.number_of_faces());
        const auto map =
            boost::make_iterator_property_map(component.begin(), get(boost::face_index, surface));
        EXPECT_EQ(health.components, pmp::connected_components(surface, map)) << name;
    }
}

}  // namespace
}  // namespace relief::test
