// SPDX-License-Identifier: Apache-2.0
#include "bake/repair/hole_caps.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "bake/mesh/mesh_edges.h"
#include "bake/mesh/mesh_query.h"
#include "bake/mesh/surface_sampler.h"
#include "bake/mesh/triangle_plane.h"

namespace relief {
namespace {

/// Maximum number of points whose side the caps change, relative to the points inside.
constexpr double kContradictedMax = 0.05;

/// A point, and the fraction of its rays that cross the surface an odd number of times.
struct Vote {
    glm::vec3 position{0.0F};
    double odd = 0.0;

    [[nodiscard]] bool inside() const { return odd > 0.5; }
    [[nodiscard]] bool clear() const { return std::abs(odd - 0.5) > 0.25; }
};

Vote voteAt(const MeshQuery& query, const glm::vec3& position) {
    unsigned odd = 0;
    // Opposite pairs give both half spaces the same weight; otherwise one side of a terrain would be inside.
    for (const glm::dvec3& direction : kParityDirections) {
        odd += query.crossings(position, direction) % 2;
        odd += query.crossings(position, -direction) % 2;
    }
    return {position, odd / (2.0 * static_cast<double>(kParityDirections.size()))};
}

/// Returns point i of Roberts's sequence in the unit cube (2018, "The unreasonable effectiveness of quasirandom
/// sequences").
glm::dvec3 spread(std::size_t i) {
    const glm::dvec3 steps(0.8191725133961645, 0.6710436067037893, 0.5497004779019703);
    return glm::fract(0.5 + steps * static_cast<double>(i));
}

std::vector<std::array<Vote, 2>> voteAtSurface(const MeshQuery& query, std::size_t probes) {
    const TriangleMesh& mesh = query.mesh();
    const AreaTable& areas = query.prepared().areas();
    std::vector<std::array<Vote, 2>> votes(probes);
    const double step = kSurfaceStep * static_cast<double>(mesh.bounds.longestSide());
    tbb::parallel_for(std::size_t{0}, probes, [&](std::size_t i) {
        const std::uint32_t triangle =
            areas.triangleAt((static_cast<double>(i) + 0.5) / static_cast<double>(probes));
        const glm::dvec3 weight = spread(i);
        const glm::dvec3 on = pointOn(mesh, triangle, weight.x, weight.y);
        glm::dvec3 normal = planeOf(mesh, triangle).normal;
        normal *= step / length(normal);
        votes[i] = {voteAt(query, on + normal), voteAt(query, on - normal)};
    });
    return votes;
}

std::vector<Vote> voteInBox(const MeshQuery& query, std::size_t probes) {
    const Bounds& bounds = query.mesh().bounds;
    std::vector<Vote> votes(probes);
    tbb::parallel_for(std::size_t{0}, probes, [&](std::size_t i) {
        votes[i] = voteAt(query, glm::dvec3(bounds.min) + spread(i) * glm::dvec3(bounds.size()));
    });
    return votes;
}

Enclosure enclosureOf(const std::vector<std::array<Vote, 2>>& votes) {
    std::size_t one_sided = 0;
    double agreement = 0.0;
    for (const auto& [front, back] : votes) {
        one_sided += front.inside() != back.inside() ? 1U : 0U;
        for (const Vote& vote : {front, back}) {
            agreement += std::max(vote.odd, 1.0 - vote.odd);
        }
    }
    const auto count = static_cast<double>(votes.size());
    return {static_cast<double>(one_sided) / count, agreement / (2.0 * count)};
}

class Capper {
  public:
    explicit Capper(TriangleMesh& mesh) : mesh_(mesh) {}

    /// Closes a hole. If no fan has only triangles with area, the hole stays open: triangles without area are not
    /// allowed, and omitting them would break the parity of edges.
    void close(const BorderLoop& loop) {
        const std::size_t before = mesh_.triangles.size();
        if (loop.size() == 3 && hasArea(planeOf(at(loop[0].from), at(loop[1].from), at(loop[2].from)))) {
            const auto against = std::ranges::count(loop, true, &BorderStep::against);
            const glm::uvec3 t(loop[0].from, loop[1].from, loop[2].from);
            mesh_.triangles.push_back(against > 1 ? glm::uvec3(t.x, t.z, t.y) : t);
        } else if (const std::optional<glm::vec3> apex = apexOf(loop)) {
            const auto index = static_cast<std::uint32_t>(mesh_.positions.size());
            mesh_.positions.push_back(*apex);
            for (const BorderStep& step : loop) {
                mesh_.triangles.push_back(step.against ? glm::uvec3(step.to, step.from, index)
                                                       : glm::uvec3(step.from, step.to, index));
            }
        }
        const std::size_t added = mesh_.triangles.size() - before;
        mesh_.cap_triangles += added;
        mesh_.closed_holes += added > 0 ? 1U : 0U;
    }

  private:
    [[nodiscard]] glm::dvec3 at(std::uint32_t vertex) const { return mesh_.positions[vertex]; }

    /// Returns the centroid of the loop. If it is collinear with an edge, tries points at increasing distances from it.
    [[nodiscard]] std::optional<glm::vec3> apexOf(const BorderLoop& loop) const {
        const glm::dvec3 origin = at(loop.front().from);
        glm::dvec3 moment(0.0);
        glm::dvec3 normal(0.0);  // Newell's normal: twice the area of the loop
        double around = 0.0;
        double extent = 0.0;
        for (const BorderStep& step : loop) {
            const glm::dvec3 a = at(step.from) - origin;
            const glm::dvec3 b = at(step.to) - origin;
            const double edge = length(b - a);
            moment += 0.5 * edge * (a + b);
            around += edge;
            normal += cross(a, b);
            extent = std::max(extent, length(a));
        }
        const glm::dvec3 centroid = origin + moment / around;
        if (const std::optional<glm::vec3> apex = usable(loop, centroid)) {
            return apex;
        }
        const double size = length(normal);
        const glm::dvec3 directions[] = {
            size > 0.0 ? normal / size : glm::dvec3(1, 1, 1), {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        // Starts at a few float steps, so that the bulge stays invisible.
        for (double step = 0x1p-21 * double{mesh_.bounds.farthest()}; step < extent; step *= 4.0) {
            for (const glm::dvec3& direction : directions) {
                for (const double sign : {1.0, -1.0}) {
                    if (const auto apex = usable(loop, centroid + sign * step * direction)) {
                        return apex;
                    }
                }
            }
        }
        return std::nullopt;
    }

    /// Returns the point in float precision if all triangles of its fan have an area.
    [[nodiscard]] std::optional<glm::vec3> usable(const BorderLoop& loop, const glm::dvec3& point) const {
        // Rounding may leave the box.
        const glm::vec3 apex = glm::clamp(glm::vec3(point), mesh_.bounds.min, mesh_.bounds.max);
        const bool good = std::ranges::all_of(
            loop, [&](const BorderStep& step) { return hasArea(planeOf(at(step.from), at(step.to), apex)); });
        return good ? std::optional(apex) : std::nullopt;
    }

    TriangleMesh& mesh_;
};

/// Returns the number of clear votes that the closed mesh contradicts, relative to the clear votes for inside.
double contradictedFraction(const std::vector<Vote>& votes, const MeshQuery& closed) {
    std::size_t inside = 0;
    std::size_t contradicted = 0;
    for (const Vote& vote : votes) {
        if (vote.clear()) {
            inside += vote.inside() ? 1U : 0U;
            contradicted += vote.inside() != closed.inside(vote.position) ? 1U : 0U;
        }
    }
    return static_cast<double>(contradicted) / static_cast<double>(std::max<std::size_t>(inside, 1));
}

/// Whether the caps swap inside and outside, on or off the surface: caps of panels whose seams do not meet would cross
/// the inside.
bool swapsSides(const std::vector<std::array<Vote, 2>>& votes, const MeshQuery& open,
                const MeshQuery& closed) {
    std::vector<Vote> sides;
    for (const auto& [front, back] : votes) {
        sides.insert(sides.end(), {front, back});
    }
    return contradictedFraction(sides, closed) > kContradictedMax ||
           contradictedFraction(voteInBox(open, votes.size()), closed) > kContradictedMax;
}

}  // namespace

// Every vertex has an even number of odd edges, so a walk over unused edges ends at its start. It is split wherever it
// meets itself. At a fork, it continues against the triangles' direction, to the lowest vertex.
std::vector<BorderLoop> borderLoops(const std::vector<OddEdge>& edges) {
    std::vector<BorderStep> steps;  // of all vertices, best first
    steps.reserve(2 * edges.size());
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
        steps.push_back({edges[i].to, edges[i].from, i, false});
        steps.push_back({edges[i].from, edges[i].to, i, true});
    }
    std::ranges::sort(steps, [](const BorderStep& a, const BorderStep& b) {
        return std::tuple(a.from, a.against, a.to) < std::tuple(b.from, b.against, b.to);
    });
    // Per vertex with odd edges, its first step that may be unused.
    std::vector<std::uint32_t> vertices;
    std::vector<std::size_t> next;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (i == 0 || steps[i].from != steps[i - 1].from) {
            vertices.push_back(steps[i].from);
            next.push_back(i);
        }
    }
    const std::vector<std::size_t> first = next;
    const auto rankOf = [&](std::uint32_t vertex) {
        return static_cast<std::size_t>(std::ranges::lower_bound(vertices, vertex) - vertices.begin());
    };
    std::vector<bool> taken(edges.size(), false);
    const auto take = [&](std::size_t rank) -> const BorderStep* {
        const std::size_t end = rank + 1 < first.size() ? first[rank + 1] : steps.size();
        while (next[rank] < end && taken[steps[next[rank]].edge]) {
            ++next[rank];
        }
        if (next[rank] == end) {
            return nullptr;
        }
        taken[steps[next[rank]].edge] = true;
        return &steps[next[rank]];
    };
    constexpr auto kNotOnPath = static_cast<std::size_t>(-1);
    std::vector<std::size_t> place(vertices.size(), kNotOnPath);  // index on the path
    std::vector<BorderLoop> loops;
    for (std::size_t start = 0; start < vertices.size(); ++start) {
        BorderLoop path;
        place[start] = 0;
        std::size_t at = start;
        while (const BorderStep* step = take(at)) {
            path.push_back(*step);
            at = rankOf(step->to);
            if (place[at] == kNotOnPath) {
                place[at] = path.size();
                continue;
            }
            const auto begin = path.begin() + static_cast<std::ptrdiff_t>(place[at]);
            loops.emplace_back(begin, path.end());
            for (auto inner = begin + 1; inner < path.end(); ++inner) {
                place[rankOf(inner->from)] = kNotOnPath;
            }
            path.erase(begin, path.end());
        }
        place[start] = kNotOnPath;
    }
    return loops;
}

Enclosure measureEnclosure(const MeshQuery& query) {
    return enclosureOf(voteAtSurface(query, kEnclosureProbes));
}

Result<PreparedMesh> closeHoles(const PreparedMesh& mesh, std::size_t probes) {
    if (mesh.closed()) {
        return mesh;
    }
    const MeshQuery query = RELIEF_TRY(MeshQuery::build(mesh));
    const auto votes = voteAtSurface(query, probes);
    const Enclosure enclosure = enclosureOf(votes);
    if (enclosure.one_sided < kOneSided || enclosure.agreement < kAgreement ||
        mesh->triangles.size() + mesh.oddEdges().size() > kTriangleMax) {
        return mesh;
    }
    TriangleMesh with_caps = *mesh;
    with_caps.marks.clear();  // caps have no names
    Capper capper(with_caps);
    for (const BorderLoop& loop : borderLoops(mesh.oddEdges())) {
        capper.close(loop);
    }
    if (!with_caps.labels.empty()) {
        with_caps.labels.resize(with_caps.triangles.size(), kNoLabel);
    }
    const PreparedMesh closed = mesh.capped(std::move(with_caps));
    const MeshQuery closed_query = RELIEF_TRY(MeshQuery::build(closed));
    return swapsSides(votes, query, closed_query) ? mesh : closed;
}

}  // namespace relief
