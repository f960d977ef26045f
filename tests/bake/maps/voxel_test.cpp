// SPDX-License-Identifier: Apache-2.0
// Points deep in a solid are never outside. The solids are voxel grids, whose sides and distances are exact. Their
// vertices, edges and faces lie under texel centres and borders in every way. Some cube maps have their centre on the
// surface, so their rays can run through the solid.
//
// Bound: a map's rays sample the solid; only the space between them is unknown. A point is inside if its distance from
// the surface exceeds the texel's diagonal and all rays of the texel are in the solid. Texels of cubes are measured at
// the point's distance from the centre. A depth quantum and float errors are added.
//
// With Quality::kFast a texel has only its centre ray, and extends the plane that it hits. Consider a ball of radius ρ
// in the solid about a point at distance r from the ray. The ray's chord starts behind the plane: √(ρ² − r²) ≤ r tan θ,
// with θ between the ray and the plane's normal. So ρ ≤ r / cos θ, and r is at most half a diagonal.
#include <cmath>
#include <random>

#include "bake/mesh/mesh_query.h"
#include "bake/mesh/triangle_plane.h"
#include "tests/bake/meshes.h"
#include "tests/bake/voxels.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

constexpr int kPoints = 8000;

/// Cosine between the ray through p and the normal of the deciding surface; 1 for maps without planes.
double cosineAt(const DepthMap& map, const FieldSample& sample, const glm::vec3& p) {
    const Affine& rows = map.object_to_map;
    const glm::dvec3 q = rows.apply(p);
    const glm::dvec3 along = map.projection() == Projection::kOrthographic
                                 ? glm::dvec3(rows.row[2].x, rows.row[2].y, rows.row[2].z)
                                 : q * glm::dvec3(map.object_per_map);
    const double lengths = length(along) * length(glm::dvec3(sample.normal));
    const double cosine = std::abs(dot(along, glm::dvec3(sample.normal))) / lengths;
    return map.decode == Decode::kPlane ? cosine : 1.0;
}

/// \param cosine  cosineAt() with one ray per texel, else 1
double boundAt(const DepthMap& map, const glm::vec3& p, double cosine = 1.0) {
    const double beside = std::max(1.0, 0.5 / cosine);
    const glm::dvec3 scale = map.object_per_map;
    const double grain = 1e-6 * std::max({scale.x, scale.y, scale.z});
    const double quantum = map.format == MapFormat::kFrontBackHalf ? 1.0 / 2048.0 : 1.0 / 65534.0;
    if (map.projection() == Projection::kOrthographic) {
        return beside * std::hypot(scale.x / map.width, scale.y / map.height) + quantum * scale.z + grain;
    }
    const glm::dvec3 q = map.object_to_map.apply(p);
    const double radius = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
    return std::max({scale.x, scale.y, scale.z}) *
               (beside * 2.0 * std::sqrt(2.0) / map.width * radius + 2.0 * quantum) +
           grain;
}

Collider baked(const PreparedMesh& mesh, const std::vector<std::string>& specs, Quality quality,
               Prefer prefer = Prefer::kNeither) {
    BakeOptions options;
    options.quality = quality;
    options.prefer = prefer;
    for (const std::string& text : specs) {
        options.maps.push_back(required(parseMapSpec(text)));
    }
    Result<Baked> result = bake(mesh, options);
    return result ? std::move(result->collider) : Collider{};  // part of the volume may contain no surface
}

std::string text(const glm::vec3& p) {
    return std::to_string(p.x) + "/" + std::to_string(p.y) + "/" + std::to_string(p.z);
}

/// Random views of a voxel solid, drawn from the seed.
std::vector<std::vector<std::string>> viewsOf(const VoxelGrid& grid, const TriangleMesh& mesh,
                                              std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto below = [&](std::uint32_t n) { return static_cast<int>(random() % n); };
    const auto vertex = [&] { return mesh.positions[random() % mesh.positions.size()]; };
    const auto number = [](double v) { return std::to_string(v); };
    const std::string size = ",size=" + std::to_string(12 + below(90));
    const std::string cube_size = ",size=" + std::to_string(8 + below(40));
    const std::string round =
        "front-back:dir=" + std::to_string(below(7) - 3) + "/" + std::to_string(below(7) - 3) + "/1";
    const std::string steep = "front-back:dir=" + std::to_string(500 + below(500)) + "/" +
                              std::to_string(below(101) - 50) + "/" + std::to_string(below(201) - 100);
    // Texel centres or borders lie on integers.
    const int per_unit = 1 + below(6);
    const double shift = below(2) == 0 ? 0.0 : 0.5 / per_unit;
    const int side = std::max({grid.size().x, grid.size().y, grid.size().z}) + 2;
    const std::string low = number(shift - 1.0);
    const std::string high = number(shift - 1.0 + side);
    const std::string aligned = "front-back:dir=-z,size=" + std::to_string(side * per_unit + 2) +
                                ",box=" + low + "/" + low + "/-1/" + high + "/" + high + "/" +
                                std::to_string(side);
    const glm::vec3 corner(below(3), below(3), below(3));
    const std::string part =
        "front-back:dir=-z" + size + ",box=" + text(corner - 1.0F) + "/" + text(corner + 1.5F);
    const std::string at_vertex = "cube:center=" + text(vertex()) + cube_size;
    const glm::uvec3& t = mesh.triangles[random() % mesh.triangles.size()];
    const std::string on_edge =
        "cube:center=" + text(0.5F * (mesh.positions[t.x] + mesh.positions[t.y])) + cube_size;
    const glm::vec3 middle = (mesh.positions[t.x] + mesh.positions[t.y] + mesh.positions[t.z]) / 3.0F;
    const std::string on_face = "cube:center=" + text(middle) + cube_size + ",compare=less";
    const std::string in_cell =
        "cube:center=" + text(glm::vec3(below(3), below(3), below(3)) + 0.5F) + cube_size;
    std::vector<std::vector<std::string>> views = {
        {"front-back:dir=-x" + size, "front-back:dir=-y" + size, "front-back:dir=-z" + size}};
    for (const std::string& view :
         {"front-back:dir=-z" + size, "front-back:dir=1/1/1" + size, round + size, steep + size,
          "front-back:dir=+y,depth=half" + size, aligned, part, at_vertex, at_vertex + ",compare=less",
          at_vertex + ",decode=projected", on_edge, on_face, in_cell}) {
        views.push_back({view});
    }
    return views;
}

/// Samples points in the solid and checks the depth of those that the collider places outside.
void expectDeepPointsInside(const VoxelGrid& grid, const Collider& collider, std::uint32_t seed,
                            Quality quality = Quality::kNormal) {
    std::mt19937 random(seed);
    const auto share = [&] { return static_cast<float>(random() >> 8) * 0x1p-24F; };
    int deep = 0;
    for (int i = 0; i < kPoints && !collider.maps.empty(); ++i) {
        const float x = share();
        const float y = share();
        const glm::vec3 p = glm::vec3(grid.size()) * glm::vec3(x, y, share());
        const FieldSample sample = evaluate(collider, p);
        if (sample.map < 0 || sample.inside() || !grid.inside(p)) {
            continue;
        }
        const double depth = grid.distance(p, 2);
        const DepthMap& map = collider.maps[static_cast<std::size_t>(sample.map)];
        const double bound = boundAt(map, p, quality == Quality::kFast ? cosineAt(map, sample, p) : 1.0);
        if (depth > bound) {
            ADD_FAILURE() << "(" << text(p) << ") is " << depth << " deep, " << depth / bound
                          << " times the bound, but outside by map " << sample.map;
            if (++deep == 3) {
                return;
            }
        }
    }
}

void expectDeepPointsInsideForAllViews(std::uint32_t seed, std::initializer_list<Quality> qualities) {
    const VoxelGrid grid = VoxelGrid::random(seed);
    const PreparedMesh mesh(grid.mesh());
    for (const std::vector<std::string>& specs : viewsOf(grid, *mesh, seed)) {
        for (const Quality quality : qualities) {
            SCOPED_TRACE(std::to_string(seed) + " " + specs.front() + " " + std::string(wordOf(quality)));
            expectDeepPointsInside(grid, baked(mesh, specs, quality), seed, quality);
        }
    }
}

TEST(Voxels, DeepPointsAreInside) {
    for (std::uint32_t seed = seedFrom(1), end = seed + 5; seed < end; ++seed) {
        expectDeepPointsInsideForAllViews(seed, {Quality::kFast, Quality::kNormal});
    }
}

/// Seeds that failed before: rays that start in the solid and pass through an edge into the next cell, and an edge
/// between such rays that was treated as a silhouette.
TEST(Voxels, DeepPointsAreInsideInFormerFailures) {
    for (const std::uint32_t seed : {1'762'264'770U, 5'000'003U, 9'000'002U, 9'000'005U}) {
        expectDeepPointsInsideForAllViews(seed, {Quality::kFast});
    }
}

TEST(Voxels, DeepPointsAreInsideForEveryPreference) {
    for (std::uint32_t seed = seedFrom(101), end = seed + 6; seed < end; ++seed) {
        SCOPED_TRACE(seed);
        const VoxelGrid grid = VoxelGrid::random(seed);
        const PreparedMesh mesh(grid.mesh());
        for (const Prefer prefer : {Prefer::kInside, Prefer::kOutside}) {
            const std::vector<std::string> specs = {"front-back:dir=-x,size=80",
                                                    "front-back:dir=1/2/3,size=70", "cube:size=30"};
            expectDeepPointsInside(grid, baked(mesh, specs, Quality::kNormal, prefer), seed);
        }
    }
}

}  // namespace
}  // namespace relief::test
