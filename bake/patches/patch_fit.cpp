#include "bake/patches/patch_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace relief {
namespace {

constexpr std::size_t kNodesMax = std::size_t{kPatchSideMax} * kPatchSideMax;
/// The bilinear basis couples a node with those up to one row and one column on, second differences with those two rows on.
constexpr std::size_t kBandMax = 2 * kPatchSideMax + 1;
/// Weight of second differences against a column's: where no column tells, the patch goes on straight.
constexpr double kSmooth = 3e-4;
constexpr double kAnchor = 1e-7;
/// An error below which all errors weigh the same, in units of w.
constexpr double kSmallError = 4e-3;

/// A symmetric system of at most kNodesMax unknowns whose entries lie within a band.
class BandSystem {
  public:
    BandSystem(std::size_t unknowns, std::size_t band) : unknowns_(unknowns), band_(band) {}

    void add(std::size_t i, std::size_t j, double value) {  // i >= j
        rows_[i][i - j] += value;
    }
    void addRight(std::size_t i, double value) { right_[i] += value; }

    /// By LDLᵀ, which keeps the band.
    void solve(std::span<double> x) {
        std::array<double, kNodesMax> diagonal;
        for (std::size_t i = 0; i < unknowns_; ++i) {
            const std::size_t first = i > band_ ? i - band_ : 0;
            for (std::size_t j = first; j < i; ++j) {
                double sum = rows_[i][i - j];
                for (std::size_t k = std::max(first, j > band_ ? j - band_ : 0); k < j; ++k) {
                    sum -= rows_[i][i - k] * rows_[j][j - k] * diagonal[k];
                }
                rows_[i][i - j] = sum / diagonal[j];
            }
            double pivot = rows_[i][0];
            for (std::size_t k = first; k < i; ++k) {
                pivot -= rows_[i][i - k] * rows_[i][i - k] * diagonal[k];
            }
            diagonal[i] = pivot;
        }
        for (std::size_t i = 0; i < unknowns_; ++i) {
            x[i] = right_[i];
            for (std::size_t k = i > band_ ? i - band_ : 0; k < i; ++k) {
                x[i] -= rows_[i][i - k] * x[k];
            }
        }
        for (std::size_t i = 0; i < unknowns_; ++i) {
            x[i] /= diagonal[i];
        }
        for (std::size_t i = unknowns_; i-- > 0;) {
            for (std::size_t k = i > band_ ? i - band_ : 0; k < i; ++k) {
                x[k] -= rows_[i][i - k] * x[i];
            }
        }
    }

  private:
    std::size_t unknowns_;
    std::size_t band_;
    std::array<std::array<double, kBandMax + 1>, kNodesMax> rows_{};  // by distance from the diagonal
    std::array<double, kNodesMax> right_{};
};

/// The four nodes around a place and their shares.
struct Bilinear {
    std::array<std::size_t, 4> node;
    std::array<double, 4> share;

    Bilinear(double u, double v, std::uint32_t side) {
        const double last = side - 1.0;
        const double x = std::clamp(u, 0.0, 1.0) * last;
        const double y = std::clamp(v, 0.0, 1.0) * last;
        const double column = std::min(std::floor(x), last - 1.0);
        const double row = std::min(std::floor(y), last - 1.0);
        const double s = x - column;
        const double t = y - row;
        const auto first = static_cast<std::size_t>(row) * side + static_cast<std::size_t>(column);
        node = {first, first + 1, first + side, first + side + 1};
        share = {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
    }
    [[nodiscard]] double of(std::span<const double> heights) const {
        return share[0] * heights[node[0]] + share[1] * heights[node[1]] +
               (share[2] * heights[node[2]] + share[3] * heights[node[3]]);
    }
};

}  // namespace

PatchFitter::PatchFitter(const CellColumns& columns) : columns_(columns) {
    double lower = 0.0;  // inside in the lower half of a column more than in the upper one
    for (const CellColumn& column : columns.columns()) {
        const double middle = 0.5 * (column.enters + column.leaves);
        lower += column.wrongAt(middle, true) - column.wrongAt(middle, false);
        inside_volume_ += column.insideLength() * columns.volumePerLength();
        volume_ += (column.leaves - column.enters) * columns.volumePerLength();
    }
    outside_below_ = lower < 0.0;
    targets_.reserve(columns.columns().size());
    for (const CellColumn& column : columns.columns()) {
        targets_.push_back(targetOf(column));
    }
}

PatchFitter::Target PatchFitter::targetOf(const CellColumn& column) const {
    Target best{column.enters, Bound::kAtMost};
    double least = column.wrongAt(column.enters, outside_below_);
    if (const double wrong = column.wrongAt(column.leaves, outside_below_); wrong < least) {
        best = {column.leaves, Bound::kAtLeast};
        least = wrong;
    }
    for (const double turn : column.turns) {
        if (const double wrong = column.wrongAt(turn, outside_below_); wrong < least - 1e-12) {
            best = {turn, Bound::kExact};
            least = wrong;
        }
    }
    return best;
}

FittedPatch PatchFitter::fit(std::uint32_t side, int rounds) const {
    const std::size_t nodes = std::size_t{side} * side;
    const std::vector<CellColumn>& columns = columns_.columns();
    std::array<double, kNodesMax> store{};
    const std::span<double> heights(store.data(), nodes);
    for (int round = 0; round < rounds; ++round) {
        BandSystem system(nodes, side == 2 ? 3 : 2 * std::size_t{side});
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const Target& target = targets_[c];
            if (round == 0 && target.bound != Bound::kExact) {
                continue;
            }
            const Bilinear at(columns[c].u, columns[c].v, side);
            double weight = 1.0;
            if (round > 0) {
                const double off = at.of(heights) - target.height;
                if ((target.bound == Bound::kAtLeast && off >= 0.0) ||
                    (target.bound == Bound::kAtMost && off <= 0.0)) {
                    continue;
                }
                weight = kSmallError / (kSmallError + std::abs(off));
            }
            for (std::size_t a = 0; a < 4; ++a) {
                system.addRight(at.node[a], weight * at.share[a] * target.height);
                for (std::size_t b = 0; b <= a; ++b) {
                    system.add(at.node[a], at.node[b], weight * at.share[a] * at.share[b]);
                }
            }
        }
        const auto smooth = [&](std::size_t first, std::size_t step) {
            constexpr std::array<double, 3> kSecond = {1.0, -2.0, 1.0};
            for (std::size_t a = 0; a < 3; ++a) {
                for (std::size_t b = 0; b <= a; ++b) {
                    system.add(first + a * step, first + b * step, kSmooth * kSecond[a] * kSecond[b]);
                }
            }
        };
        for (std::size_t j = 0; j < side; ++j) {
            for (std::size_t i = 0; i + 2 < side; ++i) {
                smooth(j * side + i, 1);
                smooth(i * side + j, side);
            }
        }
        for (std::size_t i = 0; i < nodes; ++i) {
            system.add(i, i, kAnchor);
        }
        system.solve(heights);
    }
    FittedPatch fitted;
    fitted.heights = PatchHeights::of(heights, side);
    fitted.heights.decode(heights);
    for (const CellColumn& column : columns) {
        fitted.wrong += column.wrongAt(Bilinear(column.u, column.v, side).of(heights), outside_below_);
    }
    fitted.wrong *= columns_.volumePerLength();
    return fitted;
}

}  // namespace relief
