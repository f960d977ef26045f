// SPDX-License-Identifier: Apache-2.0
#include "bake/repair/winding.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "bake/mesh/mesh_edges.h"
#include "bake/mesh/mesh_query.h"
#include "bake/mesh/surface_sampler.h"

namespace relief {
namespace {

/// Maximum number of samples per patch, spread evenly over its list of triangles.
constexpr std::size_t kSamplesMax = 63;
/// An open patch is flipped if votes in favour minus votes against exceed this fraction of its samples.
constexpr double kFlipFraction = 0.5;
/// Surfaces closer than this along a line coincide; in units of the longest side.
constexpr double kCoincident = 1e-10;
/// If there are more patches, lines also sample open patches. Separate rays for each patch would take quadratic time if
/// the patches coincide.
constexpr std::size_t kManyPatches = 1000;
constexpr std::size_t kLinesAtOnce = 64;

/// Triangles connected by edges of two triangles.
struct Patch {
    std::vector<std::uint32_t> triangles;
    std::uint64_t turned = 0;  ///< triangles flipped to agree with the first
    bool closed = true;
    std::optional<bool> hollow;   ///< whether a closed patch lies inside an odd number of others
    std::optional<bool> inwards;  ///< whether an open patch clearly has the inside in front of it
};

class Winder {
  public:
    explicit Winder(const PreparedMesh& mesh)
        : prepared_(mesh), mesh_(*mesh), turn_(mesh->triangles.size(), 0) {}

    /// Returns, per triangle, whether to flip it.
    Result<std::vector<bool>> run() {
        if (isOneConsistentPatch()) {
            return std::vector<bool>(turn_.size(), false);
        }
        findPatches();
        const bool consistent =
            std::ranges::all_of(patches_, [](const Patch& patch) { return patch.turned == 0; });
        if (consistent && patches_.size() == 1) {  // one-sided
            return std::vector<bool>(turn_.size(), false);
        }
        prepared_.freeEdges();
        // Parity does not depend on the winding, which changes below.
        const MeshQuery query = RELIEF_TRY(MeshQuery::build(prepared_));
        tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t i) {
            // Sorted, unlike the search order, to spread samples.
            std::ranges::sort(patches_[i].triangles);
        });
        Nesting(*this, query).run();
        tbb::parallel_for(std::size_t{0}, patches_.size(), [&](std::size_t i) {
            const Patch& patch = patches_[i];
            if (facesInwards(patch, query)) {
                for (const std::uint32_t triangle : patch.triangles) {
                    turn_[triangle] ^= 1U;
                }
            }
        });
        return std::vector<bool>(turn_.begin(), turn_.end());
    }

  private:
    /// Whether the mesh is a single, consistently wound patch: the common case.
    [[nodiscard]] bool isOneConsistentPatch() const {
        const std::vector<EdgeUse>& uses = prepared_.edges().uses;
        DisjointSets patches(turn_.size());
        std::size_t count = turn_.size();
        bool consistent = true;
        forEachEdge(uses, [&](std::size_t begin, std::size_t end) {
            if (end - begin == 2) {
                consistent = consistent && uses[begin].down != uses[begin + 1].down;
                count -= patches.join(uses[begin].triangle, uses[begin + 1].triangle) ? 1U : 0U;
            }
        });
        return consistent && count == 1;
    }

    void findPatches() {
        const TriangleNeighbours neighbours = neighboursOf(prepared_.edges().uses);
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
                for (std::uint8_t side = 0; side < 3; ++side) {
                    const std::uint32_t next = neighbours.across[here][side];
                    const unsigned same = neighbours.same[here][side] ? 1U : 0U;
                    if (next == TriangleNeighbours::kNone) {
                        patch.closed = false;
                    } else if (!seen[next]) {
                        seen[next] = true;
                        turn_[next] = static_cast<std::uint8_t>(turn_[here] ^ same);
                        patch.turned += turn_[next];
                        patch.triangles.push_back(next);
                    } else if ((turn_[here] ^ turn_[next]) != same) {
                        patch.closed = false;  // one-sided
                    }
                }
            }
            // The majority decides.
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

    /// Returns six times the volume of a patch, as currently wound.
    [[nodiscard]] double volumeOf(const Patch& patch) const {
        const glm::dvec3 center = mesh_.bounds.center();
        double volume = 0.0;
        for (const std::uint32_t triangle : patch.triangles) {
            volume += dot(planeOf(mesh_, triangle).point - center, normalOf(triangle));
        }
        return volume;
    }

    /// Whether points just in front of and just behind a triangle are inside.
    [[nodiscard]] std::array<bool, 2> sidesOf(std::uint32_t triangle, const MeshQuery& query) const {
        const glm::dvec3 on = sampleOn(triangle);
        glm::dvec3 normal = normalOf(triangle);
        normal *= kSurfaceStep * static_cast<double>(mesh_.bounds.longestSide()) / length(normal);
        return {isInside(on + normal, query), isInside(on - normal, query)};
    }

    /// Returns a point off the middle, because the middle is more often on a line of symmetry.
    [[nodiscard]] glm::dvec3 sampleOn(std::uint32_t triangle) const {
        return pointOn(mesh_, triangle, 0.37, 0.29);
    }

    /// Uses only parity, because the winding is unknown.
    [[nodiscard]] static bool isInside(const glm::vec3& p, const MeshQuery& query) {
        std::size_t odd = 0;
        for (const glm::dvec3& direction : kParityDirections) {
            odd += query.crossings(p, direction) % 2;
        }
        return odd > kParityDirections.size() / 2;
    }

    [[nodiscard]] bool facesInwards(const Patch& patch, const MeshQuery& query) const {
        const std::size_t samples = std::min(patch.triangles.size(), kSamplesMax);
        const auto sample = [&](std::size_t i) {
            return sidesOf(patch.triangles[i * patch.triangles.size() / samples], query);
        };
        if (patch.closed) {
            const bool inwards = volumeOf(patch) < 0.0;
            if (patch.hollow) {
                return inwards != *patch.hollow;
            }
            for (std::size_t i = 0; i < samples; ++i) {
                if (!sample(i)[inwards ? 1 : 0]) {
                    return inwards;
                }
            }
            return !inwards;  // a cavity in another patch
        }
        if (patch.inwards) {
            return *patch.inwards;
        }
        double sum = 0.0;
        for (std::size_t i = 0; i < samples; ++i) {
            const std::array<bool, 2> inside = sample(i);
            sum += static_cast<double>(inside[0]) - static_cast<double>(inside[1]);
        }
        return sum > kFlipFraction * static_cast<double>(samples);
    }

    /// Finds the closed patches that are cavities in others, and the orientation of many open patches. One line
    /// classifies all patches that it crosses, so thousands of nested patches need no more lines than one patch,
    /// however thin the walls between them are.
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
                    addTriangle(box, mesh_, triangle);
                }
                size[i] = box.longestSide();
                if (patches_[i].closed || patches_.size() > kManyPatches) {
                    order.push_back(i);
                }
            }
            // Innermost first: their lines cross all enclosing patches.
            std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return size[i]; });
            while (!order.empty()) {
                traceAll(order);
                std::erase_if(order, [&](std::uint32_t i) { return decided(i); });
            }
            for (std::size_t i = 0; i < patches_.size(); ++i) {
                const Known& known = known_[i];
                if (patches_[i].closed && (known.outside || known.samples > 0)) {
                    patches_[i].hollow = !known.outside;
                } else if (!patches_[i].closed && patches_.size() > kManyPatches && known.samples > 0) {
                    patches_[i].inwards = known.facing > kFlipFraction * static_cast<double>(known.samples);
                }
            }
        }

      private:
        struct Known {
            std::size_t lines = 0;
            std::size_t samples = 0;  ///< for a closed patch, only those inside an odd number of others
            bool outside = false;     ///< a closed patch has a sample outside
            double facing =
                0.0;  ///< for an open patch: samples with the inside in front, minus samples with it behind
        };
        struct Place {
            std::uint32_t patch;
            bool outside;
            int facing;
        };

        [[nodiscard]] bool decided(std::uint32_t i) const {
            const std::size_t wanted = std::min(patches_[i].triangles.size(), kSamplesMax);
            return known_[i].outside || known_[i].samples >= wanted ||
                   known_[i].lines >= std::max(wanted, kParityDirections.size());
        }

        /// Traces one line for each patch that no earlier line has decided.
        void traceAll(const std::vector<std::uint32_t>& order) {
            std::vector<std::uint32_t> chosen;
            std::vector<std::vector<Place>> places(kLinesAtOnce);
            std::size_t at_once = 2;
            for (std::size_t next = 0; next < order.size();) {
                chosen.clear();
                for (; next < order.size() && chosen.size() < at_once; ++next) {
                    if (!decided(order[next])) {
                        chosen.push_back(order[next]);
                    }
                }
                at_once = std::min(2 * at_once, kLinesAtOnce);
                tbb::parallel_for(std::size_t{0}, chosen.size(),
                                  [&](std::size_t k) { traceLine(chosen[k], places[k]); });
                for (std::size_t k = 0; k < chosen.size(); ++k) {
                    ++known_[chosen[k]].lines;
                    for (const Place& place : places[k]) {
                        Known& known = known_[place.patch];
                        known.outside = known.outside || place.outside;
                        known.samples += place.outside ? 0 : 1;
                        known.facing += place.facing;
                    }
                }
            }
        }

        /// Traces the next line through a patch, and classifies all patches that it crosses: whether a point just
        /// outside its surface is inside an odd number of other patches. Returns no places if the crossings do not
        /// balance.
        void traceLine(std::uint32_t patch, std::vector<Place>& places) const {
            places.clear();
            const std::vector<std::uint32_t>& triangles = patches_[patch].triangles;
            const std::size_t samples = std::min(triangles.size(), kSamplesMax);
            const std::size_t k = known_[patch].lines;
            const glm::dvec3 on = winder_.sampleOn(triangles[k % samples * triangles.size() / samples]);
            const glm::dvec3& direction = kParityDirections[k % kParityDirections.size()];
            std::vector<LineHit> hits;
            query_.hitsAlong(on, direction, hits);
            if (hits.size() % 2 != 0) {
                return;
            }
            const double coincident = kCoincident * mesh_.bounds.longestSide();
            // Patch and index of each hit, sorted by patch.
            std::vector<std::pair<std::uint32_t, std::uint32_t>> own;
            for (std::uint32_t i = 0; i < hits.size(); ++i) {
                own.emplace_back(patch_of_[hits[i].triangle], i);
            }
            std::ranges::sort(own);
            // The first and last hits that coincide with each hit.
            std::vector<std::uint32_t> first(hits.size());
            std::vector<std::uint32_t> last(hits.size());
            for (std::size_t i = 0; i < hits.size(); ++i) {
                const bool same = i > 0 && hits[i].at - hits[i - 1].at <= coincident;
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

        /// \param i  in [begin, end), the crossings of a patch.
        static void addPlace(std::uint32_t of,
                             const std::vector<std::pair<std::uint32_t, std::uint32_t>>& own,
                             std::size_t begin, std::size_t end, std::size_t i,
                             const std::vector<std::uint32_t>& first, const std::vector<std::uint32_t>& last,
                             std::vector<Place>& places) {
            const std::uint32_t hit = own[i].second;
            const bool enters = (i - begin) % 2 == 0;
            // Counts crossings up to the point just outside the patch, without those of the patch itself.
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
    std::vector<std::uint8_t> turn_;  // by triangle; 1: against the file's order
    std::vector<Patch> patches_;
};

}  // namespace

Result<Winding> windOutwards(PreparedMesh mesh) {
    const std::vector<bool> turn = RELIEF_TRY(Winder(mesh).run());
    const auto turned = static_cast<std::uint64_t>(std::ranges::count(turn, true));
    return Winding{std::move(mesh).woundOutwards(turn), turned};
}

}  // namespace relief
