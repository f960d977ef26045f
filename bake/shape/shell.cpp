// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/solids.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "bake/repair/hole_caps.h"
#include "bake/shape/corner_fans.h"

namespace relief {
namespace {

/// An offset that would meet the opposite offset ends at this fraction of the distance to the other side, so that both
/// overlap slightly.
constexpr double kThinReach = 0.55;
/// A corner's ray starts towards the middle of its triangle, at most this fraction of that distance and of the offset.
/// Rays from vertices would hit the edges of symmetric meshes.
constexpr double kThinStart = 0.01;

glm::dvec3 middleOf(const Sheet& sheet, const glm::uvec3& t) {
    return (glm::dvec3(sheet.positions[t.x]) + glm::dvec3(sheet.positions[t.y]) +
            glm::dvec3(sheet.positions[t.z])) /
           3.0;
}

/// Returns the free distance from a point of a sheet along an offset and against it, in units of the offset; at most 2,
/// where the offsets of both sides meet.
/// \param isOwn  whether to ignore a triangle, by index.
template <class IsOwn>
std::array<double, 2> clearanceAt(const MeshQuery& query, const glm::dvec3& start, const glm::dvec3& offset,
                                  const IsOwn& isOwn) {
    std::array<double, 2> room = {2.0, 2.0};
    std::vector<LineHit> hits;
    if (offset != glm::dvec3(0.0)) {
        query.hitsAlong(start, offset, hits);
    }
    for (const LineHit& hit : hits) {
        if (hit.at != 0.0 && !isOwn(hit.triangle)) {
            double& side = room[hit.at > 0.0 ? 0 : 1];
            side = std::min(side, std::abs(hit.at));
        }
    }
    return room;
}

/// A fan of triangles that closes a surface where a region's offset is omitted.
struct Fan {
    BorderLoop loop;
    glm::vec3 apex{0.0F};
    std::uint32_t source = 0;
};

class Thickener {
  public:
    /// Cuts the sheet at sharp corners.
    Thickener(Sheet& sheet, const MeshQuery& query, double thickness)
        : sheet_(sheet), query_(query), thickness_(thickness), fans_(sheet), roots_(fans_.roots()) {}

    SolidPart run() {
        clearance_ = clearanceByRoot(false);
        placeEnds(flipsOver());
        markThin();
        if (!fans_.cuts().empty()) {
            shortenThinEnds();
        }
        std::vector<Fan> fans;
        for (const std::size_t face : {0U, 1U}) {
            addFace(face, fans);
        }
        builder_.endSurface();
        addFans(fans);
        addBevels();
        addWalls();
        return builder_.take();
    }

  private:
    [[nodiscard]] glm::dvec3 placeOf(std::uint32_t corner) const {
        return sheet_.positions[sheet_.triangles[corner / 3][static_cast<int>(corner % 3)]];
    }
    [[nodiscard]] glm::dvec3 offsetOf(std::uint32_t corner) const {
        return 0.5 * thickness_ * fans_.mitreOf(corner);
    }
    [[nodiscard]] std::array<std::uint32_t, 2> endsOf(std::uint32_t triangle, std::uint32_t corner) const {
        return ends_[roots_[3 * triangle + corner]];
    }

    /// Ignores triangles at the corner's vertex. \param count_cut  does not ignore triangles cut from the corner.
    [[nodiscard]] std::array<double, 2> clearanceAtCorner(std::uint32_t corner, bool count_cut) const {
        const glm::uvec3& t = sheet_.triangles[corner / 3];
        const std::uint32_t vertex = t[static_cast<int>(corner % 3)];
        const glm::dvec3 inwards = middleOf(sheet_, t) - placeOf(corner);
        const double start = kThinStart * std::min(1.0, length(offsetOf(corner)) / length(inwards));
        return clearanceAt(query_, placeOf(corner) + start * inwards, offsetOf(corner),
                           [&](std::uint32_t other) {
                               for (std::uint32_t k = 0; k < 3; ++k) {
                                   if (sheet_.triangles[other][static_cast<int>(k)] == vertex) {
                                       return !count_cut || !fans_.areCut(corner, 3 * other + k);
                                   }
                               }
                               return false;
                           });
    }

    [[nodiscard]] std::vector<std::array<double, 2>> clearanceByRoot(bool count_cut) const {
        std::vector<std::array<double, 2>> room(roots_.size());
        tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(roots_.size()),
                          [&](std::uint32_t i) { room[i] = clearanceAtCorner(i, count_cut); });
        for (std::uint32_t i = 0; i < roots_.size(); ++i) {
            for (const std::size_t face : {0U, 1U}) {
                room[roots_[i]][face] = std::min(room[roots_[i]][face], room[i][face]);
            }
        }
        return room;
    }

    /// Returns, by root, whether an edge there would flip in the offset above or below.
    [[nodiscard]] std::vector<std::array<bool, 2>> flipsOver() const {
        std::vector<std::array<bool, 2>> flips(roots_.size());
        for (std::uint32_t i = 0; i < roots_.size(); ++i) {
            const std::uint32_t next = i % 3 == 2 ? i - 2 : i + 1;
            const glm::dvec3 side = placeOf(next) - placeOf(i);
            const double change = dot(side, offsetOf(next) - offsetOf(i));
            for (const std::uint32_t k : {i, next}) {
                flips[roots_[k]][0] = flips[roots_[k]][0] || dot(side, side) + change < 0.0;
                flips[roots_[k]][1] = flips[roots_[k]][1] || dot(side, side) - change < 0.0;
            }
        }
        return flips;
    }

    /// \param flips  from flipsOver(). The offset of a flipping corner ends before the opposite surface.
    void placeEnds(const std::vector<std::array<bool, 2>>& flips) {
        ends_.resize(roots_.size());
        for (std::uint32_t i = 0; i < roots_.size(); ++i) {
            if (roots_[i] == i) {
                const auto reach = [&](std::size_t face) {
                    return flips[i][face] ? std::min(1.0, kThinReach * clearance_[i][face]) : 1.0;
                };
                ends_[i] = {builder_.addPosition(placeOf(i) + reach(0) * offsetOf(i)),
                            builder_.addPosition(placeOf(i) - reach(1) * offsetOf(i))};
            }
        }
    }

    /// Whether all corners of a triangle are thin, or its middle is thin and its offset flips.
    [[nodiscard]] bool isThin(std::uint32_t i, std::size_t face) const {
        bool corners = true;
        bool turned = false;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t next = (k + 1) % 3;
            const glm::dvec3 from = builder_.at(endsOf(i, k)[face]);
            const glm::dvec3 to = builder_.at(endsOf(i, next)[face]);
            corners = corners && clearance_[roots_[3 * i + k]][face] < 2.0;
            turned = turned || dot(placeOf(3 * i + next) - placeOf(3 * i + k), to - from) < 0.0;
        }
        const glm::uvec3& t = sheet_.triangles[i];
        const auto is_own = [&](std::uint32_t other) { return other == i; };
        return corners || (turned && clearanceAt(query_, middleOf(sheet_, t),
                                                 0.5 * thickness_ * unitNormal(sheet_.positions, t),
                                                 is_own)[face] < 2.0);
    }

    void markThin() {
        for (const std::size_t face : {0U, 1U}) {
            thin_[face].resize(sheet_.triangles.size());
            tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(sheet_.triangles.size()),
                              [&](std::uint32_t i) { thin_[face][i] = isThin(i, face) ? 1 : 0; });
        }
    }

    /// Shortens corners where the sheet is cut and only thin triangles meet, as at the tip of a needle.
    void shortenThinEnds() {
        const std::vector<std::array<double, 2>> room = clearanceByRoot(true);
        std::vector<std::array<bool, 2>> thick(roots_.size());
        for (std::uint32_t i = 0; i < roots_.size(); ++i) {
            for (const std::size_t face : {0U, 1U}) {
                thick[roots_[i]][face] = thick[roots_[i]][face] || thin_[face][i / 3] == 0;
            }
        }
        for (const auto& cut : fans_.cuts()) {
            for (const std::uint32_t corner : cut) {
                const std::uint32_t root = roots_[corner];
                for (const std::size_t face : {0U, 1U}) {
                    if (!thick[root][face]) {
                        const double reach = std::min(1.0, kThinReach * room[root][face]);
                        builder_.move(ends_[root][face],
                                      placeOf(root) + (face == 0 ? reach : -reach) * offsetOf(root));
                    }
                }
            }
        }
    }

    /// Marks the triangles of thin regions whose offset is omitted. Fans close the remaining surface within the shell's
    /// own reach.
    /// \param face  0: above, 1: below.
    /// \param fans  receives the fans.
    [[nodiscard]] std::vector<bool> filledRegions(std::size_t face, std::vector<Fan>& fans) const {
        const std::vector<std::uint8_t>& thin = thin_[face];
        std::vector<bool> full(sheet_.triangles.size(), false);
        std::vector<bool> seen(sheet_.triangles.size(), false);
        std::vector<std::uint32_t> region;
        for (std::uint32_t first = 0; first < sheet_.triangles.size(); ++first) {
            if (seen[first] || thin[first] == 0) {
                continue;
            }
            seen[first] = true;
            region.assign(1, first);
            std::vector<OddEdge> border;  // with the remaining triangles
            for (std::size_t k = 0; k < region.size(); ++k) {
                for (std::uint32_t side = 0; side < 3; ++side) {
                    const std::uint32_t next = sheet_.neighbours[region[k]][static_cast<int>(side)];
                    if (next == Sheet::kNoTriangle || thin[next] == 0) {
                        const std::uint32_t from = endsOf(region[k], side)[face];
                        const std::uint32_t to = endsOf(region[k], (side + 1) % 3)[face];
                        border.push_back(face == 1 ? OddEdge{from, to} : OddEdge{to, from});
                    } else if (!seen[next]) {
                        seen[next] = true;
                        region.push_back(next);
                    }
                }
            }
            bool closes = true;
            const std::size_t before = fans.size();
            for (BorderLoop& loop : borderLoops(border)) {
                if (loop.size() < 3) {
                    continue;  // back and forth
                }
                glm::dvec3 sum(0.0);
                for (const BorderStep& step : loop) {
                    sum += builder_.at(step.from);
                }
                const glm::vec3 apex(sum / static_cast<double>(loop.size()));
                closes = closes && query_.closest(apex).distance <= thickness_ &&
                         std::ranges::all_of(loop, [&](const BorderStep& step) {
                             return hasArea(planeOf(builder_.at(step.from), builder_.at(step.to), apex));
                         });
                fans.push_back({std::move(loop), apex, first});
            }
            if (!closes) {
                fans.resize(before);
                continue;
            }
            for (const std::uint32_t triangle : region) {
                full[triangle] = true;
            }
        }
        return full;
    }

    /// \param face, fans  as in filledRegions().
    void addFace(std::size_t face, std::vector<Fan>& fans) {
        const std::vector<bool> full = filledRegions(face, fans);
        for (std::uint32_t i = 0; i < sheet_.triangles.size(); ++i) {
            if (!full[i]) {
                builder_.addTriangle(i, endsOf(i, 0)[face], endsOf(i, face == 0 ? 1 : 2)[face],
                                     endsOf(i, face == 0 ? 2 : 1)[face]);
            }
        }
    }

    void addFans(const std::vector<Fan>& fans) {
        for (const Fan& fan : fans) {
            const std::uint32_t apex = builder_.addPosition(fan.apex);
            for (const BorderStep& step : fan.loop) {
                builder_.addTriangle(fan.source, step.against ? step.to : step.from,
                                     step.against ? step.from : step.to, apex);
            }
        }
    }

    /// Adds bevels between the two ends of each corner where the sheet is cut.
    void addBevels() {
        bevelled_.resize(sheet_.triangles.size());
        std::vector<bool> has_lid(roots_.size(), false);
        for (const std::vector<std::uint32_t>& lid : fans_.lids()) {
            for (const std::uint32_t root : lid) {
                has_lid[root] = true;
            }
            for (std::size_t k = 1; k + 1 < lid.size(); ++k) {
                addBoth(lid[0] / 3, ends_[lid[0]], ends_[lid[k + 1]], ends_[lid[k]]);
            }
        }
        for (const auto& [corner, next] : fans_.cuts()) {
            const std::uint32_t source = corner / 3;
            const std::uint32_t other = next / 3;
            const std::uint32_t side = corner % 3;
            const std::uint32_t across = (next + 2) % 3;
            const std::array<std::uint32_t, 2>& here = ends_[roots_[corner]];
            const std::array<std::uint32_t, 2>& there = ends_[roots_[next]];
            if (!bevelled_[source][side]) {
                bevelled_[source][side] = bevelled_[other][across] = true;
                const std::array<std::uint32_t, 2> far = endsOf(source, (side + 1) % 3);
                addBoth(source, far, here, there);
                addBoth(source, far, there, endsOf(other, across));
            }
            if (!has_lid[roots_[corner]]) {
                builder_.addWall(source, here, there);
            }
        }
    }

    /// Adds a triangle above, and its counterpart below.
    void addBoth(std::uint32_t source, const std::array<std::uint32_t, 2>& a,
                 const std::array<std::uint32_t, 2>& b, const std::array<std::uint32_t, 2>& c) {
        builder_.addTriangle(source, a[0], b[0], c[0]);
        builder_.addTriangle(source, a[1], c[1], b[1]);
    }

    void addWalls() {
        for (std::uint32_t i = 0; i < sheet_.triangles.size(); ++i) {
            for (std::uint32_t side = 0; side < 3; ++side) {
                if (sheet_.neighbours[i][static_cast<int>(side)] == Sheet::kNoTriangle &&
                    !bevelled_[i][side]) {
                    builder_.addWall(i, endsOf(i, side), endsOf(i, (side + 1) % 3));
                }
            }
        }
    }

    const Sheet& sheet_;
    const MeshQuery& query_;
    double thickness_;
    CornerFans fans_;
    const std::vector<std::uint32_t>& roots_;
    std::vector<std::array<double, 2>> clearance_;    // above and below, by root
    std::vector<std::array<std::uint32_t, 2>> ends_;  // above and below, by root
    std::array<std::vector<std::uint8_t>, 2> thin_;   // above and below, by triangle
    std::vector<std::array<bool, 3>> bevelled_;       // by side
    PartBuilder builder_;
};

}  // namespace

SolidPart thickened(Sheet sheet, const MeshQuery& query, double thickness) {
    return Thickener(sheet, query, thickness).run();
}

}  // namespace relief
