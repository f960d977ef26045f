// SPDX-License-Identifier: Apache-2.0
#include "bake/patches/cell_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <tuple>
#include <utility>

namespace relief {
namespace {

/// Tolerance for a position between two lines, in line spacings.
constexpr double kRounding = 1e-9;
/// With more triangles than this, the ray query is faster at finding that none is crossed.
constexpr std::size_t kTreeTriangles = 32;

using Polygon = std::array<glm::dvec3, 9>;

/// Keeps the part of a polygon with sign · p[axis] ≤ sign · limit.
unsigned clip(Polygon& polygon, unsigned count, int axis, double sign, double limit) {
    bool all = true;
    for (unsigned i = 0; i < count; ++i) {
        all = all && sign * (polygon[i][axis] - limit) <= 0.0;
    }
    if (all) {
        return count;
    }
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

/// Counts the triangles of a cell that a segment in its unit cube crosses.
class Path {
  public:
    Path(const MeshQuery& query, const MeshCell& cell, std::span<const UnitTriangle> triangles)
        : query_(query), cell_(cell), triangles_(triangles) {}

    /// A triangle of the cell with its bounds and an unnormalized normal.
    struct Crossed {
        std::uint32_t index;
        glm::dvec3 low;
        glm::dvec3 high;
        glm::dvec3 normal;
    };
    [[nodiscard]] Crossed crossed(std::uint32_t index) const {
        const auto& [a, b, c] = triangles_[index];
        return {index, glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c), cross(b - a, c - a)};
    }

    void countCrossings(const glm::dvec3& from, const glm::dvec3& to, BodyCounter& counter) const {
        if (triangles_.size() > kTreeTriangles &&
            query_.isSegmentFree(cell_.low + cell_.size * from, cell_.low + cell_.size * to)) {
            return;
        }
        for (std::uint32_t i = 0; i < triangles_.size(); ++i) {
            if (const int side = sideCrossed(crossed(i), from, to); side != 0) {
                counter.cross(bodyOf(i), side);
            }
        }
    }

    /// Returns the side for BodyCounter::cross, or 0 if the segment does not cross the triangle.
    [[nodiscard]] int sideCrossed(const Crossed& one, const glm::dvec3& from, const glm::dvec3& to) const {
        const UnitTriangle& p = triangles_[one.index];
        const double before = dot(one.normal, from - p[0]);
        const double after = dot(one.normal, to - p[0]);
        if ((before < 0.0) == (after < 0.0)) {
            return 0;
        }
        for (int axis = 0; axis < 3; ++axis) {
            if ((from[axis] < one.low[axis] && to[axis] < one.low[axis]) ||
                (from[axis] > one.high[axis] && to[axis] > one.high[axis])) {
                return 0;
            }
        }
        // Within the triangle: the line passes all edges on the same side.
        const glm::dvec3 way = to - from;
        const auto past = [&](const glm::dvec3& a, const glm::dvec3& b) {
            return dot(way, cross(a - from, b - from));
        };
        const double e[3] = {past(p[0], p[1]), past(p[1], p[2]), past(p[2], p[0])};
        const bool within =
            (e[0] >= 0.0 && e[1] >= 0.0 && e[2] >= 0.0) || (e[0] <= 0.0 && e[1] <= 0.0 && e[2] <= 0.0);
        return !within ? 0 : before < 0.0 ? 1 : -1;
    }

    [[nodiscard]] std::uint32_t bodyOf(std::uint32_t index) const {
        return query_.bodyOf(cell_.triangles[index]);
    }

  private:
    const MeshQuery& query_;
    const MeshCell& cell_;
    std::span<const UnitTriangle> triangles_;
};

/// An intersection of a line with a triangle.
struct Hit {
    double w;
    std::uint32_t triangle;
    int side;            // for BodyCounter::cross
    std::uint32_t next;  // next hit of the same line

    [[nodiscard]] bool operator<(const Hit& other) const {
        return std::tie(w, triangle, side) < std::tie(other.w, other.triangle, other.side);
    }
};

/// An intersection of the path to a start with a triangle.
struct Crossing {
    std::size_t start;
    std::uint32_t body;
    int side;  // for BodyCounter::cross
};

/// An edge of a triangle over the grid of lines. It always runs upwards, so that both adjacent triangles get the same
/// result.
struct GridEdge {
    double begin;  // first row
    double end;    // past the last row
    double x;
    double x_by_row;
    double low;  // range of x
    double high;

    GridEdge(glm::dvec3 a, glm::dvec3 b) {
        if (std::tie(b.y, b.x) < std::tie(a.y, a.x)) {
            std::swap(a, b);
        }
        begin = a.y;
        end = b.y;
        x = a.x;
        low = std::min(a.x, b.x);
        high = std::max(a.x, b.x);
        x_by_row = b.y > a.y ? (b.x - a.x) / (b.y - a.y) : 0.0;
    }
    [[nodiscard]] bool meets(double row) const { return begin <= row && row < end; }
    [[nodiscard]] double at(double row) const { return std::clamp(x + (row - begin) * x_by_row, low, high); }
};

/// Returns the first integer ≥ `at`, within [0, size].
int firstFrom(double at, int size) {
    if (!(at > 0.0)) {
        return 0;
    }
    const int whole = static_cast<int>(std::min<double>(at, size));
    return whole + (whole < size && whole < at ? 1 : 0);
}

constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// All hits of a cell, as a linked list per line.
struct Hits {
    std::vector<Hit> hits;
    std::vector<std::uint32_t> last;  // last hit of each line, or kNone

    void clear(std::size_t lines) {
        hits.clear();
        last.assign(lines, kNone);
    }
    void add(std::uint32_t line, std::uint32_t triangle, double w, int side) {
        // Assign members individually: a copy of the whole struct would stall on store forwarding.
        Hit& hit = hits.emplace_back();
        hit.w = w;
        hit.triangle = triangle;
        hit.side = side;
        hit.next = last[line];
        last[line] = static_cast<std::uint32_t>(hits.size() - 1);
    }
    /// The hits of a line in ascending order. \param room  buffer, used if there are several.
    [[nodiscard]] std::span<const Hit> along(std::uint32_t line, std::vector<Hit>& room) const {
        std::uint32_t at = last[line];
        if (at == kNone) {
            return {};
        }
        if (hits[at].next == kNone) {
            return {&hits[at], 1};
        }
        room.clear();
        for (; at != kNone; at = hits[at].next) {
            room.push_back(hits[at]);
        }
        std::ranges::sort(room, std::less());
        return room;
    }
};

/// \param triangle  in grid coordinates: lines are at integer x and y; z is their w.
void addHits(const UnitTriangle& triangle, std::uint32_t index, const LineGrid& grid, Hits& hits) {
    const auto& [a, b, c] = triangle;
    const auto size = static_cast<int>(grid.across());
    const auto [first, last] = std::minmax({a.y, b.y, c.y});
    const int first_row = firstFrom(first, size);
    const int end_row = firstFrom(last, size);
    const auto [leftmost, rightmost] = std::minmax({a.x, b.x, c.x});
    if (first_row == end_row || firstFrom(leftmost, size) == firstFrom(rightmost, size)) {
        return;  // small triangles often lie between the lines
    }
    const glm::dvec3 normal = cross(b - a, c - a);
    if (normal.z == 0.0) {
        return;
    }
    const auto [lowest, highest] = std::minmax({a.z, b.z, c.z});
    const GridEdge edges[3] = {{a, b}, {b, c}, {c, a}};
    const int side = (normal.z > 0.0) == (grid.handedness() > 0) ? 1 : -1;
    const glm::dvec2 slope = glm::dvec2(normal) / -normal.z;
    for (int row = first_row; row < end_row; ++row) {
        double left = std::numeric_limits<double>::infinity();
        double right = -left;
        for (const GridEdge& edge : edges) {
            if (edge.meets(row)) {
                left = std::min(left, edge.at(row));
                right = std::max(right, edge.at(row));
            }
        }
        const int end = firstFrom(right, size);
        for (int x = firstFrom(left, size); x < end; ++x) {
            const double w = std::clamp(a.z + slope.x * (x - a.x) + slope.y * (row - a.y), lowest, highest);
            const std::uint32_t line = grid.lineAt(static_cast<unsigned>(x), static_cast<unsigned>(row));
            if (w > grid.lines()[line].enters && w < grid.lines()[line].leaves) {
                hits.add(line, index, w, side);
            }
        }
    }
}

}  // namespace

UnitTriangle MeshCell::inUnit(const TriangleMesh& mesh, std::uint32_t triangle) const {
    UnitTriangle unit;
    const auto corners = cornersOf(mesh, triangle);
    for (std::size_t i = 0; i < 3; ++i) {
        unit[i] = (glm::dvec3(corners[i]) - low) / size;
    }
    return unit;
}

std::vector<UnitTriangle> unitTriangles(const TriangleMesh& mesh, const MeshCell& cell) {
    std::vector<UnitTriangle> unit;
    unit.reserve(cell.triangles.size());
    for (const std::uint32_t triangle : cell.triangles) {
        unit.push_back(cell.inUnit(mesh, triangle));
    }
    return unit;
}

ClippedTriangle clipToUnitCube(const UnitTriangle& triangle, ClippedPolygon* kept) {
    ClippedTriangle clipped;
    const glm::dvec3 normal = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
    if (normal == glm::dvec3(0.0)) {
        return clipped;
    }
    clipped.normal = unit(normal);
    Polygon polygon;
    std::copy(triangle.begin(), triangle.end(), polygon.begin());
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
    if (kept != nullptr) {
        std::copy_n(polygon.begin(), count, kept->corners.begin());
        kept->count = count;
    }
    return clipped;
}

CellPlane meanPlane(std::span<const ClippedTriangle> pieces) {
    glm::dvec3 normal(0.0);
    glm::dvec3 center(0.0);
    double area = 0.0;
    for (const ClippedTriangle& piece : pieces) {
        normal += piece.area * piece.normal;
        center += piece.area * piece.center;
        area += piece.area;
    }
    if (!(area > 0.0)) {
        return {};
    }
    normal = length(normal) > 1e-9 * area ? unit(normal) : glm::dvec3(0.0, 1.0, 0.0);
    return {normal, dot(normal, 0.5 - center / area)};
}

glm::dvec3 meanNormalAlong(std::span<const ClippedTriangle> pieces, const glm::dvec3& along) {
    glm::dvec3 normal(0.0);
    for (const ClippedTriangle& piece : pieces) {
        normal += (dot(piece.normal, along) < 0.0 ? -piece.area : piece.area) * piece.normal;
    }
    return dot(normal, along) > 0.0 ? unit(normal) : unit(along);
}

bool meetsUnitCube(const UnitTriangle& triangle) {
    bool contained = true;
    for (int axis = 0; axis < 3; ++axis) {
        const auto [low, high] = std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
        if (low >= 1.0 || high <= 0.0) {
            return false;
        }
        contained = contained && low >= 0.0 && high <= 1.0;
    }
    return contained || clipToUnitCube(triangle).area > 0.0;
}

std::array<MeshCell, 8> childrenOf(const MeshQuery& query, const MeshCell& cell,
                                   std::span<const UnitTriangle> triangles) {
    std::array<MeshCell, 8> children;
    const Path path(query, cell, triangles);
    const auto cornerOf = [](unsigned octant) {
        return 0.5 * glm::dvec3(octant & 1U, octant >> 1U & 1U, octant >> 2U);
    };
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const UnitTriangle& p = triangles[i];
        const glm::dvec3 low = glm::min(glm::min(p[0], p[1]), p[2]);
        const glm::dvec3 high = glm::max(glm::max(p[0], p[1]), p[2]);
        for (unsigned octant = 0; octant < 8; ++octant) {
            const glm::dvec3 corner = cornerOf(octant);
            if (glm::any(glm::greaterThanEqual(low, corner + 0.5)) ||
                glm::any(glm::lessThanEqual(high, corner))) {
                continue;
            }
            if (meetsUnitCube({2.0 * (p[0] - corner), 2.0 * (p[1] - corner), 2.0 * (p[2] - corner)})) {
                children[octant].triangles.push_back(cell.triangles[i]);
            }
        }
    }
    for (unsigned octant = 0; octant < 8; ++octant) {
        MeshCell& child = children[octant];
        const glm::dvec3 corner = cornerOf(octant);
        child.size = 0.5 * cell.size;
        child.low = cell.low + cell.size * corner;
        child.bodies = cell.bodies;
        path.countCrossings(MeshCell::kKnown, corner + 0.5 * MeshCell::kKnown, child.bodies);
    }
    return children;
}

CubeAxes::CubeAxes(const PatchFrame& frame) {
    // across() is affine; four points define it.
    const glm::dvec3 zero = frame.across(glm::dvec3(0.0));
    by = glm::inverse(glm::dmat3(frame.across(glm::dvec3(1, 0, 0)) - zero,
                                 frame.across(glm::dvec3(0, 1, 0)) - zero,
                                 frame.across(glm::dvec3(0, 0, 1)) - zero));
    origin = -(by * zero);
}

LineGrid::LineGrid(const PatchFrame& frame, unsigned across)
    : frame_(frame), across_(across), lines_(std::size_t{across} * across) {
    const CubeAxes axes(frame);
    along_ = axes.by[2];
    const double volume = dot(cross(axes.by[0], axes.by[1]), along_);
    volume_per_length_ = std::abs(volume) / (static_cast<double>(across) * across);
    handedness_ = volume < 0.0 ? -1 : 1;
    for (unsigned column = 0; column < across; ++column) {
        const unsigned quarter = across / 4;
        in_row_.push_back(4 * (column % quarter) + column / quarter);
    }
    const auto place = [&](unsigned i) { return (i + kOffset) / across_; };
    const auto span = [&](const glm::dvec3& start) {
        Line line{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(along_[axis]) < 1e-9) {
                if (start[axis] <= 0.0 || start[axis] >= 1.0) {
                    return Line();
                }
                continue;
            }
            const double a = -start[axis] / along_[axis];
            const double b = (1.0 - start[axis]) / along_[axis];
            line.enters = std::max(line.enters, std::min(a, b));
            line.leaves = std::min(line.leaves, std::max(a, b));
        }
        return line.leaves - line.enters > 1e-6 ? line : Line();
    };
    for (unsigned row = 0; row < across; ++row) {
        row_starts_.push_back(starts_.size());
        for (unsigned step = 0; step < across; ++step) {
            const unsigned column = row % 2 == 0 ? step : across - 1 - step;
            const std::uint32_t index = lineAt(column, row);
            Line& line = lines_[index];
            line = span(axes.at(place(column), place(row), 0.0));
            if (!line.misses()) {
                const double within = line.enters + 1e-9 * (line.leaves - line.enters);
                starts_.push_back({index, column, axes.at(place(column), place(row), within)});
            }
        }
    }
    row_starts_.push_back(starts_.size());
    for (const Line& line : lines_) {
        enters_.push_back(static_cast<float>(line.enters));
        leaves_.push_back(static_cast<float>(line.leaves));
        lengths_.push_back(line.leaves - line.enters);
    }
    // Sums in the same order as PatchFitter, so that a cell that is entirely inside has a volume of exactly zero
    // outside.
    std::array<double, 4> sums{};
    for (std::size_t i = 0; i < lengths_.size(); ++i) {
        sums[i % 4] += lengths_[i];
    }
    volume_ = ((sums[0] + sums[1]) + (sums[2] + sums[3])) * volume_per_length_;
    start_reach_ = 1e-6;
    if (frame.diagonal != 0) {  // the path from one side to the next leaves both
        for (std::size_t i = 1; i < starts_.size(); ++i) {
            start_reach_ = std::max(start_reach_, length(starts_[i].point - starts_[i - 1].point));
        }
    }
}

template <class Visit>
void LineGrid::forEachSegmentNear(const UnitTriangle& over, const Visit& visit) const {
    const auto size = static_cast<int>(across_);
    const auto [low, high] = std::minmax({over[0].y, over[1].y, over[2].y});
    const auto [left, right] = std::minmax({over[0].x, over[1].x, over[2].x});
    const auto column = [&](double at) { return static_cast<int>(std::clamp<double>(at, -1.0, size)); };
    const int from = column(std::ceil(left - kRounding));
    const int to = column(std::floor(right + kRounding));
    const auto visitSegment = [&](std::size_t start) {
        if (start > 0 && start < starts_.size()) {
            visit(start);
        }
    };
    const int end_row = firstFrom(std::floor(high) + 1.0, size);
    for (int row = firstFrom(low, size); row < end_row; ++row) {
        const std::size_t first = row_starts_[row];
        const auto count = static_cast<int>(row_starts_[row + 1] - first);
        if (count == 0) {
            continue;
        }
        visitSegment(first);
        const auto begin = static_cast<int>(starts_[first].column);
        const auto [least, most] =
            row % 2 == 0 ? std::pair(from - begin, to + 1 - begin) : std::pair(begin - to, begin + 1 - from);
        for (int i = std::max(least, 1); i <= std::min(most, count - 1); ++i) {
            visit(first + i);
        }
    }
    visitSegment(row_starts_[end_row]);
}

bool LineGrid::nearStarts(const UnitTriangle& triangle) const {
    for (int axis = 0; axis < 3; ++axis) {
        const auto [low, high] = std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
        if ((along_[axis] > 1e-9 && low <= start_reach_) ||
            (along_[axis] < -1e-9 && 1.0 - high <= start_reach_)) {
            return true;
        }
    }
    return false;
}

double LineGrid::expectedHits(const ClippedTriangle& piece) const {
    return piece.area * std::abs(dot(piece.normal, along_)) / volume_per_length_;
}

double CellColumn::wrongAt(double height, bool outside_below, const ErrorCosts& costs) const {
    const double middle = std::clamp(height, enters, leaves);
    const double below = insideTo(middle);
    const double above = insideTo(leaves) - below;
    return outside_below ? costs.false_outside * below + costs.false_inside * (leaves - middle - above)
                         : costs.false_inside * (middle - enters - below) + costs.false_outside * above;
}

CellColumns::CellColumns(const MeshQuery& query, const MeshCell& cell,
                         std::span<const UnitTriangle> triangles, const LineGrid& grid)
    : grid_(grid), columns_(grid.lines().size()), inside_(grid.lines().size(), 0.0F) {
    // Reused for all cells, because each takes only a few microseconds.
    thread_local Hits hits;
    thread_local std::vector<Crossing> crossings;
    thread_local std::vector<Hit> room;
    hits.clear(columns_.size());
    crossings.clear();
    bool wound = cell.bodies.odd.empty();  // only body 0 may contain kKnown
    const Path path(query, cell, triangles);
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
        UnitTriangle over = triangles[i];
        for (glm::dvec3& corner : over) {
            corner = grid.frame().across(corner);
            corner.x = corner.x * grid.across() - LineGrid::kOffset;
            corner.y = corner.y * grid.across() - LineGrid::kOffset;
        }
        if (grid.nearStarts(triangles[i])) {
            const Path::Crossed crossed = path.crossed(i);
            grid.forEachSegmentNear(over, [&](std::size_t start) {
                const int side =
                    path.sideCrossed(crossed, grid.starts()[start - 1].point, grid.starts()[start].point);
                if (side != 0) {
                    crossings.push_back({start, path.bodyOf(i), side});
                }
            });
        }
        addHits(over, cell.triangles[i], grid, hits);
        wound = wound && path.bodyOf(i) == 0;
    }
    std::ranges::sort(crossings, std::less(), &Crossing::start);
    for (const Hit& hit : hits.hits) {
        ++hits_[hit.side > 0 ? 1 : 0];
    }
    turns_.reserve(hits.hits.size());
    const bool no_voids = query.awayFromVoids(cell.low, cell.low + cell.size);
    BodyCounter counter = cell.bodies;
    path.countCrossings(MeshCell::kKnown, grid.starts().front().point, counter);
    bool enters_inside = counter.inside();
    auto crossing = crossings.begin();
    for (std::size_t i = 0; i < grid.starts().size(); ++i) {
        const std::uint32_t line = grid.starts()[i].line;
        if (crossing != crossings.end() && crossing->start == i) {
            for (; crossing != crossings.end() && crossing->start == i; ++crossing) {
                counter.cross(crossing->body, crossing->side);
            }
            enters_inside = counter.inside();
        }
        inside_[line] = enters_inside ? 1.0F : 0.0F;
        const std::span<const Hit> along = hits.along(line, room);
        if (along.empty() && no_voids) {
            continue;
        }
        const auto first = static_cast<std::uint32_t>(turns_.size());
        bool in = enters_inside;
        const auto turnWhere = [&](bool inside, double w) {
            if (inside != in) {
                in = inside;
                turns_.push_back(w);
            }
        };
        if (wound) {
            int winding = counter.winding;
            for (const Hit& hit : along) {
                winding += hit.side;
                turnWhere(winding != 0, hit.w);
            }
        } else {
            BodyCounter bodies = counter;
            for (const Hit& hit : along) {
                bodies.cross(query.bodyOf(hit.triangle), hit.side);
                turnWhere(bodies.inside(), hit.w);
            }
        }
        if (!no_voids) {
            fillVoids(query, cell, grid.starts()[i], first);
        }
        if (turns_.size() > first) {
            columns_[line] = {first, static_cast<std::uint32_t>(turns_.size()) - first};
            turning_.push_back(line);
        }
    }
}

void CellColumns::fillVoids(const MeshQuery& query, const MeshCell& cell, const LineGrid::Start& start,
                            std::size_t first) {
    const LineGrid::Line& line = grid_.lines()[start.line];
    const std::vector<double> bodies(turns_.begin() + static_cast<std::ptrdiff_t>(first), turns_.end());
    turns_.resize(first);
    bool in_body = inside_[start.line] != 0.0F;
    double begin = line.enters;
    bool in = false;
    for (std::size_t i = 0; i <= bodies.size(); ++i) {
        const double end = i < bodies.size() ? bodies[i] : line.leaves;
        const double w = 0.5 * (begin + end) - line.enters;
        const bool now = in_body || query.inVoid(cell.low + cell.size * (start.point + w * grid_.along()));
        if (i == 0) {
            inside_[start.line] = now ? 1.0F : 0.0F;
        } else if (now != in) {
            turns_.push_back(begin);
        }
        in = now;
        begin = end;
        in_body = !in_body;
    }
}

}  // namespace relief
