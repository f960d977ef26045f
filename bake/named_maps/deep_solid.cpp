// SPDX-License-Identifier: Apache-2.0
#include "bake/named_maps/deep_solid.h"

#include <algorithm>

namespace relief {
namespace {

/// A line, in texels from the centre of the texel; off any grid with which texels may be aligned.
struct Place {
    double x;
    double y;
    /// In diagonals: a ball of one diagonal around any point of the texel contains at least this much of the line on
    /// each side, because the point is at most √(1 − half_chord²) diagonals from the line.
    double half_chord;
};
constexpr std::array<Place, 5> kPlaces = {{{0.0131, -0.0173, 0.84},
                                           {-0.4831, -0.4787, 0.18},
                                           {0.4723, 0.4849, 0.18},
                                           {0.4849, -0.4801, 0.18},
                                           {-0.4771, 0.4837, 0.18}}};

}  // namespace

void DeepSolid::place() {
    const auto x = static_cast<std::uint32_t>(texel_ % map_.width);
    const auto row = static_cast<std::uint32_t>(texel_ / map_.width);
    const std::uint32_t face = row / map_.height;
    const std::uint32_t y = row % map_.height;
    centre_ = texelRay(map_, face, x, y);
    for (std::size_t i = 0; i < kLines; ++i) {
        lines_[i] = rayThrough(map_, face, x + 0.5 + kPlaces[i].x, y + 0.5 + kPlaces[i].y);
    }
    for (std::size_t i = 0; i < kCorners; ++i) {
        corners_[i] = rayThrough(map_, face, x + (i % 2 == 0 ? 0.0 : 1.0), y + (i < 2 ? 0.0 : 1.0));
    }
    diagonal_ = std::max(length(corners_[0].at(1.0) - corners_[3].at(1.0)),
                         length(corners_[1].at(1.0) - corners_[2].at(1.0))) /
                length(centre_.direction);
    known_ = true;
    any_known_ = false;
    traced_ = 0;
    spans_.assign(1, kAllDepths);
}

void DeepSolid::narrow() {
    const double shrunk = kPlaces[traced_].half_chord * diagonal_;
    const TexelRay& line = lines_[traced_++];
    if (!query_.spansInside(line.origin, line.direction, of_line_)) {
        return;
    }
    any_known_ = true;
    both_.clear();
    const bool cube = map_.projection() == Projection::kCube;
    // Both lists are sorted.
    auto other = spans_.begin();
    for (LineSpan span : of_line_) {
        // In a cube, the diagonal of a texel grows with the depth.
        if (cube) {
            span = {std::max(span.begin, 0.0) / std::max(1.0 - shrunk, 1e-3), span.end / (1.0 + shrunk)};
        } else {
            span = {span.begin + shrunk, span.end - shrunk};
        }
        while (other != spans_.end() && other->end <= span.begin) {
            ++other;
        }
        for (auto here = other; here != spans_.end() && here->begin < span.end; ++here) {
            const LineSpan common{std::max(span.begin, here->begin), std::min(span.end, here->end)};
            if (common.begin < common.end) {
                both_.push_back(common);
            }
        }
    }
    spans_.swap(both_);
}

bool DeepSolid::cutBy(const glm::dvec3& normal, double offset) {
    if (!known_) {
        place();
    }
    // The half-space contains points of the corner rays only at depths up to `up_to`, or from `from` on.
    double up_to = kAllDepths.begin;
    double from = kAllDepths.end;
    for (const TexelRay& line : corners_) {
        const double along = dot(normal, line.direction);
        const double at = (offset - dot(normal, line.origin - centre_.origin)) / along;
        if (along < 0.0) {
            up_to = std::max(up_to, at);
        } else if (along > 0.0) {
            from = std::min(from, at);
        } else if (offset <= dot(normal, line.origin - centre_.origin)) {
            up_to = kAllDepths.end;
        }
    }
    const auto isCut = [&](const LineSpan& span) { return span.begin < up_to || span.end > from; };
    while (std::ranges::any_of(spans_, isCut)) {
        if (traced_ == kLines) {
            return any_known_ || query_.watertight();
        }
        narrow();
    }
    return false;
}

}  // namespace relief
