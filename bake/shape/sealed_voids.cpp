// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/sealed_voids.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

#include "bake/mesh/mesh_query.h"
#include "bake/mesh/surface_parts.h"
#include "bake/mesh/surface_sampler.h"
#include "bake/mesh/triangle_plane.h"

namespace relief {
namespace {

/// The first grid finds candidates; the second covers only those.
constexpr int kFirstNodes = 64;
constexpr int kNodes = 192;
/// Smallest candidate, in nodes of the first grid: 1e-4 of the longest side cubed.
constexpr std::size_t kFirstVolume = 26;
/// Rays from a void, and the maximum fraction that may lead out.
constexpr std::size_t kRays = 2'000;
constexpr double kRaysOut = 0.01;
/// Test points of a triangle are its centre, its corners and the middles of its sides; all except the centre are moved
/// towards it by this factor.
constexpr double kInset = 0.95;

using Place = Voids::Place;

/// The nodes of a grid, and the surfaces between neighbours.
class Grid {
  public:
    Grid(const MeshQuery& query, const std::vector<Wall>& walls, const glm::dvec3& low,
         const glm::dvec3& high, double step)
        : query_(query), walls_(walls) {
        voids_.step = step;
        voids_.nodes = glm::ivec3(glm::ceil((high - low) / step)) + 2;
        // Offset from the planes of the model's own grid.
        voids_.origin = 0.5 * (low + high) - 0.5 * step * glm::dvec3(voids_.nodes) +
                        step * glm::dvec3(0.5013, 0.4987, 0.5007);
        stride_ = {1, static_cast<std::size_t>(voids_.nodes.x),
                   static_cast<std::size_t>(voids_.nodes.x) * static_cast<std::size_t>(voids_.nodes.y)};
        flags_.resize(stride_[2] * static_cast<std::size_t>(voids_.nodes.z));
        for (int axis = 0; axis < 3; ++axis) {
            scan(axis);
        }
    }

    /// Returns the voids for which is_void(nodes) is true.
    template <class IsVoid>
    Voids find(const IsVoid& is_void) {
        std::vector<std::uint8_t> by_solids(flags_.size(), 0);
        flood(boundary(), kSolidWall, by_solids);
        std::vector<std::uint8_t> seen(flags_.size(), 0);
        Voids voids = voids_;
        voids.places.assign(flags_.size(), Place::kSolid);
        for (const std::size_t node : flood(boundary(), kWall, seen)) {
            voids.places[node] = Place::kOutside;
        }
        for (std::size_t node = 0; node < flags_.size(); ++node) {
            if (seen[node] != 0 || (flags_[node] & kInside) != 0) {
                continue;
            }
            const std::vector<std::size_t> found = flood({node}, kWall, seen);
            const bool sealed_by_sheets = by_solids[node] != 0;
            const Place place = sealed_by_sheets && is_void(found) ? Place::kVoid : Place::kOutside;
            voids.count += place == Place::kVoid ? 1 : 0;
            for (const std::size_t i : found) {
                voids.places[i] = place;
            }
        }
        if (voids.count == 0) {
            voids.places.clear();
        }
        return voids;
    }

    [[nodiscard]] glm::ivec3 nodeAt(std::size_t i) const {
        return {static_cast<int>(i % stride_[1]), static_cast<int>(i % stride_[2] / stride_[1]),
                static_cast<int>(i / stride_[2])};
    }
    [[nodiscard]] glm::dvec3 position(std::size_t i) const { return voids_.position(nodeAt(i)); }

  private:
    // Bits of a node: a surface before the next node along each axis; the same for solids; the node itself is inside.
    static constexpr std::uint8_t kWall = 1;
    static constexpr std::uint8_t kSolidWall = 8;
    static constexpr std::uint8_t kInside = 64;

    void scan(int axis) {
        const int across = (axis + 1) % 3;
        const int along = (axis + 2) % 3;
        const auto count = static_cast<double>(voids_.nodes[axis]);
        // Rows run in parallel: lines of different rows share no byte of flags_.
        tbb::parallel_for(0, voids_.nodes[along], [&](int row) {
            std::vector<LineHit> hits;
            std::vector<LineSpan> spans;
            glm::dvec3 direction(0.0);
            direction[axis] = voids_.step;
            for (int column = 0; column < voids_.nodes[across]; ++column) {
                glm::ivec3 node(0);
                node[across] = column;
                node[along] = row;
                const glm::dvec3 start = voids_.position(node);
                const auto flag = [&](double at) -> std::uint8_t& {
                    node[axis] = static_cast<int>(at);
                    return flags_[voids_.at(node)];
                };
                query_.hitsAlong(start, direction, hits);
                for (const LineHit& hit : hits) {
                    const Wall wall = walls_[hit.triangle];
                    if (wall != Wall::kNothing && hit.at >= 0.0 && hit.at < count - 1.0) {
                        const unsigned bits = wall == Wall::kSolid ? kWall | kSolidWall : kWall;
                        flag(hit.at) |= static_cast<std::uint8_t>(bits << axis);
                    }
                }
                if (axis == 0 && !hits.empty() && query_.spansInside(start, direction, spans)) {
                    for (const LineSpan& span : spans) {
                        for (double x = std::max(0.0, std::ceil(span.begin)); x <= span.end && x < count;
                             x += 1.0) {
                            flag(x) |= kInside;
                        }
                    }
                }
            }
        });
    }

    /// Returns the nodes on the grid's sides that are in no body.
    [[nodiscard]] std::vector<std::size_t> boundary() const {
        std::vector<std::size_t> nodes;
        for (std::size_t i = 0; i < flags_.size(); ++i) {
            const glm::ivec3 node = nodeAt(i);
            const bool side = node.x == 0 || node.y == 0 || node.z == 0 || node.x == voids_.nodes.x - 1 ||
                              node.y == voids_.nodes.y - 1 || node.z == voids_.nodes.z - 1;
            if (side && (flags_[i] & kInside) == 0) {
                nodes.push_back(i);
            }
        }
        return nodes;
    }

    /// Returns the nodes reachable without crossing `wall`, and marks them as seen.
    std::vector<std::size_t> flood(std::vector<std::size_t> from, std::uint8_t wall,
                                   std::vector<std::uint8_t>& seen) const {
        for (const std::size_t node : from) {
            seen[node] = 1;
        }
        for (std::size_t k = 0; k < from.size(); ++k) {
            const std::size_t here = from[k];
            const glm::ivec3 node = nodeAt(here);
            const auto go = [&](std::size_t next) {
                if (seen[next] == 0) {
                    seen[next] = 1;
                    from.push_back(next);
                }
            };
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const auto i = static_cast<int>(axis);
                const auto bit = static_cast<std::uint8_t>(wall << axis);
                if (node[i] + 1 < voids_.nodes[i] && (flags_[here] & bit) == 0) {
                    go(here + stride_[axis]);
                }
                if (node[i] > 0 && (flags_[here - stride_[axis]] & bit) == 0) {
                    go(here - stride_[axis]);
                }
            }
        }
        return from;
    }

    const MeshQuery& query_;
    const std::vector<Wall>& walls_;
    Voids voids_;  // its places are empty
    std::array<std::size_t, 3> stride_{};
    std::vector<std::uint8_t> flags_;
};

std::array<glm::dvec3, 2> boxOf(const Voids& voids) {
    glm::ivec3 low = voids.nodes;
    glm::ivec3 high(0);
    voids.eachNode(glm::ivec3(0), voids.nodes - 1, [&](const glm::ivec3& node, Place place) {
        if (place == Place::kVoid) {
            low = glm::min(low, node);
            high = glm::max(high, node);
        }
    });
    return {voids.position(low), voids.position(high)};
}

/// Whether a triangle faces only voids and the inside of other bodies, and at least one void.
bool facesVoids(const MeshQuery& query, std::uint32_t triangle) {
    if (query.bodyOf(triangle) != 0) {
        return false;  // its body uses parity, so its normal may face inwards
    }
    const auto corners = cornersOf(query.mesh(), triangle);
    const glm::dvec3 a(corners[0]);
    const glm::dvec3 b(corners[1]);
    const glm::dvec3 c(corners[2]);
    const glm::dvec3 middle = (a + b + c) / 3.0;
    const glm::dvec3 normal = planeOf(query.mesh(), triangle).normal;
    const glm::dvec3 step =
        kSurfaceStep * double{query.mesh().bounds.longestSide()} / length(normal) * normal;
    bool any = false;
    for (const glm::dvec3& on : {middle, a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)}) {
        const glm::dvec3 p = middle + kInset * (on - middle) + step;
        if (!query.inside(p)) {
            return false;
        }
        any = any || !query.inBody(p);
    }
    return any;
}

}  // namespace

Voids sealedVoids(const MeshQuery& query, const std::vector<Wall>& walls) {
    const Bounds& bounds = query.mesh().bounds;
    const double longest{bounds.longestSide()};
    const double first = longest / kFirstNodes;
    const Voids coarse =
        Grid(query, walls, glm::dvec3(bounds.min), glm::dvec3(bounds.max), first).find([](const auto& nodes) {
            return nodes.size() >= kFirstVolume;
        });
    if (coarse.count == 0) {
        return {};
    }
    const auto [low, high] = boxOf(coarse);
    Grid fine(query, walls, low - 2.0 * first, high + 2.0 * first, longest / kNodes);
    return fine.find([&](const std::vector<std::size_t>& nodes) {
        MersenneRandom random(1);
        std::size_t out = 0;
        for (std::size_t i = 0; i < kRays; ++i) {
            const std::size_t node = nodes[random.below(nodes.size())];
            out += query.isRayFree(fine.position(node), random.direction()) ? 1 : 0;
        }
        return static_cast<double>(out) <= kRaysOut * kRays;
    });
}

Result<PreparedMesh> withVoids(const MeshQuery& query, Voids voids, std::vector<std::uint32_t>& part_of) {
    const TriangleMesh& mesh = query.mesh();
    const std::vector<std::uint32_t>& bodies = query.prepared().bodies();
    const MeshQuery filled =
        RELIEF_TRY(MeshQuery::build(PreparedMesh::unionOf(mesh, bodies).withVoids(voids)));
    std::vector<std::uint8_t> follows(mesh.triangles.size(), 0);
    tbb::parallel_for(std::size_t{0}, follows.size(), [&](std::size_t i) {
        const auto triangle = static_cast<std::uint32_t>(i);
        follows[i] = i >= mesh.surfaceTriangles() || facesVoids(filled, triangle) ? 1 : 0;
    });
    std::vector<std::uint32_t> order(follows.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto first =
        std::stable_partition(order.begin(), order.end(), [&](std::uint32_t i) { return follows[i] == 0; });
    const auto surface = static_cast<std::size_t>(first - order.begin());
    TriangleMesh sorted = mesh;
    std::vector<std::uint32_t> sorted_bodies(order.size());
    std::vector<std::uint32_t> sorted_parts(order.size(), kNoLabel);
    for (std::size_t i = 0; i < order.size(); ++i) {
        sorted.triangles[i] = mesh.triangles[order[i]];
        sorted_bodies[i] = bodies[order[i]];
        sorted_parts[i] = i < surface ? part_of[order[i]] : kNoLabel;
    }
    sorted.cap_triangles = order.size() - surface;
    part_of = std::move(sorted_parts);
    return PreparedMesh::unionOf(std::move(sorted), std::move(sorted_bodies)).withVoids(std::move(voids));
}

}  // namespace relief
