// What inspectMesh counts on real meshes against CGAL's halfedges.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Surface_mesh.h>

#include <cstdlib>

#include "bake/import/mesh_import.h"
#include "bake/mesh/mesh_edges.h"
#include "bake/repair/mesh_health.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
namespace pmp = CGAL::Polygon_mesh_processing;

/// Vertices of equal positions once, as the inspection sees them. Every face must fit: the mesh is manifold.
SurfaceMesh toCgalWelded(const TriangleMesh& mesh) {
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

TEST(MeshHealthOracle, CountsAreCgals) {
    const TemporaryFolder folder;
    const std::string unpack =
        "tar -xzf /usr/share/doc/libcgal-dev/data.tar.gz -C '" + folder.path().string() + "' data/meshes";
    ASSERT_EQ(std::system(unpack.c_str()), 0) << "Debian package libcgal-demo";
    for (const char* name :
         {"man", "lion-head", "mech-holes-shark", "blobby_3cc", "knot2", "mushroom", "pig"}) {
        const Result<TriangleMesh> mesh =
            importMesh(folder.path() / "data/meshes" / (std::string(name) + ".off"));
        ASSERT_TRUE(mesh) << mesh.error().message;
        const MeshHealth health = inspectMesh(*mesh);
        const SurfaceMesh surface = toCgalWelded(*mesh);
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
