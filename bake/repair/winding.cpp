#include "bake/repair/winding.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
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

/// Surfaces nearer to each other along a line, in units of the longest side, lie in one place.
constexpr double kOnePlace = 1e-10;
/// With more patches than these, the open ones are asked by lines too: the rays of one after the other would take the
/// square of their number where they lie in one place.
constexpr std::size_t kManyPatches = 1000;
/// Lines that are asked at a time.
constexpr std::size_t kLinesAtOnce = 64;

/// Triangles that hang together by edges of two triangles.
struct Patch {
    std::vector<std::uint32_t> triangles;
    std::uint64_t turned = 0;  ///< of them, to agree with the first
    bool closed = true;
    std::optional<bool> hollow;   ///< of a closed one: whether all of it lies inside an odd number of others
    std::optional<bool> inwards;  ///< of an open one: whether the inside is clearly in front of it
};

class Winder {
  public:
    explicit Winder(const PreparedMesh& mesh)
        : prepared_(mesh), mesh_(*mesh), turn_(mesh->triangles.size(), 0) {}

    /// For each triangle, whether it must be turned.
    Result<std::vector<bool>> run() {
        if (isOnePatchWoundAlike()) {
            return std::vector<bool>(turn_.size(), false);
        }
        findNeighbours();
        findPatches();
        const bool consistent = std::all_of(patches_.begin(), patches_.end(),
                                            [](const Patch& patch) { return patch.turned == 0; });
        if (consistent && patches_.size() == 1) {  // one-sided
            return std::vector<bool>(turn_.size(), false);
        }
        prepared_.freeEdges();
        // Parity does not care about the winding: asked before anything is turned.
        const MeshQuery query = RELIEF_TRY(MeshQuery::build(prepared_));
        tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t i) {
            // Breadth first is no order to spread samples over.
            std::sort(patches_[i].triangles.begin(), patches_[i].triangles.end());
        });
        Nesting(*this, query).run();
        tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t i) {
            const Patch& patch = patches_[i];
            if (looksInwards(patch, query)) {
                for (const std::uint32_t triangle : patch.triangles) {
                    turn_[triangle] ^= 1U;
                }
            }
        });
        return std::vector<bool>(turn_.begin(), turn_.end());
    }

  private:
    /// As most meshes are.
    [[nodiscard]] bool isOnePatchWoundAlike() const {
        const std::vector<EdgeUse>& uses = prepared_.edges().uses;
        DisjointSets patches(turn_.size());
        std::size_t count = turn_.size();
        bool alike = true;
        forEachEdge(uses, [&](std::size_t begin, std::size_t end) {
            if (end - begin == 2) {
                alike = alike && uses[begin].down != uses[begin + 1].down;
                count -= patches.join(uses[begin].triangle, uses[begin + 1].triangle) ? 1U : 0U;
            }
        });
        return alike && count == 1;
    }

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
            if (patch.hollow) {
                return inwards != *patch.hollow;
            }
            for (std::size_t i = 0; i < asked; ++i) {
                const std::array<bool, 2> inside = answer(i);
                if (!inside[inwards ? 1 : 0]) {
                    return inwards;
                }
            }
            return !inwards;  // a hollow in another patch
        }
        if (patch.inwards) {
            return *patch.inwards;
        }
        double sum = 0.0;
        for (std::size_t i = 0; i < asked; ++i) {
            const std::array<bool, 2> inside = answer(i);
            sum += static_cast<double>(inside[0]) - static_cast<double>(inside[1]);
        }
        return sum > kClearShare * static_cast<double>(asked);
    }

    /// Which of the closed patches are hollows in others, and of many open ones where they look. One line tells it of all patches that it crosses, so that
    /// thousands of them within each other take no more lines than one; and however thin the wall between two of them is,
    /// it tells them apart.
    class Nesting {
      public:
        Nesting(Winder& winder, const MeshQuery& query)
            : winder_(winder),
              mesh_(winder.mesh_),
              patches_(winder.patches_),
              query_(query),
              known_(patches_.size()) {}

        void run() {
            patch_of_.resize(mesh_.triangles.size());
            std::vector<std::uint32_t> order;
            std::vector<float> size(patches_.size());
            for (std::uint32_t i = 0; i < patches_.size(); ++i) {
                Bounds box;
                for (const std::uint32_t triangle : patches_[i].triangles) {
                    patch_of_[triangle] = i;
                    for (int corner = 0; corner < 3; ++corner) {
                        box.add(mesh_.positions[mesh_.triangles[triangle][corner]]);
                    }
                }
                size[i] = box.longestSide();
                if (patches_[i].closed || patches_.size() > kManyPatches) {
                    order.push_back(i);
                }
            }
            // The innermost first: their lines cross all that they lie in.
            std::stable_sort(order.begin(), order.end(),
                             [&](std::uint32_t a, std::uint32_t b) { return size[a] < size[b]; });
            while (!order.empty()) {
                askAll(order);
                std::erase_if(order, [&](std::uint32_t i) { return decided(i); });
            }
            for (std::size_t i = 0; i < patches_.size(); ++i) {
                const Known& known = known_[i];
                if (patches_[i].closed && (known.outside || known.samples > 0)) {
                    patches_[i].hollow = !known.outside;
                } else if (!patches_[i].closed && patches_.size() > kManyPatches && known.samples > 0) {
                    patches_[i].inwards = known.facing > kClearShare * static_cast<double>(known.samples);
                }
            }
        }

      private:
        struct Known {
            std::size_t asked = 0;  ///< lines through it
            std::size_t samples =
                0;  ///< places of it; of a closed one those that lie inside an odd number of others
            bool outside = false;  ///< of a closed one: a place that does not
            double facing =
                0.0;  ///< of an open one: the samples with the inside in front, less those with it behind
        };
        /// A place of a patch that a line crosses.
        struct Place {
            std::uint32_t patch;
            bool outside;
            int facing;
        };

        [[nodiscard]] bool decided(std::uint32_t i) const {
            const std::size_t wanted = std::min(patches_[i].triangles.size(), kAskedMax);
            return known_[i].outside || known_[i].samples >= wanted ||
                   known_[i].asked >= std::max(wanted, kParityDirections.size());
        }

        /// One line for each, but for those that other lines have decided before.
        void askAll(const std::vector<std::uint32_t>& order) {
            std::vector<std::uint32_t> asked;
            std::vector<std::vector<Place>> places(kLinesAtOnce);
            std::size_t at_once = 2;
            for (std::size_t next = 0; next < order.size();) {
                asked.clear();
                for (; next < order.size() && asked.size() < at_once; ++next) {
                    if (!decided(order[next])) {
                        asked.push_back(order[next]);
                    }
                }
                at_once = std::min(2 * at_once, kLinesAtOnce);
                tbb::parallel_for(std::size_t{0}, asked.size(),
                                  [&](std::size_t k) { askLine(asked[k], places[k]); });
                for (std::size_t k = 0; k < asked.size(); ++k) {
                    ++known_[asked[k]].asked;
                    for (const Place& place : places[k]) {
                        known_[place.patch].outside = known_[place.patch].outside || place.outside;
                        known_[place.patch].samples += place.outside ? 0 : 1;
                        known_[place.patch].facing += place.facing;
                    }
                }
            }
        }

        /// What the next line through a patch says of all patches that it crosses: whether they lie, a hair outwards of
        /// their own surface, inside an odd number of others. Nothing, if the crossings do not add up.
        void askLine(std::uint32_t patch, std::vector<Place>& places) const {
            places.clear();
            const std::vector<std::uint32_t>& triangles = patches_[patch].triangles;
            const std::size_t asked = std::min(triangles.size(), kAskedMax);
            const std::size_t k = known_[patch].asked;
            // Off the middle, which lies on lines of symmetry more often.
            const glm::dvec3 on = pointOn(mesh_, triangles[k % asked * triangles.size() / asked], 0.37, 0.29);
            const glm::dvec3& direction = kParityDirections[k % kParityDirections.size()];
            std::vector<LineHit> hits;
            query_.hitsAlong(on, direction, hits);
            if (hits.size() % 2 != 0) {
                return;
            }
            const double one_place = kOnePlace * mesh_.bounds.longestSide();
            // By patch, and in the order of the line: of how many crossings before it each is the next.
            std::vector<std::pair<std::uint32_t, std::uint32_t>> own;
            for (std::uint32_t i = 0; i < hits.size(); ++i) {
                own.emplace_back(patch_of_[hits[i].triangle], i);
            }
            std::sort(own.begin(), own.end());
            // Of each hit, the first and the last in its place.
            std::vector<std::uint32_t> first(hits.size());
            std::vector<std::uint32_t> last(hits.size());
            for (std::size_t i = 0; i < hits.size(); ++i) {
                const bool same = i > 0 && hits[i].at - hits[i - 1].at <= one_place;
                first[i] = same ? first[i - 1] : static_cast<std::uint32_t>(i);
            }
            for (std::size_t i = hits.size(); i-- > 0;) {
                const bool same = i + 1 < hits.size() && first[i + 1] == first[i];
                last[i] = same ? last[i + 1] : static_cast<std::uint32_t>(i);
            }
            for (std::size_t begin = 0; begin < own.size();) {
                std::size_t end = begin;
                while (end < own.size() && own[end].first == own[begin].first) {
                    ++end;
                }
                const std::uint32_t of = own[begin].first;
                if (!patches_[of].closed) {
                    for (std::size_t i = begin; i < end; ++i) {
                        const LineHit& hit = hits[own[i].second];
                        const int before = first[own[i].second] % 2 == 0 ? 0 : 1;
                        const int after = last[own[i].second] % 2 == 0 ? 1 : 0;
                        const bool ahead = dot(winder_.normalOf(hit.triangle), direction) > 0.0;
                        places.push_back({of, false, ahead ? after - before : before - after});
                    }
                } else if ((end - begin) % 2 != 0) {
                    places.clear();
                    return;
                } else {
                    for (std::size_t i = begin; i < end; ++i) {
                        addPlace(of, own, begin, end, i, first, last, places);
                    }
                }
                begin = end;
            }
        }

        /// \param i  of own[begin … end), the crossings of a patch.
        static void addPlace(std::uint32_t of,
                             const std::vector<std::pair<std::uint32_t, std::uint32_t>>& own,
                             std::size_t begin, std::size_t end, std::size_t i,
                             const std::vector<std::uint32_t>& first, const std::vector<std::uint32_t>& last,
                             std::vector<Place>& places) {
            const std::uint32_t hit = own[i].second;
            const bool enters = (i - begin) % 2 == 0;
            // All crossings before the place or up to its end, less those of the patch itself.
            const std::uint32_t before = enters ? first[hit] : last[hit] + 1;
            std::size_t mine = i - begin;
            while (enters && mine > 0 && own[begin + mine - 1].second >= before) {
                --mine;
            }
            while (!enters && begin + mine < end && own[begin + mine].second < before) {
                ++mine;
            }
            places.push_back({of, (before - mine) % 2 == 0, 0});
        }

        const Winder& winder_;
        const TriangleMesh& mesh_;
        std::vector<Patch>& patches_;
        const MeshQuery& query_;
        std::vector<Known> known_;
        std::vector<std::uint32_t> patch_of_;
    };

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
