#include "bake/shape/sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>
#include <utility>

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
    void endSurface() { part_.surface_triangles = part_.triangles.size(); }
    SolidPart take() { return std::move(part_); }

  private:
    SolidPart part_;
};

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

SolidPart thickened(const Sheet& sheet, double thickness) {
    const std::vector<std::uint32_t> roots = joinedCorners(sheet);
    std::vector<Mitre> mitres(roots.size());
    for (std::uint32_t i = 0; i < sheet.triangles.size(); ++i) {
        const glm::dvec3 normal = unitNormal(sheet.positions, sheet.triangles[i]);
        for (int corner = 0; corner < 3; ++corner) {
            mitres[roots[3 * i + static_cast<std::uint32_t>(corner)]].add(
                normal, angleAt(sheet.positions, sheet.triangles[i], corner));
        }
    }
    PartBuilder builder;
    std::vector<std::array<std::uint32_t, 2>> ends(roots.size());  // above and below, by root
    for (std::uint32_t i = 0; i < roots.size(); ++i) {
        if (roots[i] == i) {
            const glm::dvec3 at = sheet.positions[sheet.triangles[i / 3][static_cast<int>(i % 3)]];
            const glm::dvec3 offset = 0.5 * thickness * mitres[i].solve();
            ends[i] = {builder.addPosition(at + offset), builder.addPosition(at - offset)};
        }
    }
    const auto endsOf = [&](std::uint32_t triangle, std::uint32_t corner) {
        return ends[roots[3 * triangle + corner]];
    };
    for (std::uint32_t i = 0; i < sheet.triangles.size(); ++i) {
        const auto [a, b, c] = std::array{endsOf(i, 0), endsOf(i, 1), endsOf(i, 2)};
        builder.addTriangle(i, a[0], b[0], c[0]);
        builder.addTriangle(i, a[1], c[1], b[1]);
    }
    builder.endSurface();
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
