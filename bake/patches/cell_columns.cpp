#include "bake/patches/cell_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace relief {
namespace {

/// Lines stand beside the middle of their squares by an odd share, since models are built on even ones.
constexpr double kBeside = 0.0371;
/// Of more triangles the tree tells sooner that none is crossed.
constexpr std::size_t kManyTriangles = 32;

using Polygon = std::array<glm::dvec3, 9>;

/// Keeps the part of a polygon with sign · p[axis] ≤ sign · limit.
unsigned clip(Polygon& polygon, unsigned count, int axis, double sign, double limit) {
    Polygon kept;
    unsigned kept_count = 0;
    for (unsigned i = 0; i < count; ++i) {
        const glm::dvec3& a = polygon[i];
        const glm::dvec3& b = polygon[i + 1 == count ? 0 : i + 1];
        const double over_a = sign * (a[axis] - limit);
        const double over_b = sign * (b[axis] - limit);
        if (over_a <= 0.0) {
            kept[kept_count++] = a;
        }
        if ((over_a < 0.0 && over_b > 0.0) || (over_a > 0.0 && over_b < 0.0)) {
            kept[kept_count++] = a + (over_a / (over_a - over_b)) * (b - a);
        }
    }
    polygon = kept;
    return kept_count;
}

/// Twice the area of (p, a, b), where a and b are relative to p: exactly negative when they are swapped, so that two triangles
/// agree about the edge that they share.
double edge(const glm::dvec3& a, const glm::dvec3& b) {
    return a.x * b.y - a.y * b.x;
}

/// Of the two triangles at an edge through p, one owns p.
bool owns(const glm::dvec3& a, const glm::dvec3& b) {
    const double e = edge(a, b);
    return e > 0.0 || (e == 0.0 && (b.y > a.y || (b.y == a.y && b.x < a.x)));
}

/// Counts the triangles that a segment crosses.
class Path {
  public:
    Path(const MeshQuery& query, const MeshCell& cell) : query_(query), cell_(cell) {}

    void go(const glm::dvec3& from, const glm::dvec3& to, BodyCounter& counter) const {
        if (cell_.triangles.size() > kManyTriangles &&
            query_.segmentIsFree(cell_.low + cell_.size * from, cell_.low + cell_.size * to)) {
            return;
        }
        const glm::dvec3 way = to - from;
        const glm::dvec3 low = glm::min(from, to);
        const glm::dvec3 high = glm::max(from, to);
        for (const std::uint32_t triangle : cell_.triangles) {
            const std::array<glm::dvec3, 3> p = cell_.inUnit(query_.mesh(), triangle);
            if (glm::any(glm::greaterThan(low, glm::max(glm::max(p[0], p[1]), p[2]))) ||
                glm::any(glm::lessThan(high, glm::min(glm::min(p[0], p[1]), p[2])))) {
                continue;
            }
            const glm::dvec3 normal = cross(p[1] - p[0], p[2] - p[0]);
            const double before = dot(normal, from - p[0]);
            const double after = dot(normal, to - p[0]);
            if ((before < 0.0) == (after < 0.0)) {
                continue;
            }
            // Within the triangle: the line passes all edges on one side.
            const auto past = [&](const glm::dvec3& a, const glm::dvec3& b) {
                return dot(way, cross(a - from, b - from));
            };
            const double e[3] = {past(p[0], p[1]), past(p[1], p[2]), past(p[2], p[0])};
            if ((e[0] >= 0.0 && e[1] >= 0.0 && e[2] >= 0.0) || (e[0] <= 0.0 && e[1] <= 0.0 && e[2] <= 0.0)) {
                counter.cross(query_.bodyOf(triangle), before < 0.0 ? 1 : -1);
            }
        }
    }

  private:
    const MeshQuery& query_;
    const MeshCell& cell_;
};

/// The point of the cube at (u, v, w), and how it moves with each.
struct CubeAxes {
    glm::dvec3 origin;
    glm::dvec3 u;
    glm::dvec3 v;
    glm::dvec3 w;

    explicit CubeAxes(const PatchFrame& frame) {
        // The inverse of across(), from where it takes four points.
        const glm::dvec3 zero = frame.across(glm::dvec3(0.0));
        const glm::dmat3 across(frame.across(glm::dvec3(1, 0, 0)) - zero,
                                frame.across(glm::dvec3(0, 1, 0)) - zero,
                                frame.across(glm::dvec3(0, 0, 1)) - zero);
        const glm::dmat3 back = glm::inverse(across);
        u = back[0];
        v = back[1];
        w = back[2];
        origin = -(back * zero);
    }
    [[nodiscard]] glm::dvec3 at(double a, double b, double c) const { return origin + a * u + b * v + c * w; }
    [[nodiscard]] double handedness() const { return dot(cross(u, v), w) < 0.0 ? -1.0 : 1.0; }
};

}  // namespace

ClippedTriangle clipToUnitCube(const std::array<glm::dvec3, 3>& corners) {
    ClippedTriangle clipped;
    const glm::dvec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
    if (normal == glm::dvec3(0.0)) {
        return clipped;
    }
    clipped.normal = unit(normal);
    Polygon polygon;
    std::copy(corners.begin(), corners.end(), polygon.begin());
    unsigned count = 3;
    for (int axis = 0; axis < 3 && count > 2; ++axis) {
        count = clip(polygon, count, axis, 1.0, 1.0);
        count = count > 2 ? clip(polygon, count, axis, -1.0, 0.0) : 0;
    }
    for (unsigned i = 2; i < count; ++i) {
        const double area =
            0.5 * dot(clipped.normal, cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]));
        clipped.area += area;
        clipped.center += (area / 3.0) * (polygon[0] + polygon[i - 1] + polygon[i]);
    }
    if (!(clipped.area > 0.0)) {
        return {};
    }
    clipped.center /= clipped.area;
    return clipped;
}

double CellColumn::insideLength() const {
    double length = 0.0;
    double from = enters;
    bool in = inside;
    for (const double turn : turns) {
        length += in ? turn - from : 0.0;
        from = turn;
        in = !in;
    }
    return length + (in ? leaves - from : 0.0);
}

double CellColumn::wrongAt(double height, bool outside_below) const {
    const double middle = std::clamp(height, enters, leaves);
    double wrong = 0.0;
    double from = enters;
    bool in = inside;
    const auto add = [&](double to) {
        const double below = std::max(0.0, std::min(to, middle) - from);
        const double above = std::max(0.0, to - std::max(from, middle));
        // Below should be inside, above outside, or the other way round.
        wrong += in != outside_below ? above : below;
        from = to;
        in = !in;
    };
    for (const double turn : turns) {
        add(turn);
    }
    add(leaves);
    return wrong;
}

CellColumns::CellColumns(const MeshQuery& query, const MeshCell& cell, const PatchFrame& frame,
                         unsigned across) {
    const CubeAxes axes(frame);
    volume_per_length_ =
        std::abs(dot(cross(axes.u, axes.v), axes.w)) / (static_cast<double>(across) * across);
    std::vector<std::uint32_t> column_of(std::size_t{across} * across, UINT32_MAX);
    const auto lineAt = [&](unsigned i) { return (i + 0.5 + kBeside) / across; };
    for (unsigned j = 0; j < across; ++j) {
        for (unsigned i = 0; i < across; ++i) {
            CellColumn column;
            column.u = lineAt(i);
            column.v = lineAt(j);
            column.enters = -std::numeric_limits<double>::infinity();
            column.leaves = std::numeric_limits<double>::infinity();
            const glm::dvec3 start = axes.at(column.u, column.v, 0.0);
            bool misses = false;
            for (int axis = 0; axis < 3; ++axis) {
                if (std::abs(axes.w[axis]) < 1e-9) {
                    misses = misses || start[axis] <= 0.0 || start[axis] >= 1.0;
                    continue;
                }
                const double a = -start[axis] / axes.w[axis];
                const double b = (1.0 - start[axis]) / axes.w[axis];
                column.enters = std::max(column.enters, std::min(a, b));
                column.leaves = std::min(column.leaves, std::max(a, b));
            }
            if (!misses && column.leaves - column.enters > 1e-6) {
                column_of[std::size_t{j} * across + i] = static_cast<std::uint32_t>(columns_.size());
                columns_.push_back(column);
            }
        }
    }

    struct Hit {
        std::uint32_t column;
        double w;
        std::uint32_t triangle;
        int side;
        auto operator<=>(const Hit&) const = default;
    };
    std::vector<Hit> hits;
    for (const std::uint32_t triangle : cell.triangles) {
        std::array<glm::dvec3, 3> p = cell.inUnit(query.mesh(), triangle);
        for (glm::dvec3& corner : p) {
            corner = frame.across(corner);
        }
        const double area = edge(p[1] - p[0], p[2] - p[0]);
        if (area == 0.0) {
            continue;
        }
        const int side = (area > 0.0) == (axes.handedness() > 0.0) ? 1 : -1;
        if (area < 0.0) {
            std::swap(p[1], p[2]);
        }
        const glm::dvec3 low = glm::min(glm::min(p[0], p[1]), p[2]);
        const glm::dvec3 high = glm::max(glm::max(p[0], p[1]), p[2]);
        const auto first = [&](double at) {
            return static_cast<unsigned>(
                std::clamp(std::floor(at * across - 0.5 - kBeside), 0.0, across - 1.0));
        };
        for (unsigned j = first(low.y); j <= first(high.y + 1.0 / across); ++j) {
            for (unsigned i = first(low.x); i <= first(high.x + 1.0 / across); ++i) {
                const std::uint32_t column = column_of[std::size_t{j} * across + i];
                if (column == UINT32_MAX) {
                    continue;
                }
                const glm::dvec3 at(columns_[column].u, columns_[column].v, 0.0);
                const glm::dvec3 a = p[0] - at;
                const glm::dvec3 b = p[1] - at;
                const glm::dvec3 c = p[2] - at;
                if (!owns(a, b) || !owns(b, c) || !owns(c, a)) {
                    continue;
                }
                const double shares[3] = {edge(b, c), edge(c, a), edge(a, b)};
                const double w = (shares[0] * a.z + shares[1] * b.z + shares[2] * c.z) /
                                 (shares[0] + shares[1] + shares[2]);
                if (w > columns_[column].enters && w < columns_[column].leaves) {
                    hits.push_back({column, w, triangle, side});
                }
            }
        }
    }
    std::ranges::sort(hits);

    turns_.reserve(hits.size());
    const Path path(query, cell);
    BodyCounter counter = cell.bodies;
    glm::dvec3 before = cell.known;
    std::size_t next = 0;
    std::vector<std::size_t> first_turn;
    for (std::uint32_t i = 0; i < columns_.size(); ++i) {
        CellColumn& column = columns_[i];
        const glm::dvec3 start =
            axes.at(column.u, column.v, column.enters + 1e-9 * (column.leaves - column.enters));
        path.go(before, start, counter);
        before = start;
        column.inside = counter.inside();
        first_turn.push_back(turns_.size());
        BodyCounter along = counter;
        bool in = column.inside;
        for (; next < hits.size() && hits[next].column == i; ++next) {
            along.cross(query.bodyOf(hits[next].triangle), hits[next].side);
            if (along.inside() != in) {
                in = !in;
                turns_.push_back(hits[next].w);
            }
        }
    }
    first_turn.push_back(turns_.size());
    for (std::size_t i = 0; i < columns_.size(); ++i) {
        columns_[i].turns = std::span(turns_).subspan(first_turn[i], first_turn[i + 1] - first_turn[i]);
    }
}

MeshCell childOf(const MeshQuery& query, const MeshCell& cell, unsigned octant) {
    MeshCell child;
    child.size = 0.5 * cell.size;
    const glm::dvec3 corner = 0.5 * glm::dvec3(octant & 1U, octant >> 1U & 1U, octant >> 2U);
    child.low = cell.low + cell.size * corner;
    for (const std::uint32_t triangle : cell.triangles) {
        if (meetsUnitCube(child.inUnit(query.mesh(), triangle))) {
            child.triangles.push_back(triangle);
        }
    }
    child.bodies = cell.bodies;
    Path(query, cell).go(cell.known, corner + 0.5 * child.known, child.bodies);
    return child;
}

bool meetsUnitCube(const std::array<glm::dvec3, 3>& corners) {
    const glm::dvec3 low = glm::min(glm::min(corners[0], corners[1]), corners[2]);
    const glm::dvec3 high = glm::max(glm::max(corners[0], corners[1]), corners[2]);
    if (glm::any(glm::greaterThanEqual(low, glm::dvec3(1.0))) ||
        glm::any(glm::lessThanEqual(high, glm::dvec3(0.0)))) {
        return false;
    }
    return (glm::all(glm::greaterThanEqual(low, glm::dvec3(0.0))) &&
            glm::all(glm::lessThanEqual(high, glm::dvec3(1.0)))) ||
           clipToUnitCube(corners).area > 0.0;
}

}  // namespace relief
