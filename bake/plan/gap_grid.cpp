// SPDX-License-Identifier: Apache-2.0
#include "bake/plan/gap_grid.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>

namespace relief {
namespace {

/// Lines of sight across the image, each way.
constexpr std::uint32_t kLines = 64;
/// Parts of a gap whose middles are tested.
constexpr int kParts = 2;
/// The least weight of a gap, in units of the mesh's longest side.
constexpr double kShortest = 1e-3;
/// Of a cell: gaps end between two lines.
constexpr double kBesideLine = 1.0;

View gridOf(View view) {
    // The border of the view is one texel wide, whatever its size.
    const double sides[2] = {static_cast<double>(view.width), static_cast<double>(view.height)};
    for (int i = 0; i < 2; ++i) {
        const double inner = (sides[i] - 2.0) / sides[i];
        const glm::dvec3 axis = view.axis[i];
        view.axis[i] = axis * (inner * (kLines + 2.0) / kLines);
        view.origin += 0.5 * (axis - view.axis[i]);
    }
    view.width = view.height = kLines + 2;
    return view;
}

/// In units of the direction.
double shortestKept(const MeshQuery& query, const glm::dvec3& direction) {
    return kShortest * query.mesh().bounds.longestSide() / length(direction);
}

double unseenLength(const LineGap& gap, const glm::dvec3& origin, const glm::dvec3& direction,
                    const IsSeen& is_seen) {
    return unknownParts(gap, origin, direction, kParts, is_seen) * gap.length() / kParts;
}

}  // namespace

std::optional<LineGap> keptGap(const MeshQuery& query, const glm::dvec3& origin, const glm::dvec3& direction,
                               const IsSeen& is_seen) {
    std::vector<LineGap> gaps = query.gapsAlong(origin, direction);
    // Longest first: a gap no longer than the best weight so far needs no test.
    std::ranges::stable_sort(gaps, std::greater<>(), &LineGap::length);
    std::optional<LineGap> best;
    double most = shortestKept(query, direction);
    for (const LineGap& gap : gaps) {
        if (!(gap.length() > most)) {
            break;
        }
        if (const double length = unseenLength(gap, origin, direction, is_seen); length > most) {
            most = length;
            best = gap;
        }
    }
    return best;
}

bool isInKeptGap(const MeshQuery& query, const glm::dvec3& p, const glm::dvec3& direction,
                 const IsSeen& is_seen) {
    const std::vector<LineGap> gaps = query.gapsAlong(p, direction);
    const auto own =
        std::ranges::find_if(gaps, [](const LineGap& gap) { return gap.begin <= 0.0 && gap.end >= 0.0; });
    if (own == gaps.end()) {
        return false;
    }
    // Most points lie in a short or seen gap, whatever the others.
    const double shortest = shortestKept(query, direction);
    const double length = own->length() > shortest ? unseenLength(*own, p, direction, is_seen) : 0.0;
    return length > shortest && std::ranges::none_of(gaps, [&](const LineGap& gap) {
               return gap.length() > length && unseenLength(gap, p, direction, is_seen) > length;
           });
}

GapGrid::GapGrid(const MeshQuery& query, View view, const IsSeen& is_seen)
    : view_(gridOf(std::move(view))), cells_(std::size_t{view_.width} * view_.height), silhouette_({}) {
    tbb::parallel_for(std::uint32_t{1}, view_.height - 1, [&](std::uint32_t y) {
        for (std::uint32_t x = 1; x + 1 < view_.width; ++x) {
            const TexelRay ray = view_.ray(0, x, y);
            if (const auto gap = keptGap(query, ray.origin, ray.direction, is_seen)) {
                cells_[std::size_t{y} * view_.width + x] = *gap;
            }
        }
    });
    const std::vector<RowExtent> extents = rows();
    for (const RowExtent& row : extents) {
        area_ += std::max(0.0, static_cast<double>(row.high) - static_cast<double>(row.low));
    }
    const double inner = static_cast<double>(kLines) / (kLines + 2.0);
    area_ *= inner * inner * length(view_.axis[0]) * length(view_.axis[1]) / kLines;
    silhouette_ = Silhouette(extents);
}

std::vector<RowExtent> GapGrid::rows() const {
    std::vector<RowExtent> extents(kLines);
    for (std::uint32_t y = 0; y < kLines; ++y) {
        for (std::uint32_t x = 0; x < kLines; ++x) {
            if (cells_[std::size_t{y + 1} * view_.width + x + 1].length() > 0.0) {
                extents[y].add({static_cast<float>(std::max(0.0, (x - kBesideLine) / kLines)),
                                static_cast<float>(std::min(1.0, (x + 1.0 + kBesideLine) / kLines))});
            }
        }
    }
    // Between two lines of sight a row may extend as far as either of its neighbours.
    std::vector<RowExtent> wide = extents;
    for (std::size_t y = 0; y + 1 < extents.size(); ++y) {
        wide[y].add(extents[y + 1]);
        wide[y + 1].add(extents[y]);
    }
    return wide;
}

bool GapGrid::holds(const glm::dvec3& p) const {
    const glm::dvec3 from = p - view_.origin;
    double at[3];
    for (int i = 0; i < 3; ++i) {
        at[i] = dot(from, view_.axis[i]) / dot(view_.axis[i], view_.axis[i]);
        if (!(at[i] >= 0.0 && at[i] < 1.0)) {
            return false;
        }
    }
    const auto x = static_cast<std::size_t>(at[0] * view_.width);
    const auto y = static_cast<std::size_t>(at[1] * view_.height);
    const LineGap& gap = cells_[y * view_.width + x];
    return gap.length() > 0.0 && at[2] >= gap.begin && at[2] <= gap.end;
}

}  // namespace relief
