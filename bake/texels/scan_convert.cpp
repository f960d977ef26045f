#include "bake/texels/scan_convert.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bake/mesh/triangle_plane.h"
#include "formats/depth_map.h"

namespace relief {
namespace {

/// As raycast.cpp has it: this near to an edge, in barycentric coordinates, a hit may as well be the neighbour's;
/// surfaces this near in depth meet there.
constexpr double kEdgeWidth = 1e-4;
constexpr double kTieDepth = 1e-5;
/// Surfaces this near in depth are one, also away from edges.
constexpr double kSameDepth = 1e-9;
/// Edges flatter than this, in texels, say too little about where a row crosses them.
constexpr double kFlat = 1e-6;

double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

/// An edge, the same bits for both of its triangles.
class Edge {
  public:
    Edge(const glm::dvec2& from, const glm::dvec2& to, double turn) {
        const bool as_given = from.x < to.x || (from.x == to.x && from.y < to.y);
        start_ = as_given ? from : to;
        along_ = as_given ? to - from : from - to;
        inwards_ = as_given ? turn : -turn;
    }

    /// Above 0 inside the triangle; in units of the double area.
    [[nodiscard]] double sideOf(const glm::dvec2& p) const {
        return inwards_ * (along_.x * (p.y - start_.y) - along_.y * (p.x - start_.x));
    }
    [[nodiscard]] bool isFlat() const { return std::abs(along_.y) < kFlat; }
    /// Rows end at this edge, rather than begin.
    [[nodiscard]] bool isRight() const { return inwards_ * along_.y > 0.0; }
    [[nodiscard]] bool isNear(double y) const { return std::abs(y - start_.y) < 1e3 * kFlat; }
    [[nodiscard]] double crossing(double y) const {
        return start_.x + (y - start_.y) * (along_.x / along_.y);
    }

  private:
    glm::dvec2 start_;
    glm::dvec2 along_;
    double inwards_;  // 1 or −1
};

}  // namespace

/// Rows, and where their hits go.
struct ScanConverter::Block {
    std::uint32_t begin;
    std::uint32_t end;
    std::span<Hit> near;  // from row `begin` on
    std::span<Hit> far;
};

/// A triangle in the view.
class ScanConverter::Triangle {
  public:
    Triangle(const std::vector<glm::dvec2>& places, const glm::uvec3& t)
        : corners_{places[t.x], places[t.y], places[t.z]},
          double_area_(cross(corners_[1] - corners_[0], corners_[2] - corners_[0])) {}

    [[nodiscard]] bool edgeOn() const { return !(std::abs(double_area_) > 0.0); }

    /// Of some number of texels, those whose centres lie between two corners, [first, end).
    [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> rangeOf(int axis, std::uint32_t count) const {
        const double low = std::min({corners_[0][axis], corners_[1][axis], corners_[2][axis]});
        const double high = std::max({corners_[0][axis], corners_[1][axis], corners_[2][axis]});
        const double last = count;
        return {static_cast<std::uint32_t>(std::clamp(std::ceil(low), 0.0, last)),
                static_cast<std::uint32_t>(std::clamp(std::floor(high) + 1.0, 0.0, last))};
    }

    [[nodiscard]] std::array<Edge, 3> edges() const {
        const double turn = double_area_ > 0.0 ? 1.0 : -1.0;
        return {Edge(corners_[0], corners_[1], turn), Edge(corners_[1], corners_[2], turn),
                Edge(corners_[2], corners_[0], turn)};
    }
    [[nodiscard]] double doubleArea() const { return std::abs(double_area_); }

  private:
    std::array<glm::dvec2, 3> corners_;
    double double_area_;
};

ScanConverter::ScanConverter(const RayScene& scene, const View& view)
    : scene_(scene), view_(view), planes_(scene.mesh(), view), direction_(view.axis[2]) {
    const TriangleMesh& mesh = scene.mesh();
    const glm::dvec3 across = view.axis[0] * (view.width / dot(view.axis[0], view.axis[0]));
    const glm::dvec3 upwards = view.axis[1] * (view.height / dot(view.axis[1], view.axis[1]));
    places_.resize(mesh.positions.size());
    tbb::parallel_for(std::size_t{0}, places_.size(), [&](std::size_t i) {
        const glm::dvec3 from_origin = glm::dvec3(mesh.positions[i]) - view.origin;
        places_[i] = {dot(from_origin, across) - 0.5, dot(from_origin, upwards) - 0.5};
    });
    // Which blocks of rows a triangle has samples in, [first, end).
    const std::uint32_t blocks = (view.height + kBlockRows - 1) / kBlockRows;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges(mesh.triangles.size());
    tbb::parallel_for(std::size_t{0}, ranges.size(), [&](std::size_t i) {
        const Triangle triangle(places_, mesh.triangles[i]);
        const auto [row, row_end] = triangle.rangeOf(1, view.height);
        const auto [column, column_end] = triangle.rangeOf(0, view.width);
        if (!triangle.edgeOn() && row < row_end && column < column_end) {
            ranges[i] = {row / kBlockRows, (row_end - 1) / kBlockRows + 1};
        }
    });
    first_.assign(blocks + 1, 0);
    for (const auto& [begin, end] : ranges) {
        for (std::uint32_t block = begin; block < end; ++block) {
            ++first_[block + 1];
        }
    }
    for (std::size_t block = 1; block < first_.size(); ++block) {
        first_[block] += first_[block - 1];
    }
    triangles_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        for (std::uint32_t block = ranges[i].first; block < ranges[i].second; ++block) {
            triangles_[next[block]++] = static_cast<std::uint32_t>(i);
        }
    }
}

std::span<const std::uint32_t> ScanConverter::trianglesOf(std::uint32_t block) const {
    return std::span(triangles_).subspan(first_[block], first_[block + 1] - first_[block]);
}

void ScanConverter::scanRows(const RowRange& rows, std::span<Hit> near, std::span<Hit> far) const {
    std::ranges::fill(near, Hit());
    std::ranges::fill(far, Hit());
    for (std::uint32_t begin = rows.begin; begin < rows.end;) {
        const std::uint32_t block = begin / kBlockRows;
        const std::uint32_t end = std::min(rows.end, (block + 1) * kBlockRows);
        const std::size_t at = std::size_t{begin - rows.begin} * view_.width;
        const auto part = [&](std::span<Hit> hits) { return hits.empty() ? hits : hits.subspan(at); };
        const Block here{begin, end, part(near), part(far)};
        for (const std::uint32_t triangle : trianglesOf(block)) {
            scan(triangle, here);
        }
        begin = end;
    }
}

void ScanConverter::scan(std::uint32_t triangle, const Block& block) const {
    const Triangle shape(places_, scene_.mesh().triangles[triangle]);
    const std::array<Edge, 3> edges = shape.edges();
    const auto [first_row, end_row] = shape.rangeOf(1, view_.height);
    const auto [first_column, end_column] = shape.rangeOf(0, view_.width);
    const PlaneDepth plane = planes_.of(triangle);
    const auto holds = [&](std::int64_t x, std::uint32_t y) {
        const glm::dvec2 p(static_cast<double>(x), y);
        return edges[0].sideOf(p) >= 0.0 && edges[1].sideOf(p) >= 0.0 && edges[2].sideOf(p) >= 0.0;
    };
    for (std::uint32_t y = std::max(first_row, block.begin); y < std::min(end_row, block.end); ++y) {
        // About where the row enters and leaves the triangle: there the edges themselves are asked, and all along one
        // that the row runs along.
        double low = first_column;
        double high = end_column - 1.0;
        bool along_edge = false;
        for (const Edge& edge : edges) {
            if (edge.isFlat()) {
                along_edge = along_edge || edge.isNear(y);
            } else if (edge.isRight()) {
                high = std::min(high, edge.crossing(y));
            } else {
                low = std::max(low, edge.crossing(y));
            }
        }
        if (!(low <= high + 2.0)) {
            continue;
        }
        auto x = std::max<std::int64_t>(static_cast<std::int64_t>(std::ceil(low)) - 1, first_column);
        auto last = std::min<std::int64_t>(static_cast<std::int64_t>(std::floor(high)) + 1, end_column - 1);
        while (x <= last && !holds(x, y)) {
            ++x;
        }
        while (x < last && !holds(last, y)) {
            --last;
        }
        for (; x <= last; ++x) {
            if (!along_edge || holds(x, y)) {
                meet(triangle, plane, static_cast<std::uint32_t>(x), y, block);
            }
        }
    }
}

double ScanConverter::depthAt(std::uint32_t triangle, const PlaneDepth& plane, std::uint32_t x,
                              std::uint32_t y) const {
    const double depth = plane.at(x, y);
    return plane.grazing ? insideTriangle(scene_.mesh(), triangle, view_.ray(0, x, y), depth) : depth;
}

void ScanConverter::meet(std::uint32_t triangle, const PlaneDepth& plane, std::uint32_t x, std::uint32_t y,
                         const Block& block) const {
    const double depth = depthAt(triangle, plane, x, y);
    if (!(depth >= -kDepthSlack && depth <= 1.0 + kDepthSlack)) {
        return;
    }
    const auto stored = static_cast<float>(std::clamp(depth, 0.0, 1.0));
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
        if (hit.empty() || before > kTie || (before >= -kTie && isBetter(triangle, depth, hit, end, x, y))) {
            hit = Hit(stored, triangle, near ? plane.along > 0.0 : plane.along < 0.0);
        }
    }
}

bool ScanConverter::isBetter(std::uint32_t triangle, double depth, const Hit& than, RayEnd end,
                             std::uint32_t x, std::uint32_t y) const {
    const double other = depthAt(than.triangle(), planes_.of(than.triangle()), x, y);
    const double before = end == RayEnd::kNear ? other - depth : depth - other;
    const bool meet_here =
        std::abs(before) <= kSameDepth ||
        (std::abs(before) <= kTieDepth && atEdge(triangle, x, y) && atEdge(than.triangle(), x, y));
    if (!meet_here) {
        return before > 0.0;
    }
    const glm::dvec3 direction = end == RayEnd::kNear ? direction_ : -direction_;
    const auto scoreOf = [&](std::uint32_t t) {
        return facingScore(scene_.mesh(), t, scene_.winding(), direction);
    };
    return scoreOf(triangle) > scoreOf(than.triangle());  // of equals the first, which has the lower index
}

bool ScanConverter::atEdge(std::uint32_t triangle, std::uint32_t x, std::uint32_t y) const {
    const Triangle shape(places_, scene_.mesh().triangles[triangle]);
    return std::ranges::any_of(shape.edges(), [&](const Edge& edge) {
        return edge.sideOf(glm::dvec2(x, y)) < kEdgeWidth * shape.doubleArea();
    });
}

}  // namespace relief
