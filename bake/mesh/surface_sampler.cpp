#include "bake/mesh/surface_sampler.h"

#include <tbb/parallel_for.h>

#include "bake/mesh/inside.h"
#include "bake/mesh/ray_cost.h"
#include "bake/mesh/triangle_plane.h"

namespace relief {
namespace {

/// Points that are asked for by rays before a mesh's winding is trusted.
constexpr std::size_t kTrials = 512;
/// Crossings that may be counted for all points together: where leaves lie in dozens of layers, fewer points are drawn, but
/// not less than so many. A palm of 40,000 triangles is as wrong with a quarter of them.
constexpr double kCrossingsMax = 1e7;
constexpr double kPointsMin = 20'000.0;
/// Of the points, where rays cost more than those of ordinary meshes.
constexpr double kShareMin = 0.05;
/// Rays that inside() asks, about.
constexpr double kRaysAsked = 4.0;
/// Points per task.
constexpr std::size_t kBlock = 1024;

struct NearDraw {
    SurfaceDraw surface;
    double offset;  ///< along the normal
    [[nodiscard]] glm::dvec3 position() const { return surface.position + offset * surface.normal; }
};

}  // namespace

SurfaceDraw drawOnSurface(const TriangleMesh& mesh, const AreaTable& areas, double at,
                          MersenneRandom& random) {
    return drawOnTriangle(mesh, areas.triangleAt(at), random);
}

SurfaceDraw drawOnTriangle(const TriangleMesh& mesh, std::uint32_t triangle, MersenneRandom& random) {
    const double root = std::sqrt(random.uniform());
    const double along = random.uniform();
    const glm::uvec3& t = mesh.triangles[triangle];
    const glm::dvec3 normal = planeOf(mesh, triangle).normal;
    return {(1.0 - root) * glm::dvec3(mesh.positions[t.x]) +
                root * (1.0 - along) * glm::dvec3(mesh.positions[t.y]) +
                root * along * glm::dvec3(mesh.positions[t.z]),
            normal / std::sqrt(dot(normal, normal))};
}

std::vector<LabelledPoint> drawNearSurface(const MeshQuery& query, std::size_t count, double sigma,
                                           std::uint64_t seed) {
    const TriangleMesh& mesh = query.mesh();
    const AreaTable& areas = query.prepared().areas();
    const double winding = query.prepared().orientation();
    const double clear = 1e-5 * mesh.bounds.longestSide();  // of the surface itself, for rays
    // `triangle` is that of the point before, and becomes this one's.
    const auto draw = [&](std::size_t i, std::size_t of, MersenneRandom& random, std::uint32_t& triangle) {
        triangle =
            areas.triangleAt((static_cast<double>(i) + random.uniform()) / static_cast<double>(of), triangle);
        SurfaceDraw surface = drawOnTriangle(mesh, triangle, random);
        surface.normal *= winding;
        return NearDraw{surface, sigma * random.normal()};
    };
    // Beside a surface that no other cuts off, the side says it; elsewhere rays do.
    const auto isFree = [&](const NearDraw& near) {
        const double sign = near.offset < 0.0 ? -1.0 : 1.0;
        const glm::dvec3 start = near.surface.position + sign * clear * near.surface.normal;
        return std::abs(near.offset) <= clear || query.segmentIsFree(start, near.position());
    };
    const auto insideByWinding = [&](const NearDraw& near) {
        return isFree(near) ? near.offset < 0.0 : query.inside(glm::vec3(near.position()));
    };
    bool trusted = query.watertight();
    double crossings = 0.0;  // of a ray in the mean
    double asked = 0.0;      // share of the points that rays are asked about
    MersenneRandom trial(seed);
    std::uint32_t trial_triangle = 0;
    for (std::size_t i = 0; i < kTrials; ++i) {
        const NearDraw near = draw(i, kTrials, trial, trial_triangle);
        const glm::vec3 position(near.position());
        const bool free = isFree(near);
        asked += free ? 0.0 : 1.0 / static_cast<double>(kTrials);
        trusted = trusted &&
                  (std::abs(near.offset) <= clear || !free || (near.offset < 0.0) == query.inside(position));
        crossings += query.crossings(position, kParityDirections[i % kParityDirections.size()]) /
                     static_cast<double>(kTrials);
    }
    if (!trusted) {
        count /= 4;
        asked = 1.0;
    }
    const double share = std::max(affordableRays(mesh), kShareMin);
    count = static_cast<std::size_t>(share * static_cast<double>(count));
    const double affordable = kCrossingsMax / (kRaysAsked * std::max(crossings * asked, 1.0));
    // Halved until they can be afforded: how often a ray through an edge meets the surface may differ among processors,
    // and moves no point then.
    while (static_cast<double>(count) > std::max(2.0 * share * kPointsMin, affordable)) {
        count /= 2;
    }
    std::vector<LabelledPoint> points(count);
    tbb::parallel_for(std::size_t{0}, (count + kBlock - 1) / kBlock, [&](std::size_t block) {
        MersenneRandom random(seed * 0x9e3779b97f4a7c15ULL + block);
        std::uint32_t triangle = 0;
        for (std::size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i) {
            const NearDraw near = draw(i, count, random, triangle);
            const glm::vec3 position(near.position());
            const bool inside = trusted ? insideByWinding(near) : query.inside(position);
            // Without trust in the winding the normal points to the free side of its own surface.
            const bool turned = !trusted && inside != (near.offset < 0.0);
            points[i] = {position, glm::vec3(turned ? -near.surface.normal : near.surface.normal), inside};
        }
    });
    return points;
}

}  // namespace relief
