// SPDX-License-Identifier: Apache-2.0
#include "bake/named_maps/scan_convert.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "bake/mesh/cube_faces.h"
#include "formats/depth_map.h"

namespace relief {
namespace {

/// A hit may belong to the neighbouring triangle if it is within kEdgeWidth of an edge, in barycentric coordinates. Two
/// such hits belong to surfaces that meet there if their depths differ by at most kTieDepth.
constexpr double kEdgeWidth = 1e-4;
constexpr double kTieDepth = 1e-5;
/// Surfaces within this depth are the same, even away from edges.
constexpr double kSameDepth = 1e-9;
/// If the side function of an edge changes less than this along a row, relative to its value, the crossing with the row
/// cannot be computed.
constexpr double kFlat = 1e-9;

/// The texels of a face in coordinates in which its rays are (x, y, 1).
struct Grid {
    const CubeFaceAxes* face = nullptr;  ///< null: orthographic
    double columns = 1.0;
    double rows = 1.0;

    [[nodiscard]] double x(double column) const {
        return face == nullptr ? column : 2.0 * ((column + 0.5) / columns) - 1.0;
    }
    [[nodiscard]] double y(double row) const {
        return face == nullptr ? row : 2.0 * ((row + 0.5) / rows) - 1.0;
    }
    [[nodiscard]] double column(double x) const {
        return face == nullptr ? x : 0.5 * (x + 1.0) * columns - 0.5;
    }
    [[nodiscard]] double row(double y) const { return face == nullptr ? y : 0.5 * (y + 1.0) * rows - 0.5; }
    /// A corner as x, y and height above the centre; its ray is (x, y) / height.
    [[nodiscard]] glm::dvec3 of(const glm::dvec3& place) const {
        return face == nullptr ? place
                               : glm::dvec3(face->s.of(place), face->t.of(place), face->major.of(place));
    }
};

}  // namespace

/// The output for some rows.
struct ScanConverter::Block {
    std::uint32_t face;
    std::uint32_t begin;
    std::span<Hit> near;  // from row `begin` on
    std::span<Hit> far;
};

/// The half-plane of a face on the triangle's side of an edge. Bit-identical for both triangles of the edge, except for
/// the sign.
class ScanConverter::Edge {
  public:
    /// \param from, to  from Grid::of
    /// \param turn  1 or −1, chosen so that sideOf() is positive inside.
    Edge(const glm::dvec3& from, const glm::dvec3& to, double turn, bool cube) {
        const bool as_given = std::tie(from.x, from.y, from.z) < std::tie(to.x, to.y, to.z);
        const glm::dvec3& a = as_given ? from : to;
        const glm::dvec3& b = as_given ? to : from;
        const double sign = as_given ? turn : -turn;
        if (cube) {
            side_ = sign * cross(a, b);  // of the plane through the centre and the edge
        } else {
            start_ = a;
            side_ = {sign * (a.y - b.y), sign * (b.x - a.x), 0.0};
        }
    }

    [[nodiscard]] double sideOf(double x, double y) const {
        return side_.x * (x - start_.x) + (side_.y * (y - start_.y) + side_.z);
    }

    /// Shrinks the range of x to this side of the edge, along the row of y.
    /// \return false if the row runs along the edge: test its texels one by one.
    [[nodiscard]] bool clip(double y, double& low, double& high) const {
        const double at_start = side_.y * (y - start_.y) + side_.z;
        const double change = side_.x;
        if (std::abs(change) > kFlat * (std::abs(side_.y * (y - start_.y)) + std::abs(side_.z))) {
            const double crossing = start_.x - at_start / change;
            if (change > 0.0) {
                low = std::max(low, crossing);
            } else {
                high = std::min(high, crossing);
            }
            return true;
        }
        const double most = 2.0 * std::abs(change) * (std::abs(low - start_.x) + std::abs(high - start_.x));
        if (at_start < -most) {
            high = -std::numeric_limits<double>::infinity();
        }
        return std::abs(at_start) > most;
    }

  private:
    glm::dvec3 side_;
    glm::dvec3 start_{0.0};
};

/// A triangle projected onto a face of the view.
class ScanConverter::Shape {
  public:
    Shape(const ScanConverter& scan, std::uint32_t triangle, std::uint32_t face)
        : grid_{scan.cube_ ? &kCubeFaces[face] : nullptr, static_cast<double>(scan.view_.width),
                static_cast<double>(scan.view_.height)},
          corners_(cornersOf(scan, triangle, grid_)),
          volume_(scan.cube_ ? dot(corners_[0], cross(corners_[1], corners_[2]))
                             : cross(corners_[1] - corners_[0], corners_[2] - corners_[0]).z) {}

    /// Whether the triangle is edge-on, so that rays hit at most its edges.
    [[nodiscard]] bool edgeOn() const { return !(std::abs(volume_) > 0.0); }

    /// Returns the range [first, end) of columns (axis 0) or rows (1), out of `count`, whose rays may hit the triangle.
    [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> rangeOf(int axis, std::uint32_t count) const {
        double low = std::numeric_limits<double>::infinity();
        double high = -low;
        int behind = 0;
        for (const glm::dvec3& corner : corners_) {
            if (!(corner.z > kHeightMin)) {
                ++behind;
                continue;
            }
            const double at = grid_.face == nullptr ? corner[axis] : corner[axis] / corner.z;
            const double texel = axis == 0 ? grid_.column(at) : grid_.row(at);
            low = std::min(low, texel);
            high = std::max(high, texel);
        }
        if (behind == 3) {
            return {0, 0};
        }
        if (behind > 0) {  // it passes the centre, and may project anywhere
            return {0, count};
        }
        const double last = count;
        // Tolerance for the rounding of a cube's texel coordinates.
        const double slack = grid_.face == nullptr ? 0.0 : 1e-6;
        return {static_cast<std::uint32_t>(std::clamp(std::ceil(low - slack), 0.0, last)),
                static_cast<std::uint32_t>(std::clamp(std::floor(high + slack) + 1.0, 0.0, last))};
    }

    [[nodiscard]] std::array<Edge, 3> edges() const {
        const double turn = volume_ > 0.0 ? 1.0 : -1.0;
        const bool cube = grid_.face != nullptr;
        return {Edge(corners_[0], corners_[1], turn, cube), Edge(corners_[1], corners_[2], turn, cube),
                Edge(corners_[2], corners_[0], turn, cube)};
    }
    [[nodiscard]] const Grid& grid() const { return grid_; }

  private:
    /// Minimum height of a corner in front of the centre, in half sides of the cube.
    static constexpr double kHeightMin = 1e-6;

    static std::array<glm::dvec3, 3> cornersOf(const ScanConverter& scan, std::uint32_t triangle,
                                               const Grid& grid) {
        const glm::uvec3& t = scan.scene_.mesh().triangles[triangle];
        return {grid.of(scan.places_[t.x]), grid.of(scan.places_[t.y]), grid.of(scan.places_[t.z])};
    }

    Grid grid_;
    std::array<glm::dvec3, 3> corners_;
    double volume_;  // six times the tetrahedron with the centre; orthographic: twice the area
};

ScanConverter::ScanConverter(const RayScene& scene, const View& view)
    : scene_(scene),
      view_(view),
      cube_(view.projection() == Projection::kCube),
      may_start_inside_{mayStartInSolid(scene, view, RayEnd::kNear),
                        mayStartInSolid(scene, view, RayEnd::kFar)},
      planes_(scene.mesh(), view),
      blocks_((view.height + kBlockRows - 1) / kBlockRows) {
    place();
    sortIntoBlocks();
}

void ScanConverter::place() {
    const std::vector<glm::vec3>& positions = scene_.mesh().positions;
    const auto unitsOf = [&](int axis, double count) {
        return view_.axis[axis] * (count / dot(view_.axis[axis], view_.axis[axis]));
    };
    const glm::dvec3 x = unitsOf(0, cube_ ? 1.0 : view_.width);
    const glm::dvec3 y = unitsOf(1, cube_ ? 1.0 : view_.height);
    const glm::dvec3 z = unitsOf(2, 1.0);
    places_.resize(positions.size());
    tbb::parallel_for(std::size_t{0}, places_.size(), [&](std::size_t i) {
        const glm::dvec3 p = glm::dvec3(positions[i]) - view_.origin;
        places_[i] = cube_ ? glm::dvec3(dot(p, x), dot(p, y), dot(p, z))
                           : glm::dvec3(dot(p, x) - 0.5, dot(p, y) - 0.5, 1.0);
    });
}

void ScanConverter::sortIntoBlocks() {
    const std::size_t faces = view_.faceCount();
    const std::size_t count = scene_.mesh().triangles.size();
    // The rows of a triangle on a face: its blocks, and its rows within the first and the last block.
    struct Rows {
        std::uint16_t first_block = 0;
        std::uint16_t end_block = 0;
        std::uint8_t begin = 0;
        std::uint8_t end = 0;
    };
    std::vector<Rows> rows_of(faces * count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
        for (std::size_t face = 0; face < faces; ++face) {
            const Shape shape(*this, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(face));
            const auto [row, row_end] = shape.rangeOf(1, view_.height);
            const auto [column, column_end] = shape.rangeOf(0, view_.width);
            if (!shape.edgeOn() && row < row_end && column < column_end) {
                rows_of[faces * i + face] = {static_cast<std::uint16_t>(row / kBlockRows),
                                             static_cast<std::uint16_t>((row_end - 1) / kBlockRows + 1),
                                             static_cast<std::uint8_t>(row % kBlockRows),
                                             static_cast<std::uint8_t>((row_end - 1) % kBlockRows + 1)};
            }
        }
    });
    entries_ = Buckets<Entry, std::size_t>(faces * blocks_, [&](const auto& visit) {
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t face = 0; face < faces; ++face) {
                const Rows& rows = rows_of[faces * i + face];
                for (std::uint32_t block = rows.first_block; block < rows.end_block; ++block) {
                    const auto begin = block == rows.first_block ? rows.begin : std::uint8_t{0};
                    const auto end = block + 1U == rows.end_block ? rows.end : std::uint8_t{kBlockRows};
                    visit(face * blocks_ + block, Entry{static_cast<std::uint32_t>(i), begin, end});
                }
            }
        }
    });
}

void ScanConverter::prefetch(std::span<const Entry> entries, std::size_t i) const {
    constexpr std::size_t kAhead = 8;
    const TriangleMesh& mesh = scene_.mesh();
    if (i + 2 * kAhead < entries.size()) {
        __builtin_prefetch(&mesh.triangles[entries[i + 2 * kAhead].triangle]);
    }
    if (i + kAhead < entries.size()) {
        const glm::uvec3& t = mesh.triangles[entries[i + kAhead].triangle];
        for (const std::uint32_t corner : {t.x, t.y, t.z}) {
            __builtin_prefetch(&places_[corner]);
            __builtin_prefetch(&mesh.positions[corner]);
        }
    }
}

void ScanConverter::scan(const RowRange& rows, std::span<Hit> near, std::span<Hit> far) const {
    std::ranges::fill(near, Hit());
    std::ranges::fill(far, Hit());
    for (std::uint32_t begin = rows.begin; begin < rows.end;) {
        const std::uint32_t block = begin / kBlockRows;
        const std::uint32_t first_row = block * kBlockRows;
        const std::uint32_t end = std::min(rows.end, first_row + kBlockRows);
        const std::size_t at = std::size_t{begin - rows.begin} * view_.width;
        const auto part = [&](std::span<Hit> hits) { return hits.empty() ? hits : hits.subspan(at); };
        const Block here{rows.face, begin, part(near), part(far)};
        const std::span<const Entry> entries = entries_[std::size_t{rows.face} * blocks_ + block];
        for (std::size_t i = 0; i < entries.size(); ++i) {
            prefetch(entries, i);
            const Entry& entry = entries[i];
            const std::uint32_t first = std::max(begin, first_row + entry.begin);
            const std::uint32_t last = std::min(end, first_row + entry.end);
            if (first < last) {
                draw(entry.triangle, first, last, here);
            }
        }
        begin = end;
    }
}

inline bool ScanConverter::isInView(double depth, std::uint32_t face, std::uint32_t x,
                                    std::uint32_t y) const {
    if (!cube_) {
        return depth >= -kDepthSlack && depth <= 1.0 + kDepthSlack;
    }
    return depth >= 0.0 && (view_.encloses || depth <= view_.depthMax(view_.ray(face, x, y)) + kDepthSlack);
}

inline void ScanConverter::meet(const ProjectedPlane& plane, std::uint32_t x, std::uint32_t y,
                                const Block& block) const {
    const auto [depth, along] = planes_.at(plane, block.face, x, y);
    const double most = cube_ ? double{kCubeDepthMax} : 1.0;
    if (!isInView(depth, block.face, x, y)) {
        return;
    }
    const auto stored = static_cast<float>(std::clamp(depth, 0.0, most));
    const std::size_t at = std::size_t{y - block.begin} * view_.width + x;
    for (const RayEnd end : {RayEnd::kNear, RayEnd::kFar}) {
        const bool near = end == RayEnd::kNear;
        const std::span<Hit> hits = near ? block.near : block.far;
        if (hits.empty()) {
            continue;
        }
        Hit& hit = hits[at];
        const float before = near ? hit.depth() - stored : stored - hit.depth();
        constexpr auto kTie = static_cast<float>(kTieDepth);
        if (hit.empty() || before > kTie ||
            (before >= -kTie && isBetter(plane.triangle, depth, hit, end, block.face, x, y))) {
            hit = Hit(stored, plane.triangle, near ? along > 0.0 : along < 0.0);
        }
    }
}

void ScanConverter::draw(std::uint32_t triangle, std::uint32_t begin, std::uint32_t end,
                         const Block& block) const {
    const Shape shape(*this, triangle, block.face);
    const Grid& grid = shape.grid();
    const std::array<Edge, 3> edges = shape.edges();
    const auto [first_column, end_column] = shape.rangeOf(0, view_.width);
    const ProjectedPlane plane = planes_.of(triangle);
    for (std::uint32_t row = begin; row < end; ++row) {
        const double y = grid.y(row);
        const auto holds = [&](std::int64_t column) {
            const double x = grid.x(static_cast<double>(column));
            return edges[0].sideOf(x, y) >= 0.0 && edges[1].sideOf(x, y) >= 0.0 &&
                   edges[2].sideOf(x, y) >= 0.0;
        };
        // Estimates of where the row enters and leaves the triangle. Texels near these points, or along an edge
        // parallel to the row, are tested exactly.
        double low = grid.x(first_column);
        double high = grid.x(end_column - 1.0);
        bool clear = true;
        for (const Edge& edge : edges) {
            clear = edge.clip(y, low, high) && clear;
        }
        low = grid.column(low);
        high = grid.column(high);
        if (!(low <= high + 2.0)) {
            continue;
        }
        auto column = std::max<std::int64_t>(static_cast<std::int64_t>(std::ceil(low)) - 1, first_column);
        auto last = std::min<std::int64_t>(static_cast<std::int64_t>(std::floor(high)) + 1, end_column - 1);
        while (column <= last && !holds(column)) {
            ++column;
        }
        while (column < last && !holds(last)) {
            --last;
        }
        for (; column <= last; ++column) {
            if (clear || holds(column)) {
                meet(plane, static_cast<std::uint32_t>(column), row, block);
            }
        }
    }
}

bool ScanConverter::isBetter(std::uint32_t triangle, double depth, const Hit& than, RayEnd end,
                             std::uint32_t face, std::uint32_t x, std::uint32_t y) const {
    const double other = planes_.at(planes_.of(than.triangle()), face, x, y).depth;
    const double before = end == RayEnd::kNear ? other - depth : depth - other;
    const bool meet_here =
        std::abs(before) <= kSameDepth || (std::abs(before) <= kTieDepth && atEdge(triangle, face, x, y) &&
                                           atEdge(than.triangle(), face, x, y));
    if (!meet_here) {
        return before > 0.0;
    }
    const glm::dvec3 away = view_.ray(face, x, y).direction;
    const glm::dvec3 direction = end == RayEnd::kNear ? away : -away;
    const auto scoreOf = [&](std::uint32_t t) {
        return facingScore(scene_.mesh(), t, scene_.winding(), direction);
    };
    const double score = scoreOf(triangle);
    const double other_score = scoreOf(than.triangle());
    const bool faces = score > 0.0;
    if (may_start_inside_[static_cast<std::size_t>(end)] && faces != (other_score > 0.0)) {
        return faces != startsInside(depth, end, face, x, y);
    }
    return score > other_score;  // of equal triangles, keeps the first, which has the lower index
}

bool ScanConverter::startsInside(double depth, RayEnd end, std::uint32_t face, std::uint32_t x,
                                 std::uint32_t y) const {
    const TexelRay ray = view_.ray(face, x, y);
    const double start = end == RayEnd::kNear ? 0.0 : view_.depthMax(ray);
    return scene_.inside(ray.origin + 0.5 * (start + depth) * ray.direction);
}

bool ScanConverter::atEdge(std::uint32_t triangle, std::uint32_t face, std::uint32_t x,
                           std::uint32_t y) const {
    const Shape shape(*this, triangle, face);
    std::array<double, 3> sides{};
    double sum = 0.0;
    for (std::size_t i = 0; const Edge& edge : shape.edges()) {
        sides[i] = edge.sideOf(shape.grid().x(x), shape.grid().y(y));
        sum += sides[i++];
    }
    return std::ranges::min(sides) < kEdgeWidth * sum;
}

}  // namespace relief
