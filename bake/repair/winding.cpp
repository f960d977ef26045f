#include "bake/repair/winding.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "bake/mesh/inside.h"
#include "bake/mesh/mesh_edges.h"
#include "bake/mesh/mesh_query.h"
#include "bake/mesh/surface_sampler.h"
#include "bake/mesh/triangle_plane.h"

namespace relief {
namespace {

constexpr std::uint32_t kNone = 0xffffffff;
/// Triangles of a patch that are asked, evenly spread over its list.
constexpr std::size_t kAskedMax = 63;
/// Least share of the asked that must agree, above those that disagree, to turn an open patch.
constexpr double kClearShare = 0.5;

struct Neighbour {
    std::uint32_t triangle = kNone;
    bool same_direction = false;  ///< wound against each other
};

/// Triangles that hang together by edges of two triangles.
struct Patch {
    std::vector<std::uint32_t> triangles;
    std::uint64_t turned = 0;  ///< of them, to agree with the first
    bool closed = true;
};

class Winder {
  public:
    explicit Winder(const PreparedMesh& mesh)
        : prepared_(mesh), mesh_(*mesh), turn_(mesh->triangles.size(), 0) {}

    /// For each triangle, whether it must be turned.
    Result<std::vector<bool>> run() {
        findNeighbours();
        prepared_.freeEdges();
        findPatches();
        const bool consistent = std::all_of(patches_.begin(), patches_.end(),
                                            [](const Patch& patch) { return patch.turned == 0; });
        if (consistent && patches_.size() == 1) {
            return std::vector<bool>(turn_.size(), false);
        }
        // Parity does not care about the winding: asked before anything is turned.
        const MeshQuery query = RELIEF_TRY(MeshQuery::build(prepared_));
        tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t i) {
            Patch& patch = patches_[i];
            // Breadth first is no order to spread samples over.
            std::sort(patch.triangles.begin(), patch.triangles.end());
            if (looksInwards(patch, query)) {
                for (const std::uint32_t triangle : patch.triangles) {
                    turn_[triangle] ^= 1U;
                }
            }
        });
        return std::vector<bool>(turn_.begin(), turn_.end());
    }

  private:
    void findNeighbours() {
        neighbours_.resize(3 * mesh_.triangles.size());
        const std::vector<EdgeUse>& uses = prepared_.edges().uses;
        forEachEdge(uses, [&](std::size_t begin, std::size_t end) {
            if (end - begin == 2) {
                const EdgeUse& a = uses[begin];
                const EdgeUse& b = uses[begin + 1];
                neighbours_[3 * std::size_t{a.triangle} + a.side] = {b.triangle, a.down == b.down};
                neighbours_[3 * std::size_t{b.triangle} + b.side] = {a.triangle, a.down == b.down};
            }
        });
    }

    void findPatches() {
        std::vector<bool> seen(mesh_.triangles.size(), false);
        for (std::uint32_t first = 0; first < mesh_.triangles.size(); ++first) {
            if (seen[first]) {
                continue;
            }
            Patch patch;
            patch.triangles.push_back(first);
            seen[first] = true;
            for (std::size_t i = 0; i < patch.triangles.size(); ++i) {
                const std::uint32_t here = patch.triangles[i];
                for (std::size_t side = 0; side < 3; ++side) {
                    const Neighbour& next = neighbours_[3 * std::size_t{here} + side];
                    if (next.triangle == kNone) {
                        patch.closed = false;
                    } else if (!seen[next.triangle]) {
                        seen[next.triangle] = true;
                        turn_[next.triangle] = turn_[here] ^ (next.same_direction ? 1U : 0U);
                        patch.turned += turn_[next.triangle];
                        patch.triangles.push_back(next.triangle);
                    } else if ((turn_[here] ^ turn_[next.triangle]) != (next.same_direction ? 1U : 0U)) {
                        patch.closed = false;  // one-sided
                    }
                }
            }
            // What most triangles say.
            if (2 * patch.turned > patch.triangles.size()) {
                for (const std::uint32_t triangle : patch.triangles) {
                    turn_[triangle] ^= 1U;
                }
                patch.turned = patch.triangles.size() - patch.turned;
            }
            patches_.push_back(std::move(patch));
        }
    }

    [[nodiscard]] glm::dvec3 normalOf(std::uint32_t triangle) const {
        const glm::dvec3 normal = planeOf(mesh_, triangle).normal;
        return turn_[triangle] != 0 ? -normal : normal;
    }

    /// Six times the volume that a patch encloses, as it is wound now.
    [[nodiscard]] double volumeOf(const Patch& patch) const {
        const glm::dvec3 center = mesh_.bounds.center();
        double volume = 0.0;
        for (const std::uint32_t triangle : patch.triangles) {
            volume += dot(planeOf(mesh_, triangle).point - center, normalOf(triangle));
        }
        return volume;
    }

    /// Whether the point a little in front of and the one a little behind a triangle are inside.
    [[nodiscard]] std::array<bool, 2> ask(std::uint32_t triangle, const MeshQuery& query) const {
        // Off the middle, which lies on lines of symmetry more often.
        const glm::dvec3 on = pointOn(mesh_, triangle, 0.37, 0.29);
        glm::dvec3 normal = normalOf(triangle);
        normal *=
            kSurfaceStep * static_cast<double>(mesh_.bounds.longestSide()) / std::sqrt(dot(normal, normal));
        return {isInside(on + normal, query), isInside(on - normal, query)};
    }

    /// By parity alone: the winding is what is looked for.
    [[nodiscard]] static bool isInside(const glm::vec3& p, const MeshQuery& query) {
        std::size_t odd = 0;
        for (const glm::dvec3& direction : kParityDirections) {
            odd += query.crossings(p, direction) % 2;
        }
        return odd > kParityDirections.size() / 2;
    }

    [[nodiscard]] bool looksInwards(const Patch& patch, const MeshQuery& query) const {
        const std::size_t asked = std::min(patch.triangles.size(), kAskedMax);
        const auto answer = [&](std::size_t i) {
            return ask(patch.triangles[i * patch.triangles.size() / asked], query);
        };
        if (patch.closed) {
            const bool inwards = volumeOf(patch) < 0.0;
            for (std::size_t i = 0; i < asked; ++i) {
                const std::array<bool, 2> inside = answer(i);
                if (!inside[inwards ? 1 : 0]) {
                    return inwards;
                }
            }
            return !inwards;  // a hollow in another patch
        }
        double sum = 0.0;
        for (std::size_t i = 0; i < asked; ++i) {
            const std::array<bool, 2> inside = answer(i);
            sum += static_cast<double>(inside[0]) - static_cast<double>(inside[1]);
        }
        return sum > kClearShare * static_cast<double>(asked);
    }

    const PreparedMesh& prepared_;
    const TriangleMesh& mesh_;
    std::vector<std::uint8_t> turn_;  // 1: against the order of the file
    std::vector<Neighbour> neighbours_;
    std::vector<Patch> patches_;
};

}  // namespace

Result<Winding> windOutwards(PreparedMesh mesh) {
    const std::vector<bool> turn = RELIEF_TRY(Winder(mesh).run());
    const auto turned = static_cast<std::uint64_t>(std::count(turn.begin(), turn.end(), true));
    return Winding{std::move(mesh).woundOutwards(turn), turned};
}

}  // namespace relief
