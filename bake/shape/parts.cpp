// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "bake/mesh/triangle_plane.h"
#include "bake/shape/shape_options.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// Minimum volume of a solid, in units of area^(3/2); a sphere has 0.094.
constexpr double kVolumeMin = 1e-5;

/// Calls visit(uses) for each edge, separately for each kind of triangle.
template <class Visit>
void forEachEdgeOfAKind(const MeshEdges& edges, std::span<const ShapeAs> kinds, const Visit& visit) {
    std::vector<EdgeUse> of_kind;
    forEachEdge(edges.uses, [&](std::size_t begin, std::size_t end) {
        const std::span uses = std::span(edges.uses).subspan(begin, end - begin);
        if (kinds.empty()) {
            visit(uses);
            return;
        }
        for (std::size_t kind = 0; kind < kWordsOf<ShapeAs>.size(); ++kind) {
            of_kind.clear();
            std::copy_if(uses.begin(), uses.end(), std::back_inserter(of_kind), [&](const EdgeUse& use) {
                return kinds[use.triangle] == static_cast<ShapeAs>(kind);
            });
            if (!of_kind.empty()) {
                visit(std::span<const EdgeUse>(of_kind));
            }
        }
    });
}

struct Solid {
    const Part* part = nullptr;
    Bounds bounds;
    double volume = 0.0;
};

Solid measured(const TriangleMesh& mesh, const Part& part) {
    Solid solid;
    solid.part = &part;
    for (const std::uint32_t i : part.triangles) {
        addTriangle(solid.bounds, mesh, i);
        const TrianglePlane plane = planeOf(mesh, i);
        solid.volume += dot(plane.point - glm::dvec3(mesh.bounds.center()), plane.normal);
    }
    solid.volume = std::abs(solid.volume);
    return solid;
}

/// A grid of a part's corners that finds the nearest corner within a reach.
class Corners {
  public:
    Corners(const TriangleMesh& mesh, const Solid& solid, double reach)
        : mesh_(mesh), low_(solid.bounds.min), reach_(reach) {
        for (const std::uint32_t i : solid.part->triangles) {
            const glm::uvec3& t = mesh.triangles[i];
            for (const std::uint32_t corner : {t.x, t.y, t.z}) {
                places_.emplace_back(key(cellOf(mesh.positions[corner])), corner);
            }
        }
        std::ranges::sort(places_);
        places_.erase(std::unique(places_.begin(), places_.end()), places_.end());
    }

    /// Returns the largest distance from a corner of `other` to its nearest corner here; nullopt if it exceeds the
    /// reach.
    [[nodiscard]] std::optional<double> farthestOf(const Corners& other) const {
        double farthest = 0.0;
        for (const auto& [cell, corner] : other.places_) {
            const std::optional<double> nearest = nearestTo(mesh_.positions[corner]);
            if (!nearest) {
                return std::nullopt;
            }
            farthest = std::max(farthest, *nearest);
        }
        return farthest;
    }

  private:
    using Cell = glm::vec<3, std::int64_t>;

    /// Offset so that the lowest neighbour of a cell with corners is 0.
    [[nodiscard]] Cell cellOf(const glm::dvec3& p) const {
        return Cell(glm::floor((p - low_) / reach_) + 2.0);
    }
    [[nodiscard]] static std::uint64_t key(const Cell& cell) {
        constexpr unsigned kBits = 21;  // 1 / kCopyReach is far below 2²¹
        return static_cast<std::uint64_t>(cell.x) << (2 * kBits) |
               static_cast<std::uint64_t>(cell.y) << kBits | static_cast<std::uint64_t>(cell.z);
    }

    [[nodiscard]] std::optional<double> nearestTo(const glm::dvec3& p) const {
        double nearest = std::numeric_limits<double>::infinity();
        const Cell cell = cellOf(p);
        for (int i = 0; i < 27; ++i) {
            const std::uint64_t wanted = key(cell + Cell(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
            auto at = std::lower_bound(places_.begin(), places_.end(), std::pair(wanted, std::uint32_t{0}));
            for (; at != places_.end() && at->first == wanted; ++at) {
                nearest = std::min(nearest, glm::distance(p, glm::dvec3(mesh_.positions[at->second])));
            }
        }
        return nearest <= reach_ ? std::optional(nearest) : std::nullopt;
    }

    const TriangleMesh& mesh_;
    glm::dvec3 low_;
    double reach_;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> places_;  // cell, corner
};

/// Returns the distance between two parts; nullopt if they are not near copies.
std::optional<double> distanceBetween(const TriangleMesh& mesh, const Solid& a, const Solid& b) {
    const double reach = kCopyReach * double{std::max(a.bounds.longestSide(), b.bounds.longestSide())};
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(double{a.bounds.min[axis]} - double{b.bounds.min[axis]}) > reach ||
            std::abs(double{a.bounds.max[axis]} - double{b.bounds.max[axis]}) > reach) {
            return std::nullopt;
        }
    }
    // All of b is now within reach of a's bounds, so no cell index is negative.
    const Corners of_a(mesh, a, reach);
    const Corners of_b(mesh, b, reach);
    const std::optional<double> one = of_a.farthestOf(of_b);
    const std::optional<double> other = one ? of_b.farthestOf(of_a) : std::nullopt;
    return other ? std::optional(std::max(*one, *other)) : std::nullopt;
}

/// Parts by size and by the cell of their lower corner. Parts with nearly equal bounds are in neighbouring cells.
class Places {
  public:
    /// Calls visit(solid) until it returns true.
    template <class Visit>
    [[nodiscard]] bool anyNear(const Solid& solid, const Visit& visit) const {
        int size = 0;
        static_cast<void>(std::frexp(solid.bounds.longestSide(), &size));
        for (int s = size - 1; s <= size + 1; ++s) {
            const glm::dvec3 cell = cellOf(solid, s);
            for (int i = 0; i < 27; ++i) {
                const auto found =
                    solids_.find({s, cell.x + i % 3 - 1, cell.y + i / 3 % 3 - 1, cell.z + i / 9 - 1});
                if (found != solids_.end() && std::ranges::any_of(found->second, visit)) {
                    return true;
                }
            }
        }
        return false;
    }

    void add(const Solid& solid) {
        int size = 0;
        static_cast<void>(std::frexp(solid.bounds.longestSide(), &size));
        const glm::dvec3 cell = cellOf(solid, size);
        solids_[{size, cell.x, cell.y, cell.z}].push_back(&solid);
    }

  private:
    /// The cell size is slightly above the reach of parts of twice the size, so that most parts in a cell are copies.
    static glm::dvec3 cellOf(const Solid& solid, int size) {
        return glm::floor(glm::dvec3(solid.bounds.min) / (4.0 * kCopyReach * std::ldexp(1.0, size)));
    }

    std::map<std::tuple<int, double, double, double>, std::vector<const Solid*>> solids_;
};

}  // namespace

std::vector<Part> partsOf(const TriangleMesh& mesh, const MeshEdges& edges, std::span<const ShapeAs> kinds) {
    DisjointSets sets(mesh.triangles.size());
    forEachEdgeOfAKind(edges, kinds, [&](std::span<const EdgeUse> uses) {
        for (const EdgeUse& use : uses.subspan(1)) {
            sets.join(uses.front().triangle, use.triangle);
        }
    });
    std::vector<std::uint32_t> part_of(mesh.triangles.size());
    std::vector<Part> parts;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t root = sets.find(i);
        if (root == i) {
            part_of[i] = static_cast<std::uint32_t>(parts.size());
            parts.emplace_back();
        }
        part_of[i] = part_of[root];
        parts[part_of[i]].triangles.push_back(i);
    }
    forEachEdgeOfAKind(edges, kinds, [&](std::span<const EdgeUse> uses) {
        Part& part = parts[part_of[uses.front().triangle]];
        const auto down = static_cast<std::size_t>(std::ranges::count(uses, true, &EdgeUse::down));
        part.closed = part.closed && uses.size() % 2 == 0;
        part.manifold = part.manifold && uses.size() == 2;
        part.balanced = part.balanced && 2 * down == uses.size();
    });
    return parts;
}

std::vector<std::uint32_t> copiesInSolids(const TriangleMesh& mesh, std::span<const std::uint32_t> welded,
                                          std::span<const Part> parts) {
    std::vector<std::uint32_t> copies;
    for (const Part& part : parts) {
        if (part.manifold) {
            continue;  // edges of copies have at least four triangles
        }
        const std::vector<SortedTriangle> sorted = sortedTriangles(mesh, welded, part.triangles);
        std::vector<std::uint32_t> again;
        std::vector<std::array<std::uint32_t, 2>> edges;  // without copies
        for (std::size_t k = 0; k < sorted.size(); ++k) {
            const auto& [corners, triangle] = sorted[k];
            if (k > 0 && sorted[k - 1].corners == corners) {
                again.push_back(triangle);
            } else {
                edges.insert(edges.end(),
                             {{corners[0], corners[1]}, {corners[1], corners[2]}, {corners[0], corners[2]}});
            }
        }
        std::ranges::sort(edges);
        bool closed = true;
        for (std::size_t begin = 0, end = 0; closed && begin < edges.size(); begin = end) {
            while (end < edges.size() && edges[end] == edges[begin]) {
                ++end;
            }
            closed = (end - begin) % 2 == 0;
        }
        if (closed) {
            copies.insert(copies.end(), again.begin(), again.end());
        }
    }
    std::ranges::sort(copies);
    return copies;
}

std::optional<double> enclosedVolume(const std::vector<glm::vec3>& positions,
                                     const std::vector<glm::uvec3>& triangles, const glm::dvec3& center) {
    double area = 0.0;
    double volume = 0.0;
    for (const glm::uvec3& t : triangles) {
        const TrianglePlane plane = planeOf(positions, t);
        area += 0.5 * length(plane.normal);
        volume += dot(plane.point - center, plane.normal) / 6.0;
    }
    return std::abs(volume) < kVolumeMin * area * std::sqrt(area) ? std::nullopt : std::optional(volume);
}

std::string NearCopies::text() const {
    const bool one = parts == 1;
    return std::to_string(parts) + (one ? " closed part lies" : " closed parts lie") + " within " +
           shortest(static_cast<float>(farthest)) +
           " of another part; only the largest copy is baked, and the gap between the copies is filled";
}

NearCopies nearCopies(const TriangleMesh& mesh, std::span<const Part* const> solids) {
    NearCopies copies;
    if (solids.size() < 2) {
        return copies;
    }
    std::vector<Solid> measures;
    measures.reserve(solids.size());
    for (const Part* part : solids) {
        measures.push_back(measured(mesh, *part));
    }
    std::ranges::stable_sort(measures, std::greater<>(), &Solid::volume);
    Places kept;
    for (const Solid& solid : measures) {
        const bool is_copy = kept.anyNear(solid, [&](const Solid* other) {
            const std::optional<double> distance = distanceBetween(mesh, *other, solid);
            copies.farthest = std::max(copies.farthest, distance.value_or(0.0));
            return distance.has_value();
        });
        if (is_copy) {
            const std::vector<std::uint32_t>& triangles = solid.part->triangles;
            copies.triangles.insert(copies.triangles.end(), triangles.begin(), triangles.end());
            ++copies.parts;
        } else {
            kept.add(solid);
        }
    }
    std::ranges::sort(copies.triangles);
    return copies;
}

}  // namespace relief
