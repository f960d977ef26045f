// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/sheet.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "bake/repair/hole_caps.h"

namespace relief {
namespace {

/// The longest mitre, in units of half the thickness: that of kFoldCosine.
constexpr double kMitreMax = 2.0;
/// Keeps the mitre defined where all normals are alike, in units of their number.
constexpr double kMitreDamping = 1e-4;

glm::dvec3 unitNormal(const std::vector<glm::vec3>& positions, const glm::uvec3& t) {
    return unit(planeOf(positions, t).normal);
}

/// Winds neighbours consistently, and cuts joints of one-sided surfaces.
void windConsistently(Sheet& sheet, const std::vector<std::array<bool, 3>>& same) {
    std::vector<std::uint8_t> state(sheet.triangles.size(), 0);  // 1: as it is, 2: turned
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
        // By majority of the patch.
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

/// Joins triangles across edges of two, and cuts the folds, which show once neighbours are wound alike.
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

/// The least-squares mitre m of a corner, n·m = 1 for each of its normals n.
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
    // Any weight that grows with the angle; an arc cosine is not needed.
    return size > 0.0 ? 1.0 - std::clamp(dot(a, b) / size, -1.0, 1.0) + 1e-3 : 1e-3;
}

/// Per corner of a sheet's triangles, the lowest of those around its vertex that are connected by joined edges.
std::vector<std::uint32_t> joinedCorners(const Sheet& sheet) {
    DisjointSets corners(3 * sheet.triangles.size());
    for (std::uint32_t i = 0; i < sheet.triangles.size(); ++i) {
        for (std::uint32_t side = 0; side < 3; ++side) {
            const std::uint32_t next = sheet.neighbours[i][side];
            if (next == Sheet::kNoTriangle) {
                continue;
            }
            for (const std::uint32_t mine : {side, (side + 1) % 3}) {
                for (std::uint32_t theirs = 0; theirs < 3; ++theirs) {
                    if (sheet.triangles[next][theirs] == sheet.triangles[i][mine]) {
                        corners.join(3 * i + mine, 3 * next + theirs);
                    }
                }
            }
        }
    }
    std::vector<std::uint32_t> roots(3 * sheet.triangles.size());
    for (std::uint32_t i = 0; i < roots.size(); ++i) {
        roots[i] = corners.find(i);
    }
    return roots;
}

/// An offset that would meet the one from the other side ends this share of the way to that side: they overlap a little.
constexpr double kThinReach = 0.55;
/// A corner's ray starts this far towards the middle of its triangle, in units of the way and of the offset: rays from
/// vertices meet the edges of symmetric meshes.
constexpr double kThinStart = 0.01;

glm::dvec3 middleOf(const Sheet& sheet, const glm::uvec3& t) {
    return (glm::dvec3(sheet.positions[t.x]) + glm::dvec3(sheet.positions[t.y]) +
            glm::dvec3(sheet.positions[t.z])) /
           3.0;
}

/// The way to what a point of a sheet faces along an offset and against it, in units of the offset: up to 2, where the
/// offsets of both meet.
/// \param isOwn  of a triangle: it is not faced.
template <class IsOwn>
std::array<double, 2> roomAt(const Sheet& sheet, const MeshQuery& query, const glm::dvec3& start,
                             const glm::dvec3& offset, const IsOwn& isOwn) {
    std::array<double, 2> room = {2.0, 2.0};
    std::vector<LineHit> hits;
    if (offset != glm::dvec3(0.0)) {
        query.hitsAlong(start, offset, hits);
    }
    for (const LineHit& hit : hits) {
        if (hit.at != 0.0 && !isOwn(sheet.triangles[hit.triangle])) {
            double& side = room[hit.at > 0.0 ? 0 : 1];
            side = std::min(side, std::abs(hit.at));
        }
    }
    return room;
}

std::array<double, 2> roomAtCorner(const Sheet& sheet, const MeshQuery& query, const glm::uvec3& t,
                                   int corner, const glm::dvec3& offset) {
    const std::uint32_t vertex = t[corner];
    const glm::dvec3 at = sheet.positions[vertex];
    const glm::dvec3 inwards = middleOf(sheet, t) - at;
    const double start = kThinStart * std::min(1.0, length(offset) / length(inwards));
    return roomAt(sheet, query, at + start * inwards, offset, [&](const glm::uvec3& other) {
        return other.x == vertex || other.y == vertex || other.z == vertex;
    });
}

/// Drops triangles without area.
class PartBuilder {
  public:
    std::uint32_t addPosition(const glm::dvec3& p) {
        part_.positions.emplace_back(p);
        return static_cast<std::uint32_t>(part_.positions.size() - 1);
    }
    /// \param source  the sheet's triangle.
    void addTriangle(std::uint32_t source, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const glm::uvec3 t(a, b, c);
        if (hasArea(planeOf(part_.positions, t))) {
            part_.triangles.push_back(t);
            part_.sources.push_back(source);
        }
    }
    /// Below the side from a to b of a triangle seen from above.
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

/// Closes a surface where a region's offset is left out.
struct Fan {
    BorderLoop loop;
    glm::vec3 apex{0.0F};
    std::uint32_t source = 0;
};

/// The triangles of thin regions whose offset is left out: fans close what is left, within the shell's own reach.
/// \param endOf  the offset of a triangle's corner. \param turned  the offset's triangles are wound the other way.
/// \param fans   these fans are appended.
template <class EndOf>
std::vector<bool> fullRegions(const Sheet& sheet, const std::vector<std::uint8_t>& thin, const EndOf& endOf,
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
        std::vector<OddEdge> border;  // as the triangles that stay have it
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
                continue;  // there and back
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

}  // namespace

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

SolidPart thickened(const Sheet& sheet, const MeshQuery& query, double thickness) {
    const std::vector<std::uint32_t> roots = joinedCorners(sheet);
    std::vector<Mitre> mitres(roots.size());
    for (std::uint32_t i = 0; i < sheet.triangles.size(); ++i) {
        const glm::dvec3 normal = unitNormal(sheet.positions, sheet.triangles[i]);
        for (int corner = 0; corner < 3; ++corner) {
            mitres[roots[3 * i + static_cast<std::uint32_t>(corner)]].add(
                normal, angleAt(sheet.positions, sheet.triangles[i], corner));
        }
    }
    std::vector<glm::dvec3> offsets(roots.size());
    for (std::uint32_t i = 0; i < roots.size(); ++i) {
        offsets[i] = roots[i] == i ? 0.5 * thickness * mitres[i].solve() : offsets[roots[i]];
    }
    std::vector<std::array<double, 2>> room(roots.size());  // above and below, by root
    tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(roots.size()), [&](std::uint32_t i) {
        room[i] = roomAtCorner(sheet, query, sheet.triangles[i / 3], static_cast<int>(i % 3), offsets[i]);
    });
    for (std::uint32_t i = 0; i < roots.size(); ++i) {
        for (const std::size_t face : {0U, 1U}) {
            room[roots[i]][face] = std::min(room[roots[i]][face], room[i][face]);
        }
    }
    // By root: an edge there turns over in the offset, which then ends where there is no more room.
    std::vector<std::array<bool, 2>> turns(roots.size());
    for (std::uint32_t i = 0; i < roots.size(); ++i) {
        const std::uint32_t next = i % 3 == 2 ? i - 2 : i + 1;
        const auto at = [&](std::uint32_t k) {
            return glm::dvec3(sheet.positions[sheet.triangles[k / 3][static_cast<int>(k % 3)]]);
        };
        const glm::dvec3 side = at(next) - at(i);
        const double change = dot(side, offsets[next] - offsets[i]);
        for (const std::uint32_t k : {i, next}) {
            turns[roots[k]][0] = turns[roots[k]][0] || dot(side, side) + change < 0.0;
            turns[roots[k]][1] = turns[roots[k]][1] || dot(side, side) - change < 0.0;
        }
    }
    PartBuilder builder;
    std::vector<std::array<std::uint32_t, 2>> ends(roots.size());  // above and below, by root
    for (std::uint32_t i = 0; i < roots.size(); ++i) {
        if (roots[i] == i) {
            const glm::dvec3 at = sheet.positions[sheet.triangles[i / 3][static_cast<int>(i % 3)]];
            const auto reach = [&](std::size_t face) {
                return turns[i][face] ? std::min(1.0, kThinReach * room[i][face]) : 1.0;
            };
            ends[i] = {builder.addPosition(at + reach(0) * offsets[i]),
                       builder.addPosition(at - reach(1) * offsets[i])};
        }
    }
    const auto endsOf = [&](std::uint32_t triangle, std::uint32_t corner) {
        return ends[roots[3 * triangle + corner]];
    };
    std::vector<Fan> fans;
    for (const std::size_t face : {0U, 1U}) {
        const auto endOf = [&](std::uint32_t i, std::uint32_t corner) { return endsOf(i, corner)[face]; };
        // All of its corners are thin, or its middle is and its offset turns over.
        const auto isThin = [&](std::uint32_t i) {
            const glm::uvec3& t = sheet.triangles[i];
            bool corners = true;
            bool turned = false;
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t next = (k + 1) % 3;
                const glm::dvec3 from = sheet.positions[t[static_cast<int>(k)]];
                const glm::dvec3 to = sheet.positions[t[static_cast<int>(next)]];
                corners = corners && room[roots[3 * i + k]][face] < 2.0;
                turned = turned || dot(to - from, builder.at(endOf(i, next)) - builder.at(endOf(i, k))) < 0.0;
            }
            return corners ||
                   (turned &&
                    roomAt(sheet, query, middleOf(sheet, t), 0.5 * thickness * unitNormal(sheet.positions, t),
                           [&](const glm::uvec3& other) { return other == t; })[face] < 2.0);
        };
        std::vector<std::uint8_t> thin(sheet.triangles.size());
        tbb::parallel_for(std::uint32_t{0}, static_cast<std::uint32_t>(thin.size()),
                          [&](std::uint32_t i) { thin[i] = isThin(i) ? 1 : 0; });
        const std::vector<bool> full =
            fullRegions(sheet, thin, endOf, face == 1, builder, query, thickness, fans);
        for (std::uint32_t i = 0; i < sheet.triangles.size(); ++i) {
            if (!full[i]) {
                builder.addTriangle(i, endOf(i, 0), endOf(i, face == 0 ? 1 : 2), endOf(i, face == 0 ? 2 : 1));
            }
        }
    }
    builder.endSurface();
    for (const Fan& fan : fans) {
        const std::uint32_t apex = builder.addPosition(fan.apex);
        for (const BorderStep& step : fan.loop) {
            builder.addTriangle(fan.source, step.against ? step.to : step.from,
                                step.against ? step.from : step.to, apex);
        }
    }
    for (std::uint32_t i = 0; i < sheet.triangles.size(); ++i) {
        for (std::uint32_t side = 0; side < 3; ++side) {
            if (sheet.neighbours[i][static_cast<int>(side)] == Sheet::kNoTriangle) {
                builder.addWall(i, endsOf(i, side), endsOf(i, (side + 1) % 3));
            }
        }
    }
    return builder.take();
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
    // Upwards, however the sheet is wound.
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
