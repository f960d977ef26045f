// Isolines of a slice.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "bake/picture/slice.h"

namespace relief {

enum class SampleKind { kDistance, kFar, kAbstained };

[[nodiscard]] inline SampleKind kindOf(const FieldSample& sample) {
    return sample.map < 0                   ? SampleKind::kAbstained
           : sample.distance >= kFarOutside ? SampleKind::kFar
                                            : SampleKind::kDistance;
}

/// Marching squares for one level of the distance. Coordinates in samples from the centre of the first.
class Contour {
  public:
    Contour(const Slice& slice, double level, double jump) : slice_(slice), level_(level), jump_(jump) {}

    /// Calls segment(x0, y0, x1, y1) for every piece.
    template <class Segment>
    void trace(const Segment& segment) const {
        for (std::uint32_t y = 0; y + 1 < slice_.height; ++y) {
            for (std::uint32_t x = 0; x + 1 < slice_.width; ++x) {
                traceCell(x, y, segment);
            }
        }
    }

  private:
    using Point = std::array<double, 2>;

    template <class Segment>
    void traceCell(std::uint32_t x, std::uint32_t y, const Segment& segment) const {
        constexpr std::array<std::array<int, 2>, 4> kCorner = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
        std::array<double, 4> value{};
        for (std::size_t i = 0; i < 4; ++i) {
            const FieldSample& sample = slice_.sample(x + static_cast<std::uint32_t>(kCorner[i][0]),
                                                      y + static_cast<std::uint32_t>(kCorner[i][1]));
            const SampleKind kind = kindOf(sample);
            // Only the zero contour borders on what is outside without a distance.
            if (kind == SampleKind::kAbstained || (kind == SampleKind::kFar && level_ != 0.0)) {
                return;
            }
            value[i] = static_cast<double>(sample.distance) - level_;
        }
        const auto [low, high] = std::minmax_element(value.begin(), value.end());
        if (*low >= 0.0 || *high < 0.0 || (level_ != 0.0 && *high - *low > jump_)) {
            return;
        }
        std::array<Point, 4> crossing{};
        std::size_t count = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            const std::size_t j = (i + 1) % 4;
            if ((value[i] < 0.0) != (value[j] < 0.0)) {
                // Across a jump of the field the surface may be anywhere: the middle.
                const bool jumps = std::abs(value[i] - value[j]) > jump_;
                const double t = jumps ? 0.5 : value[i] / (value[i] - value[j]);
                crossing[count++] = {x + kCorner[i][0] + t * (kCorner[j][0] - kCorner[i][0]),
                                     y + kCorner[i][1] + t * (kCorner[j][1] - kCorner[i][1])};
            }
        }
        // A saddle has four crossings, paired by the sign of the middle.
        const bool middle_inside = value[0] + value[1] + value[2] + value[3] < 0.0;
        const std::size_t shift = count == 4 && (value[0] < 0.0) == middle_inside ? 1 : 0;
        // Shift 1 joins edges 0-1 and 2-3 (corners 1 and 3 cut off); shift 0 joins 3-0 and 1-2.
        if (count == 4 && shift == 0) {
            std::rotate(crossing.begin(), crossing.begin() + 3, crossing.end());
        }
        for (std::size_t i = 0; i + 1 < count; i += 2) {
            segment(crossing[i][0], crossing[i][1], crossing[i + 1][0], crossing[i + 1][1]);
        }
    }

    const Slice& slice_;
    double level_;
    double jump_;
};

}  // namespace relief
