// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/sheet.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <span>
#include <utility>

#include "bake/repair/hole_caps.h"

namespace relief {
namespace {

/// Longest mitre, in units of half the thickness: that of kFoldCosine.
constexpr double kMitreMax = 2.0;
/// Smallest offset of a side by its mitre, in units of half the thickness.
constexpr double kMitreLeast = 0.7;
/// Damping, in units of the number of normals; keeps the mitre defined if all normals are equal.
constexpr double kMitreDamping = 1e-4;

glm::dvec3 unitNormal(const std::vector<glm::vec3>& positions, const glm::uvec3& t) {
    return unit(planeOf(positions, t).normal);
}

/// Winds neighbours consistently, and cuts joints of one-sided surfaces.
void windConsistently(Sheet& sheet, const std::vector<std::array<bool, 3>>& same) {
    std::vector<std::uint8_t> state(sheet.triangles.size(), 0);  // 1: unchanged, 2: flipped
    std::vector<std::uint32_t> queue;
    for (std::uint32_t first = 0; first < sheet.triangles.size(); ++first) {
        if (state[first] != 0) {
            continue;
        }
        state[first] = 1;
        queue.assign(1, first);
        for (std::size_t at = 0; at < queue.size(); ++at) {
            const std::uint32_t here = queue[at];
            for (std::uint8_t side = 0; side < 3; ++side) {
                const std::uint32_t next = sheet.neighbours[here][side];
                if (next == Sheet::kNoTriangle) {
                    continue;
                }
                const std::uint8_t wanted = same[here][side] != (state[here] == 2) ? 2 : 1;
                if (state[next] == 0) {
                    state[next] = wanted;
                    queue.push_back(next);
                } else if (state[next] != wanted) {  // one-sided
                    for (int i = 0; i < 3; ++i) {
                        if (sheet.neighbours[next][i] == here) {
                            sheet.neighbours[next][i] = Sheet::kNoTriangle;
                        }
                    }
                    sheet.neighbours[here][side] = Sheet::kNoTriangle;
                }
            }
        }
        // The patch's majority decides.
        const auto turned = static_cast<std::size_t>(
            std::ranges::count(queue, 2, [&](std::uint32_t triangle) { return state[triangle]; }));
        for (const std::uint32_t triangle : queue) {
            if ((state[triangle] == 2) != (2 * turned > queue.size())) {
                std::swap(sheet.triangles[triangle].y, sheet.triangles[triangle].z);
                std::swap(sheet.neighbours[triangle].x, sheet.neighbours[triangle].z);
            }
        }
    }
}

/// Joins triangles across edges of two triangles, and cuts folds, which are detectable only after neighbours are wound
/// alike.
void joinEdges(Sheet& sheet) {
    TriangleNeighbours neighbours = neighboursOf(edgeUses(sheet.triangles, sheet.positions.size()));
    sheet.neighbours = std::move(neighbours.across);
    windConsistently(sheet, neighbours.same);
    for (std::uint32_t i = 0; i < sheet.triangles.size(); ++i) {
        for (int side = 0; side < 3; ++side) {
            const std::uint32_t next = sheet.neighbours[i][side];
            if (next != Sheet::kNoTriangle &&
                dot(unitNormal(sheet.positions, sheet.triangles[i]),
                    unitNormal(sheet.positions, sheet.triangles[next])) < kFoldCosine) {
                sheet.neighbours[i][side] = Sheet::kNoTriangle;
            }
        }
    }
}

/// The least-squares mitre m of a corner: n·m = 1 for each of its normals n.
struct Mitre {
    glm::dmat3 squares{0.0};  // sum of n·nᵀ
    glm::dvec3 sum{0.0};
    double weight = 0.0;

    void add(const glm::dvec3& normal, double by) {
        for (int column = 0; column < 3; ++column) {
            squares[column] += by * normal[column] * normal;
        }
        sum += by * normal;
        weight += by;
    }

    [[nodiscard]] glm::dvec3 solve() const {
        const double damping = kMitreDamping * weight;
        const glm::dmat3 damped = squares + damping * glm::dmat3(1.0);
        const glm::dvec3 mitre = (1.0 + kMitreDamping) * (glm::inverse(damped) * sum);
        return length(mitre) > kMitreMax ? mitre * (kMitreMax / length(mitre)) : mitre;
    }
};

double angleAt(const std::vector<glm::vec3>& positions, const glm::uvec3& t, int corner) {
    const glm::dvec3 at = positions[t[corner]];
    const glm::dvec3 a = glm::dvec3(positions[t[(corner + 1) % 3]]) - at;
    const glm::dvec3 b = glm::dvec3(positions[t[(corner + 2) % 3]]) - at;
    const double size = std::sqrt(dot(a, a) * dot(b, b));
    // Any weight that grows with the angle suffices; no arc cosine is needed.
    return size > 0.0 ? 1.0 - std::clamp(dot(a, b) / size, -1.0, 1.0) + 1e-3 : 1e-3;
}

/// Corner k of triangle i has the index 3·i + k. Returns, per corner, the corner at the same vertex across the side
/// that begins there, or kNoTriangle.
std::vector<std::uint32_t> nextCorners(const Sheet& sheet) {
    std::vector<std::uint32_t> next(3 * sheet.triangles.size(), Sheet::kNoTriangle);
    for (std::uint32_t i = 0; i < next.size(); ++i) {
        const int side = static_cast<int>(i % 3);
        const std::uint32_t other = sheet.neighbours[i / 3][side];
        for (std::uint32_t k = 0; k < 3 && other != Sheet::kNoTriangle; ++k) {
            if (sheet.triangles[other][static_cast<int>(k)] == sheet.triangles[i / 3][side]) {
                next[i] = 3 * other + k;
            }
        }
    }
    return next;
}

/// Groups the corners around each vertex that share a mitre.
class CornerFans {
  public:
    /// Splits fans of joined corners whose common mitre would leave a side thin, and cuts the sheet there.
    explicit CornerFans(Sheet& sheet)
        : sheet_(sheet), roots_(3 * sheet.triangles.size(), Sheet::kNoTriangle) {
        for (const glm::uvec3& t : sheet.triangles) {
            normals_.push_back(unitNormal(sheet.positions, t));
        }
        mitres_.resize(roots_.size());
        fan_of_.resize(roots_.size());
        const std::vector<std::uint32_t> next = nextCorners(sheet);
        std::vector<bool> has_previous(next.size(), false);
        for (const std::uint32_t corner : next) {
            if (corner != Sheet::kNoTriangle) {
                has_previous[corner] = true;
            }
        }
        std::vector<std::uint32_t> fan;
        for (const bool closed : {false, true}) {
            for (std::uint32_t first = 0; first < next.size(); ++first) {
                if (roots_[first] != Sheet::kNoTriangle || (!closed && has_previous[first])) {
                    continue;
                }
                fan.assign(1, first);
                for (std::uint32_t i = next[first]; i != Sheet::kNoTriangle && i != first; i = next[i]) {
                    fan.push_back(i);
                }
                for (const std::uint32_t corner : fan) {
                    fan_of_[corner] = first;
                }
                addFan(fan, closed);
            }
        }
    }

    /// Per corner, the lowest corner that shares its mitre.
    [[nodiscard]] const std::vector<std::uint32_t>& roots() const { return roots_; }
    [[nodiscard]] const glm::dvec3& mitreOf(std::uint32_t corner) const { return mitres_[roots_[corner]]; }
    /// Whether a fan was split between two corners of one vertex.
    [[nodiscard]] bool areCut(std::uint32_t a, std::uint32_t b) const {
        return fan_of_[a] == fan_of_[b] && roots_[a] != roots_[b];
    }
    /// Pairs of corners across a cut side, which begins at the first corner. Cut sides are open.
    [[nodiscard]] const std::vector<std::array<std::uint32_t, 2>>& cuts() const { return cuts_; }
    /// The fans in cuts without a border, as roots.
    [[nodiscard]] const std::vector<std::vector<std::uint32_t>>& lids() const { return lids_; }

  private:
    [[nodiscard]] const glm::dvec3& normalOf(std::uint32_t corner) const { return normals_[corner / 3]; }

    void addTo(Mitre& mitre, std::uint32_t corner) const {
        mitre.add(normalOf(corner),
                  angleAt(sheet_.positions, sheet_.triangles[corner / 3], static_cast<int>(corner % 3)));
    }

    void addFan(std::vector<std::uint32_t>& fan, bool closed) {
        Mitre whole;
        for (const std::uint32_t corner : fan) {
            addTo(whole, corner);
        }
        const glm::dvec3 all = whole.solve();
        if (std::ranges::all_of(fan, [&](std::uint32_t k) { return dot(normalOf(k), all) >= kMitreLeast; })) {
            setMitre(fan, all);
            return;
        }
        if (closed) {  // starts after the sharpest edge
            std::size_t sharpest = 0;
            double least = 1.0;
            for (std::size_t k = 0; k < fan.size(); ++k) {
                const double cosine = dot(normalOf(fan[k]), normalOf(fan[(k + 1) % fan.size()]));
                if (cosine < least) {
                    least = cosine;
                    sharpest = k;
                }
            }
            std::rotate(fan.begin(), fan.begin() + static_cast<std::ptrdiff_t>((sharpest + 1) % fan.size()),
                        fan.end());
            cut(fan.back(), fan.front());
        }
        std::vector<std::uint32_t> roots;
        for (std::size_t first = 0, end = 0; first < fan.size(); first = end) {
            Mitre mitre;
            glm::dvec3 common(0.0);
            for (end = first; end < fan.size(); ++end) {
                addTo(mitre, fan[end]);
                const glm::dvec3 with = mitre.solve();
                if (end > first &&
                    std::min(dot(normalOf(fan[first]), with), dot(normalOf(fan[end]), with)) < kMitreLeast) {
                    cut(fan[end - 1], fan[end]);
                    break;
                }
                common = with;
            }
            setMitre(std::span(fan).subspan(first, end - first), common);
            roots.push_back(roots_[fan[first]]);
        }
        if (closed) {
            lids_.push_back(std::move(roots));
        }
    }

    void setMitre(std::span<const std::uint32_t> corners, const glm::dvec3& mitre) {
        const std::uint32_t root = std::ranges::min(corners);
        mitres_[root] = mitre;
        for (const std::uint32_t corner : corners) {
            roots_[corner] = root;
        }
    }

    /// Cuts between a corner and the next one.
    void cut(std::uint32_t corner, std::uint32_t next) {
        sheet_.neighbours[corner / 3][static_cast<int>(corner % 3)] = Sheet::kNoTriangle;
        sheet_.neighbours[next / 3][static_cast<int>((next + 2) % 3)] = Sheet::kNoTriangle;
        cuts_.push_back({corner, next});
    }

    Sheet& sheet_;
    std::vector<glm::dvec3> normals_;  // by triangle
    std::vector<std::uint32_t> roots_;
    std::vector<glm::dvec3> mitres_;     // by root
    std::vector<std::uint32_t> fan_of_;  // the first corner of the fan before it was split
    std::vector<std::array<std::uint32_t, 2>> cuts_;
    std::vector<std::vector<std::uint32_t>> lids_;
};

/// An offset that would meet the opposite offset ends at this fraction of the distance to the other side, so that both
/// overlap slightly.
constexpr double kThinReach = 0.55;
/// A corner's ray starts this far towards the middle of its triangle, as a fraction of that distance and of the offset.
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

/// Collects a solid part; drops triangles without area.
class PartBuilder {
  public:
    std::uint32_t addPosition(const glm::dvec3& p) {
        part_.positions.emplace_back(p);
        return static_cast<std::uint32_t>(part_.positions.size() - 1);
    }
    void move(std::uint32_t vertex, const glm::dvec3& to) { part_.positions[vertex] = to; }
    /// \param source  the sheet's triangle.
    void addTriangle(std::uint32_t source, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const glm::uvec3 t(a, b, c);
        if (hasArea(planeOf(part_.positions, t))) {
            part_.triangles.push_back(t);
            part_.sources.push_back(source);
        }
    }
    /// Adds a wall below the side from a to b of a triangle seen from above.
    void addWall(std::uint32_t source, const std::array<std::uint32_t, 2>& a,
                 const std::array<std::uint32_t, 2>& b) {
        addTriangle(source, b[0], a[0], a[1]);
        addTriangle(source, b[0], a[1], b[1]);
    }
    [[nodiscard]] glm::dvec3 at(std::uint32_t vertex) const { return part_.positions[vertex]; }
    void endSurface() { part_.surface_triangles = part_.triangles.size(); }
    SolidPart take() { return std::move(part_); }

  private:
    SolidPart part_;
};

/// Closes a surface where a region's offset is omitted.
struct Fan {
    BorderLoop loop;
    glm::vec3 apex{0.0F};
    std::uint32_t source = 0;
};

/// Marks the triangles of thin regions whose offset is omitted. Fans close the remaining surface within the shell's own
/// reach.
/// \param endOf   returns the offset of a triangle's corner.
/// \param turned  the offset's triangles have the opposite winding.
/// \param fans    receives the fans.
template <class EndOf>
std::vector<bool> filledRegions(const Sheet& sheet, const std::vector<std::uint8_t>& thin, const EndOf& endOf,
                                bool turned, const PartBuilder& builder, const MeshQuery& query, double reach,
                                std::vector<Fan>& fans) {
    std::vector<bool> full(sheet.triangles.size(), false);
    std::vector<bool> seen(sheet.triangles.size(), false);
    std::vector<std::uint32_t> region;
    for (std::uint32_t first = 0; first < sheet.triangles.size(); ++first) {
        if (seen[first] || thin[first] == 0) {
            continue;
        }
        seen[first] = true;
        region.assign(1, first);
        std::vector<OddEdge> border;  // with the remaining triangles
        for (std::size_t k = 0; k < region.size(); ++k) {
            for (std::uint32_t side = 0; side < 3; ++side) {
                const std::uint32_t next = sheet.neighbours[region[k]][static_cast<int>(side)];
                if (next == Sheet::kNoTriangle || thin[next] == 0) {
                    const std::uint32_t from = endOf(region[k], side);
                    const std::uint32_t to = endOf(region[k], (side + 1) % 3);
                    border.push_back(turned ? OddEdge{from, to} : OddEdge{to, from});
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
                sum += builder.at(step.from);
            }
            const glm::vec3 apex(sum / static_cast<double>(loop.size()));
            closes = closes && query.closest(apex).distance <= reach &&
                     std::ranges::all_of(loop, [&](const BorderStep& step) {
                         return hasArea(planeOf(builder.at(step.from), builder.at(step.to), apex));
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

    /// Ignores triangles at the same vertex. \param but_cut  does not ignore triangles that are cut from the corner.
    [[nodiscard]] std::array<double, 2> clearanceAtCorner(std::uint32_t corner, bool but_cut) const {
        const glm::uvec3& t = sheet_.triangles[corner / 3];
        const std::uint32_t vertex = t[static_cast<int>(corner % 3)];
        const glm::dvec3 inwards = middleOf(sheet_, t) - placeOf(corner);
        const double start = kThinStart * std::min(1.0, length(offsetOf(corner)) / length(inwards));
        return clearanceAt(query_, placeOf(corner) + start * inwards, offsetOf(corner),
                           [&](std::uint32_t other) {
                               for (std::uint32_t k = 0; k < 3; ++k) {
                                   if (sheet_.triangles[other][static_cast<int>(k)] == vertex) {
                                       return !but_cut || !fans_.areCut(corner, 3 * other + k);
                                   }
                               }
                               return false;
                           });
    }

    [[nodiscard]] std::vector<std::array<double, 2>> clearanceByRoot(bool but_cut) const {
        std::vector<std::array<double, 2>> room(roots_.size());
        tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(roots_.size()),
                          [&](std::uint32_t i) { room[i] = clearanceAtCorner(i, but_cut); });
        for (std::uint32_t i = 0; i < roots_.size(); ++i) {
            for (const std::size_t face : {0U, 1U}) {
                room[roots_[i]][face] = std::min(room[roots_[i]][face], room[i][face]);
            }
        }
        return room;
    }

    /// Returns, by root, whether an edge there would flip in the offset above or below.
    [[nodiscard]] std::vector<std::array<bool, 2>> flipsOver() const {
        std::vector<std::array<bool, 2>> turns(roots_.size());
        for (std::uint32_t i = 0; i < roots_.size(); ++i) {
            const std::uint32_t next = i % 3 == 2 ? i - 2 : i + 1;
            const glm::dvec3 side = placeOf(next) - placeOf(i);
            const double change = dot(side, offsetOf(next) - offsetOf(i));
            for (const std::uint32_t k : {i, next}) {
                turns[roots_[k]][0] = turns[roots_[k]][0] || dot(side, side) + change < 0.0;
                turns[roots_[k]][1] = turns[roots_[k]][1] || dot(side, side) - change < 0.0;
            }
        }
        return turns;
    }

    /// \param turns  flipsOver(): there, the offset ends before the opposite surface.
    void placeEnds(const std::vector<std::array<bool, 2>>& turns) {
        ends_.resize(roots_.size());
        for (std::uint32_t i = 0; i < roots_.size(); ++i) {
            if (roots_[i] == i) {
                const auto reach = [&](std::size_t face) {
                    return turns[i][face] ? std::min(1.0, kThinReach * clearance_[i][face]) : 1.0;
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

    /// \param face  0: above, 1: below.
    /// \param fans  receives the fans of its filled regions.
    void addFace(std::size_t face, std::vector<Fan>& fans) {
        const auto endOf = [&](std::uint32_t i, std::uint32_t corner) { return endsOf(i, corner)[face]; };
        const std::vector<bool> full =
            filledRegions(sheet_, thin_[face], endOf, face == 1, builder_, query_, thickness_, fans);
        for (std::uint32_t i = 0; i < sheet_.triangles.size(); ++i) {
            if (!full[i]) {
                builder_.addTriangle(i, endOf(i, 0), endOf(i, face == 0 ? 1 : 2),
                                     endOf(i, face == 0 ? 2 : 1));
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

TriangleMesh meshOf(const Sheet& sheet, const std::string& name) {
    TriangleMesh mesh;
    mesh.name = name;
    mesh.positions = sheet.positions;
    mesh.triangles = sheet.triangles;
    mesh.labels = sheet.sources;
    return mesh;
}

Sheet sheetOf(const TriangleMesh& mesh, std::span<const std::uint32_t> welded,
              std::span<const std::uint32_t> triangles) {
    Sheet sheet;
    std::vector<std::uint32_t> used;
    for (const std::uint32_t i : triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            used.push_back(welded[mesh.triangles[i][corner]]);
        }
    }
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    const auto indexOf = [&](std::uint32_t vertex) {
        return static_cast<std::uint32_t>(std::ranges::lower_bound(used, welded[vertex]) - used.begin());
    };
    for (const std::uint32_t vertex : used) {
        sheet.positions.push_back(mesh.positions[vertex]);
    }
    std::vector<std::uint32_t> with_area;
    for (const std::uint32_t i : triangles) {
        const glm::uvec3& t = mesh.triangles[i];
        if (hasArea(planeOf(mesh.positions, {welded[t.x], welded[t.y], welded[t.z]}))) {
            with_area.push_back(i);
        }
    }
    std::vector<SortedTriangle> sorted = sortedTriangles(mesh, welded, with_area);
    sheet.duplicates = dropRepeats(sorted);
    std::ranges::sort(sorted, {}, &SortedTriangle::index);
    for (const SortedTriangle& kept : sorted) {
        const glm::uvec3& t = mesh.triangles[kept.index];
        sheet.triangles.emplace_back(indexOf(t.x), indexOf(t.y), indexOf(t.z));
        sheet.sources.push_back(kept.index);
    }
    joinEdges(sheet);
    return sheet;
}

SolidPart thickened(Sheet sheet, const MeshQuery& query, double thickness) {
    return Thickener(sheet, query, thickness).run();
}

Shadow shadowOf(const Sheet& sheet) {
    Shadow shadow;
    for (const glm::uvec3& t : sheet.triangles) {
        const glm::dvec3 n = planeOf(sheet.positions, t).normal;
        shadow.signed_area += n;
        shadow.area += glm::abs(n);
    }
    return shadow;
}

SolidPart extruded(const Sheet& sheet, int axis, float bottom) {
    PartBuilder builder;
    const auto count = static_cast<std::uint32_t>(sheet.positions.size());
    for (const glm::vec3& p : sheet.positions) {
        builder.addPosition(p);
    }
    for (glm::vec3 p : sheet.positions) {
        p[axis] = bottom;
        builder.addPosition(p);
    }
    // Upwards, regardless of the sheet's winding.
    const bool turn = !(shadowOf(sheet).signed_area[axis] > 0.0);
    const auto corners = [&](std::uint32_t i) {
        const glm::uvec3& t = sheet.triangles[i];
        return turn ? glm::uvec3(t.x, t.z, t.y) : t;
    };
    for (std::uint32_t i = 0; i < sheet.triangles.size(); ++i) {
        const glm::uvec3 t = corners(i);
        builder.addTriangle(i, t.x, t.y, t.z);
    }
    builder.endSurface();
    for (std::uint32_t i = 0; i < sheet.triangles.size(); ++i) {
        const glm::uvec3 t = corners(i);
        builder.addTriangle(i, count + t.x, count + t.z, count + t.y);
        for (int side = 0; side < 3; ++side) {
            if (sheet.neighbours[i][side] == Sheet::kNoTriangle) {
                const glm::uvec3& s = sheet.triangles[i];
                const auto [from, to] = std::pair{s[side], s[(side + 1) % 3]};
                const auto [a, b] = turn ? std::pair{to, from} : std::pair{from, to};
                builder.addWall(i, {a, count + a}, {b, count + b});
            }
        }
    }
    return builder.take();
}

}  // namespace relief
