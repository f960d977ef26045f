// The truth that accuracy is measured against, against CGAL: side by exact predicates, distance by another
// tree. Breaks when rays lose or double a crossing, or when a search leaves out a triangle.
#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <cmath>
#include <map>
#include <random>
#include <tuple>

#include "bake/import/mesh_import.h"
#include "bake/mesh/mesh_query.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Tree =
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<SurfaceMesh>>>;

/// Equal positions become one vertex.
SurfaceMesh welded(const TriangleMesh& mesh) {
    SurfaceMesh out;
    std::map<std::tuple<float, float, float>, SurfaceMesh::Vertex_index> vertices;
    const auto vertex = [&](std::uint32_t i) {
        const glm::vec3& p = mesh.positions[i];
        const auto [found, is_new] = vertices.try_emplace({p.x, p.y, p.z});
        if (is_new) {
            found->second = out.add_vertex(Kernel::Point_3(p.x, p.y, p.z));
        }
        return found->second;
    };
    for (const glm::uvec3& t : mesh.triangles) {
        out.add_face(vertex(t.x), vertex(t.y), vertex(t.z));
    }
    return out;
}

/// Half of the points anywhere about the box, half within 1 % of its longest side of a vertex.
void expectSameAsCgal(const TriangleMesh& mesh, int count) {
    const SurfaceMesh surface = welded(mesh);
    ASSERT_EQ(surface.number_of_faces(), mesh.triangles.size());
    ASSERT_TRUE(CGAL::is_closed(surface));
    const Tree tree(surface.faces().begin(), surface.faces().end(), surface);
    const CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel> side(surface);
    const Result<MeshQuery> query = MeshQuery::build(mesh);
    ASSERT_TRUE(query) << query.error().message;
    EXPECT_TRUE(query->watertight());

    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
    const float longest = mesh.bounds.longestSide();
    int inside = 0;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 offset(unit(random), unit(random), unit(random));
        const glm::vec3 p = i % 2 == 0
                                ? mesh.bounds.center() + 0.55F * mesh.bounds.size() * offset
                                : mesh.positions[random() % mesh.positions.size()] + 0.01F * longest * offset;
        const Kernel::Point_3 point(p.x, p.y, p.z);
        const double distance = std::sqrt(CGAL::to_double(tree.squared_distance(point)));
        EXPECT_NEAR(query->closest(p).distance, distance, 1e-9 * static_cast<double>(longest));
        // Embree's coordinates are floats: within their grain of the surface either side is right.
        if (distance > 2e-7 * static_cast<double>(longest)) {
            EXPECT_EQ(query->inside(p), side(point) == CGAL::ON_BOUNDED_SIDE)
                << p.x << " " << p.y << " " << p.z << ", " << distance << " from the surface";
        }
        inside += query->inside(p) ? 1 : 0;
    }
    EXPECT_GT(inside, count / 20);
    EXPECT_LT(inside, count * 19 / 20);
}

TEST(TruthOracle, Icosphere) {
    expectSameAsCgal(makeIcosphere({0.3, -0.2, 0.1}, 1.5, 4), 4000);
}

TEST(TruthOracle, Torus) {
    expectSameAsCgal(makeTorusMesh(1.0, 0.3, 96, 48), 4000);
}

TEST(TruthOracle, BoxFarFromTheOrigin) {
    expectSameAsCgal(makeBoxMesh({1000.0, -2000.0, 500.0}, {1.0, 2.0, 0.5}, rotation({1, 2, 3}, 33.0)), 4000);
}

TEST(TruthOracle, MeshOfAFile) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.write("tetrahedron.off",
                                                    "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
                                                    "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
    const Result<TriangleMesh> mesh = importMesh(path);
    ASSERT_TRUE(mesh) << mesh.error().message;
    expectSameAsCgal(*mesh, 4000);
}

TEST(TruthOracle, Bunny) {
    const Result<TriangleMesh> mesh = importMesh("/usr/share/glmark2/models/bunny.obj");
    ASSERT_TRUE(mesh) << mesh.error().message << " (Debian package glmark2-data)";
    expectSameAsCgal(*mesh, 4000);
}

}  // namespace
}  // namespace relief::test
