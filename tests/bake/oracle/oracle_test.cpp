// SPDX-License-Identifier: Apache-2.0
// Baked colliders compared with CGAL, which classifies points by exact predicates.
//
// Bound: an orthographic map votes that P is outside. Q is the point at P's depth on the centre ray of P's texel. The
// ray is free up to its hit, and the stored depth has an error of at most one quantum q. So a free point is within |PQ|
// + q of P, and |PQ| is at most half the texel's diagonal. For a cube map, Q has P's radius in the normalised volume.
// Directions in a texel differ by at most √2/N, radii are at most √3, and s_max converts to object units. So a point of
// the solid that is voted outside is at most this deep. For a convex solid every ray through P decides, so the bound
// also holds for outside points that are voted inside.
#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <cmath>
#include <cstdlib>
#include <random>

#include "bake/import/mesh_import.h"
#include "bake/mesh/mesh_query.h"
#include "bake/repair/mesh_health.h"
#include "tests/bake/oracle/cgal_mesh.h"

namespace relief::test {
namespace {

using Tree =
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<SurfaceMesh>>>;

double boundOf(const Collider& collider) {
    double bound = 0.0;
    for (const DepthMap& map : collider.maps) {
        const glm::dvec3 scale = map.object_per_map;
        double own = 0.0;
        if (map.projection() == Projection::kCube) {
            const double s_max = std::max({scale.x, scale.y, scale.z});
            own = s_max * (std::sqrt(6.0) / map.width + std::sqrt(3.0) / 65534.0);
        } else {
            const double quantum = map.format == MapFormat::kFrontBackHalf ? 1.0 / 4096.0 : 1.0 / 65534.0;
            own = 0.5 * std::hypot(scale.x / map.width, scale.y / map.height) + scale.z * quantum;
        }
        bound = std::max(bound, own);
    }
    return 1.001 * bound;  // plus float errors
}

struct Tally {
    int points = 0;
    int inside = 0;
    int inside_voted_outside = 0;
    int outside_voted_inside = 0;
    double deepest = 0.0;   // of inside points voted outside
    double farthest = 0.0;  // of outside points voted inside
};

Tally compare(const TriangleMesh& mesh, const Collider& collider, int count) {
    const SurfaceMesh surface = toCgal(mesh);
    EXPECT_TRUE(CGAL::is_closed(surface));
    EXPECT_TRUE(CGAL::Polygon_mesh_processing::is_outward_oriented(surface));
    Tree tree(faces(surface).begin(), faces(surface).end(), surface);
    tree.accelerate_distance_queries();
    const CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel> side(surface);
    std::mt19937 random(11);
    std::uniform_real_distribution<float> share(-0.1F, 1.1F);
    Tally tally;
    for (int i = 0; i < count; ++i) {
        glm::vec3 p;
        for (int k = 0; k < 3; ++k) {
            p[k] = mesh.bounds.min[k] + share(random) * mesh.bounds.size()[k];
        }
        const Kernel::Point_3 q(p.x, p.y, p.z);
        const bool truly_inside = side(q) == CGAL::ON_BOUNDED_SIDE;
        const FieldSample sample = evaluate(collider, p);
        EXPECT_GE(sample.map, 0);
        ++tally.points;
        tally.inside += truly_inside ? 1 : 0;
        if (truly_inside == sample.inside()) {
            continue;
        }
        const double depth = std::sqrt(CGAL::to_double(tree.squared_distance(q)));
        (truly_inside ? tally.inside_voted_outside : tally.outside_voted_inside) += 1;
        double& worst = truly_inside ? tally.deepest : tally.farthest;
        worst = std::max(worst, depth);
    }
    EXPECT_GT(tally.inside, count / 20);
    EXPECT_LT(tally.inside, count * 9 / 10);
    return tally;
}

const std::vector<std::vector<std::string>> kSets = {
    {"front-back:dir=-x", "front-back:dir=-y", "front-back:dir=-z", "cube"},
    {"front-back:dir=1/2/3"},
    {"fixed8:dir=-x", "fixed8:dir=-x,compare=greater", "fixed8:dir=2/-1/1",
     "fixed8:dir=2/-1/1,compare=greater"},
    {"float:dir=+z", "float:dir=+z,compare=greater"},
};

TEST(Oracle, ConvexSolidsAreWithinTheBound) {
    for (const TriangleMesh& mesh :
         {makeIcosphere({0.3, -0.2, 0.1}, 0.8, 4),
          makeBoxMesh({0.1, 0.2, 0.3}, {1, 0.6, 0.4}, rotation({1, 2, 3}, 40.0))}) {
        for (const std::vector<std::string>& specs : kSets) {
            SCOPED_TRACE(specs.front());
            const Collider collider = bakeSpecs(mesh, specs, 96);
            const double bound = boundOf(collider);
            const Tally tally = compare(mesh, collider, 10000);
            EXPECT_LE(tally.deepest, bound);
            // A ray can also miss a solid beside its texel centre, or hit a solid that does not reach the centre.
            EXPECT_LE(tally.farthest, bound);
            EXPECT_LT(tally.inside_voted_outside + tally.outside_voted_inside, tally.points / 20);
        }
    }
    // Only a cube map, with its centre inside.
    const TriangleMesh sphere = makeIcosphere({0.3, -0.2, 0.1}, 0.8, 4);
    const Collider cube = bakeSpecs(sphere, {"cube"}, 64);
    const Tally tally = compare(sphere, cube, 10000);
    EXPECT_LE(tally.deepest, boundOf(cube));
    EXPECT_LE(tally.farthest, boundOf(cube));
}

TEST(Oracle, TorusPenetrationIsWithinTheBound) {
    const TriangleMesh mesh = makeTorusMesh(1.0, 0.35, 90, 45);
    std::vector<std::vector<std::string>> sets = kSets;
    sets.push_back({"cube"});               // LESS, centre in the hole
    sets.push_back({"cube:center=1/0/0"});  // GREATER, centre in the tube
    sets.push_back({"cube:center=0/0/3,compare=less", "cube:compare=greater"});  // explicit settings
    for (const std::vector<std::string>& specs : sets) {
        SCOPED_TRACE(specs.front());
        const Collider collider = bakeSpecs(mesh, specs, 96);
        const Tally tally = compare(mesh, collider, 10000);
        EXPECT_LE(tally.deepest, boundOf(collider));
    }
}

TEST(Oracle, SubBoxesNeverLoseTheSolid) {
    // Volumes that cut the torus: rays can start inside it.
    const TriangleMesh mesh = makeTorusMesh(1.0, 0.35, 90, 45);
    const SurfaceMesh surface = toCgal(mesh);
    const CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel> side(surface);
    Tree tree(faces(surface).begin(), faces(surface).end(), surface);
    tree.accelerate_distance_queries();
    for (const std::string spec :
         {"float:dir=-x,box=-0.5/-1.5/-0.5/1.1/1.5/0.5", "fixed8:dir=-z,box=-2/-2/-1/2/2/0.1",
          "front-back:dir=-y,box=-2/-0.2/-1/2/0.9/1",
          "fixed8:dir=1/1/1,compare=greater,box=-0.4/-0.4/-0.4/0.9/0.9/0.4",
          "cube:box=0.5/-0.5/-0.5/1.5/0.5/0.5,compare=greater",
          "cube:box=-1.1/-1.1/-0.2/1.1/1.1/0.2,compare=less"}) {
        SCOPED_TRACE(spec);
        const Collider collider = bakeSpecs(mesh, {spec}, 96);
        const double bound = boundOf(collider);
        std::mt19937 random(5);
        std::uniform_real_distribution<float> xy(-1.5F, 1.5F);
        std::uniform_real_distribution<float> z(-0.5F, 0.5F);
        int votes = 0;
        for (int i = 0; i < 10000; ++i) {
            const glm::vec3 p(xy(random), xy(random), z(random));
            const FieldSample sample = evaluate(collider, p);
            votes += sample.map >= 0 ? 1 : 0;
            if (sample.map >= 0 && !sample.inside() && side({p.x, p.y, p.z}) == CGAL::ON_BOUNDED_SIDE) {
                EXPECT_LE(std::sqrt(CGAL::to_double(tree.squared_distance({p.x, p.y, p.z}))), bound);
            }
        }
        EXPECT_GT(votes, 100);
        EXPECT_LT(votes, 10000) << "must abstain outside the volume";
    }
}

// The truth for accuracy: side by exact predicates, distance by another tree. Half of the points are anywhere near the
// box, half within 1 % of its longest side of a vertex.
TEST(Oracle, TruthMatchesCgal) {
    const TriangleMesh bunny = required(importMesh("/usr/share/glmark2/models/bunny.obj"));
    for (const TriangleMesh& mesh :
         {bunny, makeBoxMesh({1000.0, -2000.0, 500.0}, {1.0, 2.0, 0.5}, rotation({1, 2, 3}, 33.0))}) {
        const SurfaceMesh surface = toCgal(mesh);
        ASSERT_TRUE(CGAL::is_closed(surface));
        const Tree tree(surface.faces().begin(), surface.faces().end(), surface);
        const CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel> side(surface);
        const MeshQuery query = queryOf(mesh);
        EXPECT_TRUE(query.watertight());
        std::mt19937 random(7);
        std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
        const float longest = mesh.bounds.longestSide();
        int inside = 0;
        for (int i = 0; i < 4000; ++i) {
            const glm::vec3 offset{unit(random), unit(random), unit(random)};
            const glm::vec3 p =
                i % 2 == 0 ? mesh.bounds.center() + 0.55F * mesh.bounds.size() * offset
                           : mesh.positions[random() % mesh.positions.size()] + 0.01F * longest * offset;
            const Kernel::Point_3 point(p.x, p.y, p.z);
            const double distance = std::sqrt(CGAL::to_double(tree.squared_distance(point)));
            EXPECT_NEAR(query.closest(p).distance, distance, 1e-9 * static_cast<double>(longest));
            // Embree uses floats: within their precision of the surface either side is correct.
            if (distance > 2e-7 * static_cast<double>(longest)) {
                EXPECT_EQ(query.inside(p), side(point) == CGAL::ON_BOUNDED_SIDE)
                    << p.x << " " << p.y << " " << p.z << ", " << distance << " from the surface";
            }
            inside += query.inside(p) ? 1 : 0;
        }
        EXPECT_GT(inside, 200);
        EXPECT_LT(inside, 3800);
    }
}

// Counts of inspectMesh() on real meshes compared with CGAL's halfedges.

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
