// SPDX-License-Identifier: Apache-2.0
#include "bake/mesh/surface_sampler.h"

#include <tbb/parallel_for.h>

#include "bake/mesh/inside.h"
#include "bake/mesh/ray_cost.h"

namespace relief {
namespace {

/// Points classified by rays before a mesh's winding is trusted.
constexpr std::size_t kTrials = 512;
/// Crossings for all points together: where leaves lie in dozens of layers, fewer points are drawn, down to kPointsMin.
constexpr double kCrossingsMax = 1e7;
constexpr double kPointsMin = 20'000.0;
/// The least share of the points where rays are expensive.
constexpr double kShareMin = 0.05;
/// Rays per inside(), about.
constexpr double kRaysPerQuery = 4.0;
constexpr std::size_t kBlock = 1024;  // points per task

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
    const auto corners = cornersOf(mesh, triangle);
    return {(1.0 - root) * glm::dvec3(corners[0]) + root * (1.0 - along) * glm::dvec3(corners[1]) +
                root * along * glm::dvec3(corners[2]),
            unitNormal(mesh, triangle)};
}

std::vector<LabelledPoint> drawNearSurface(const MeshQuery& query, std::size_t count, double sigma,
                                           std::uint64_t seed) {
    const TriangleMesh& mesh = query.mesh();
    const AreaTable& areas = query.prepared().areas();
    const double winding = query.prepared().orientation();
    const double clear = 1e-5 * mesh.bounds.longestSide();  // from the surface, for rays
    // `triangle`: in, that of the previous point; out, that of this one.
    const auto draw = [&](std::size_t i, std::size_t of, MersenneRandom& random, std::uint32_t& triangle) {
        triangle =
            areas.triangleAt((static_cast<double>(i) + random.uniform()) / static_cast<double>(of), triangle);
        SurfaceDraw surface = drawOnTriangle(mesh, triangle, random);
        surface.normal *= winding;
        return NearDraw{surface, sigma * random.normal()};
    };
    // No other surface between the point and its own: the side of that one decides. Elsewhere rays do.
    const auto isFree = [&](const NearDraw& near) {
        const double sign = near.offset < 0.0 ? -1.0 : 1.0;
        const glm::dvec3 start = near.surface.position + sign * clear * near.surface.normal;
        return std::abs(near.offset) <= clear || query.segmentIsFree(start, near.position());
    };
    const auto insideByWinding = [&](const NearDraw& near) {
        return near.offset < 0.0 || query.inVoid(near.position());
    };
    bool trusted = query.watertight();
    double crossings = 0.0;  // per ray
    double asked = 0.0;      // share of the points that need rays
    MersenneRandom trial(seed);
    std::uint32_t trial_triangle = 0;
    for (std::size_t i = 0; i < kTrials; ++i) {
        const NearDraw near = draw(i, kTrials, trial, trial_triangle);
        const glm::vec3 position(near.position());
        const bool free = isFree(near);
        asked += free ? 0.0 : 1.0 / static_cast<double>(kTrials);
        trusted = trusted && (std::abs(near.offset) <= clear || !free ||
                              insideByWinding(near) == query.inside(position));
        crossings += query.crossings(position, kParityDirections[i % kParityDirections.size()]) /
                     static_cast<double>(kTrials);
    }
    if (!trusted) {
        count /= 4;
        asked = 1.0;
    }
    const double share = std::max(affordableRays(mesh), kShareMin);
    count = static_cast<std::size_t>(share * static_cast<double>(count));
    const double affordable = kCrossingsMax / (kRaysPerQuery * std::max(crossings * asked, 1.0));
    // Halved, not scaled: the crossings of a ray through an edge may differ among processors, and must not move points.
    while (static_cast<double>(count) > std::max(2.0 * share * kPointsMin, affordable)) {
        count /= 2;
    }
    std::vector<LabelledPoint> points(count);
    tbb::parallel_for(std::size_t{0}, (count + kBlock - 1) / kBlock, [&](std::size_t block) {
        MersenneRandom random(seed, block);
        std::uint32_t triangle = 0;
        for (std::size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i) {
            const NearDraw near = draw(i, count, random, triangle);
            const glm::vec3 position(near.position());
            const bool inside = trusted && isFree(near) ? insideByWinding(near) : query.inside(position);
            // Without a trusted winding the normal points to the free side of its surface.
            const bool turned = !trusted && inside != (near.offset < 0.0);
            points[i] = {position, glm::vec3(turned ? -near.surface.normal : near.surface.normal), inside};
        }
    });
    return points;
}

}  // namespace relief
