#include "bake/patches/patch_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace relief {
namespace {

/// Weight of second differences against a column's: where no column tells, the patch goes on straight.
constexpr double kSmooth = 3e-4;
constexpr double kAnchor = 1e-7;
/// An error below which all errors weigh the same, in units of w.
constexpr double kSmallError = 4e-3;

/// A symmetric system for kSide² heights. The bilinear basis couples a node with those up to one row and one column on, second
/// differences with those two rows on.
template <std::size_t kSide>
class HeightSystem {
  public:
    static constexpr std::size_t kNodes = kSide * kSide;
    static constexpr std::size_t kBand = kSide == 2 ? 3 : 2 * kSide;

    HeightSystem() {
        const auto smooth = [&](std::size_t first, std::size_t step) {
            constexpr std::array<double, 3> kSecond = {1.0, -2.0, 1.0};
            for (std::size_t a = 0; a < 3; ++a) {
                for (std::size_t b = 0; b <= a; ++b) {
                    add(first + a * step, first + b * step, kSmooth * kSecond[a] * kSecond[b]);
                }
            }
        };
        for (std::size_t j = 0; j < kSide; ++j) {
            for (std::size_t i = 0; i + 2 < kSide; ++i) {
                smooth(j * kSide + i, 1);
                smooth(i * kSide + j, kSide);
            }
        }
        for (std::size_t i = 0; i < kNodes; ++i) {
            add(i, i, kAnchor);
        }
    }

    void add(std::size_t i, std::size_t j, double value) {  // i >= j
        rows_[i][kBand + j - i] += value;
    }
    void addRight(std::size_t i, double value) { right_[i] += value; }

    /// By LDLᵀ, which keeps the band.
    void solve(std::array<double, kNodes>& x) {
        std::array<double, kNodes> pivots;
        std::array<double, kBand> scaled;  // a row of LD
        for (std::size_t i = 0; i < kNodes; ++i) {
            const std::size_t first = i > kBand ? i - kBand : 0;
            double* const row = &rows_[i][kBand - (i - first)];  // [j − first]
            double pivot = rows_[i][kBand];
            double right = right_[i];
            for (std::size_t j = first; j < i; ++j) {
                const std::size_t from = std::max(first, j > kBand ? j - kBand : 0);
                double sum = row[j - first];
                for (std::size_t k = from; k < j; ++k) {
                    sum -= scaled[k - first] * rows_[j][kBand + k - j];
                }
                scaled[j - first] = sum;
                row[j - first] = sum * pivots[j];
                pivot -= sum * row[j - first];
                right -= row[j - first] * x[j];
            }
            pivots[i] = 1.0 / pivot;
            x[i] = right;
        }
        for (std::size_t i = 0; i < kNodes; ++i) {
            x[i] *= pivots[i];
        }
        for (std::size_t i = kNodes; i-- > 0;) {
            for (std::size_t k = i > kBand ? i - kBand : 0; k < i; ++k) {
                x[k] -= rows_[i][kBand + k - i] * x[i];
            }
        }
    }

  private:
    std::array<std::array<double, kBand + 1>, kNodes> rows_{};  // the diagonal last
    std::array<double, kNodes> right_{};
};

/// A line's place among the heights of a row, or a row's.
struct Between {
    std::size_t first;
    double share;  // of the next one

    Between(double place, std::size_t side) {
        const double last = static_cast<double>(side) - 1.0;
        const double at = std::clamp(place, 0.0, 1.0) * last;
        first = std::min(static_cast<std::size_t>(at), side - 2);
        share = at - static_cast<double>(first);
    }
};

/// The lines of a grid in the squares between kSide² heights.
template <std::size_t kSide>
std::vector<Between> betweenOf(const LineGrid& grid) {
    std::vector<Between> between;
    for (unsigned i = 0; i < grid.across(); ++i) {
        between.emplace_back(grid.place(i), kSide);
    }
    return between;
}

/// Heights across a row of lines.
template <std::size_t kSide>
std::array<double, kSide> rowOf(const std::array<double, kSide * kSide>& heights, const Between& row) {
    std::array<double, kSide> across;
    for (std::size_t i = 0; i < kSide; ++i) {
        const double* const lower = &heights[row.first * kSide + i];
        across[i] = lower[0] + row.share * (lower[kSide] - lower[0]);
    }
    return across;
}

/// Calls visit(line, height) with the height on each line of a grid, in order.
/// \param between  betweenOf() the grid.
template <std::size_t kSide, class Visit>
void forEachHeight(std::span<const Between> between, const std::array<double, kSide * kSide>& heights,
                   const Visit& visit) {
    const std::size_t across = between.size();
    for (std::size_t j = 0; j < across; ++j) {
        const std::array<double, kSide> row = rowOf<kSide>(heights, between[j]);
        for (std::size_t i = 0; i < across; ++i) {
            const double* const first = &row[between[i].first];
            visit(j * across + i, first[0] + between[i].share * (first[1] - first[0]));
        }
    }
}

/// Sums over the lines of a row between two heights, weighted by their shares.
struct RowSums {
    double square[3] = {};  // both the first's share, one each, both the second's
    double right[2] = {};
};

/// One round of least squares.
/// \param heights  of the round before, by which errors are weighted; there is none before round 0.
template <std::size_t kSide>
void fitRound(std::span<const Between> between, std::span<const HeightTarget> targets, int round,
              std::array<double, kSide * kSide>& heights) {
    static const HeightSystem<kSide> kEmpty;
    HeightSystem<kSide> system = kEmpty;
    const std::size_t across = between.size();
    for (std::size_t j = 0; j < across; ++j) {
        const std::array<double, kSide> row = rowOf<kSide>(heights, between[j]);
        std::array<RowSums, kSide - 1> sums;
        for (std::size_t i = 0; i < across; ++i) {
            const HeightTarget& target = targets[j * across + i];
            const std::size_t first = between[i].first;
            const double s = between[i].share;
            double weight = target.above * target.below;
            if (round > 0) {
                const double off = row[first] + s * (row[first + 1] - row[first]) - target.height;
                weight =
                    (off > 0.0 ? target.above : target.below) * kSmallError / (kSmallError + std::abs(off));
            }
            RowSums& sum = sums[first];
            const double second = weight * s;
            sum.square[0] += (weight - second) * (1.0 - s);
            sum.square[1] += second * (1.0 - s);
            sum.square[2] += second * s;
            sum.right[0] += (weight - second) * target.height;
            sum.right[1] += second * target.height;
        }
        const double t = between[j].share;
        for (std::size_t i = 0; i + 1 < kSide; ++i) {
            const double* const square = sums[i].square;
            const double* const right = sums[i].right;
            const std::size_t node = between[j].first * kSide + i;
            const auto addPair = [&](std::size_t a, std::size_t b,
                                     double share) {  // of nodes in two rows
                system.add(a, b, share * square[0]);
                system.add(a, b + 1, share * square[1]);
                system.add(a + 1, b, share * square[1]);
                system.add(a + 1, b + 1, share * square[2]);
            };
            const auto addOne = [&](std::size_t a, double share, double share_right) {
                system.add(a, a, share * square[0]);
                system.add(a + 1, a, share * square[1]);
                system.add(a + 1, a + 1, share * square[2]);
                system.addRight(a, share_right * right[0]);
                system.addRight(a + 1, share_right * right[1]);
            };
            addOne(node, (1.0 - t) * (1.0 - t), 1.0 - t);
            addOne(node + kSide, t * t, t);
            addPair(node + kSide, node, t * (1.0 - t));
        }
    }
    system.solve(heights);
}

template <std::size_t kSide>
PatchHeights coded(std::array<double, kSide * kSide>& heights) {
    const PatchHeights codes = PatchHeights::of(heights, kSide);
    codes.decode(heights);
    return codes;
}

/// The length up to `w` that should lie between a pair's surfaces.
double betweenTo(const CellColumn& column, double w, bool walls) {
    const double inside = column.insideTo(w);
    return walls ? inside : w - column.enters - inside;
}

/// The best part of a line to lie between a pair's surfaces.
struct Part {
    double begin = 0.0;
    double end = 0.0;
    double gain = 0.0;  // over none; 0: none is best
};

Part bestPart(const CellColumn& column, const MistakeCosts& costs, bool walls) {
    Part best;
    double gain = 0.0;
    double begin = column.enters;
    double from = column.enters;
    bool belongs = column.inside == walls;
    const auto add = [&](double to) {
        gain += belongs ? costs.false_outside * (to - from) : -costs.false_inside * (to - from);
        from = to;
        belongs = !belongs;
        if (gain > best.gain) {
            best = {begin, to, gain};
        }
        if (gain <= 0.0) {
            gain = 0.0;
            begin = to;
        }
    };
    for (const double turn : column.turns) {
        add(turn);
    }
    add(column.leaves);
    return best;
}

}  // namespace

PatchFitter::PatchFitter(const CellColumns& columns, const MistakeCosts& costs,
                         std::optional<bool> outside_below)
    : columns_(columns), costs_(costs) {
    const std::vector<LineGrid::Line>& lines = columns.grid().lines();
    double lower = 0.0;  // inside in the lower half of a column more than in the upper one
    double length = 0.0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const CellColumn column = columns[i];
        const double half = 0.5 * (column.leaves - column.enters);
        length += 2.0 * half;
        if (column.turns.empty()) {
            inside_volume_ += column.inside ? 2.0 * half : 0.0;
            continue;
        }
        const double inside = column.insideTo(column.leaves);
        lower += 2.0 * column.insideTo(column.enters + half) - inside;
        inside_volume_ += inside;
    }
    inside_volume_ *= columns.grid().volumePerLength();
    volume_ = length * columns.grid().volumePerLength();
    outside_below_ = outside_below.value_or(lower < 0.0);
    targets_.resize(lines.size());
    by_error_.resize(lines.size(), 1);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (!lines[i].misses()) {
            bool by_error = true;
            targets_[i] = targetOf(columns[i], by_error);
            by_error_[i] = by_error ? 1 : 0;
        }
    }
}

HeightTarget PatchFitter::targetOf(const CellColumn& column, bool& by_error) const {
    const double above = outside_below_ ? costs_.false_outside : costs_.false_inside;
    const double below = outside_below_ ? costs_.false_inside : costs_.false_outside;
    const HeightTarget enters{.height = column.enters, .above = above};
    const HeightTarget leaves{.height = column.leaves, .below = below};
    if (column.turns.empty()) {
        return column.inside == outside_below_ ? enters : leaves;
    }
    if (column.turns.size() == 1 && column.inside != outside_below_) {
        return {column.turns[0], above, below};
    }
    HeightTarget best = enters;
    double least = column.wrongAt(column.enters, outside_below_, costs_);
    if (const double wrong = column.wrongAt(column.leaves, outside_below_, costs_); wrong < least) {
        best = leaves;
        least = wrong;
    }
    for (const double turn : column.turns) {
        if (const double wrong = column.wrongAt(turn, outside_below_, costs_); wrong < least - 1e-12) {
            best = {turn, above, below};
            least = wrong;
        }
    }
    by_error = false;
    return best;
}

template <std::size_t kSide>
double PatchFitter::wrongOf(const std::array<double, kSide * kSide>& heights) const {
    const LineGrid& grid = columns_.grid();
    double wrong = 0.0;
    forEachHeight<kSide>(betweenOf<kSide>(grid), heights, [&](std::size_t i, double height) {
        if (by_error_[i] != 0) {
            const LineGrid::Line& line = grid.lines()[i];
            const double off = std::clamp(height, line.enters, line.leaves) - targets_[i].height;
            wrong += (off > 0.0 ? targets_[i].above : targets_[i].below) * std::abs(off);
        } else {
            wrong += columns_[i].wrongAt(height, outside_below_, costs_);
        }
    });
    return wrong * grid.volumePerLength();
}

template <std::size_t kSide>
FittedPatch PatchFitter::fitOf(int rounds) const {
    const std::vector<Between> between = betweenOf<kSide>(columns_.grid());
    std::array<double, kSide * kSide> heights{};
    for (int round = 0; round < rounds; ++round) {
        fitRound<kSide>(between, targets_, round, heights);
    }
    FittedPatch fitted;
    fitted.heights = coded<kSide>(heights);
    fitted.wrong = wrongOf<kSide>(heights);
    return fitted;
}

FittedPatch PatchFitter::fit(std::uint32_t side, int rounds) const {
    return side == 2 ? fitOf<2>(rounds) : side == 3 ? fitOf<3>(rounds) : fitOf<5>(rounds);
}

PairFitter::PairFitter(const CellColumns& columns, const MistakeCosts& costs, std::optional<bool> walls)
    : columns_(columns) {
    const std::vector<LineGrid::Line>& lines = columns.grid().lines();
    const auto leastOf = [&](bool of_walls) {
        const MistakeCosts between = of_walls ? costs : MistakeCosts{costs.false_outside, costs.false_inside};
        double least = 0.0;
        for (std::size_t i = 0; i < lines.size(); ++i) {
            if (!lines[i].misses()) {
                const CellColumn column = columns[i];
                least += between.false_outside * betweenTo(column, column.leaves, of_walls) -
                         bestPart(column, between, of_walls).gain;
            }
        }
        return least * columns.grid().volumePerLength();
    };
    const double of_walls = leastOf(true);
    const double of_gaps = leastOf(false);
    walls_ = walls.value_or(of_walls <= of_gaps);
    least_ = walls_ ? of_walls : of_gaps;
    costs_ = walls_ ? costs : MistakeCosts{costs.false_outside, costs.false_inside};
    targets_[0].resize(lines.size());
    targets_[1].resize(lines.size());
    for (std::uint32_t i = 0; i < lines.size(); ++i) {
        if (lines[i].misses()) {
            continue;
        }
        const CellColumn column = columns[i];
        const Part part = bestPart(column, costs_, walls_);
        if (part.gain > 0.0) {
            targets_[0][i] = {part.begin, costs_.false_outside,
                              part.begin > column.enters ? costs_.false_inside : 0.0};
            targets_[1][i] = {part.end, part.end < column.leaves ? costs_.false_inside : 0.0,
                              costs_.false_outside};
        } else {
            without_.push_back(i);
        }
    }
}

template <std::size_t kSide>
FittedPair PairFitter::fitOf(int rounds) const {
    const LineGrid& grid = columns_.grid();
    const std::vector<Between> between = betweenOf<kSide>(grid);
    std::array<std::vector<HeightTarget>, 2> targets = targets_;
    std::array<std::array<double, kSide * kSide>, 2> heights{};
    std::array<std::vector<double>, 2> on_lines;
    const auto lay = [&] {
        for (std::size_t k = 0; k < 2; ++k) {
            on_lines[k].resize(grid.lines().size());
            forEachHeight<kSide>(between, heights[k],
                                 [&](std::size_t i, double height) { on_lines[k][i] = height; });
        }
    };
    for (int round = 0; round < rounds; ++round) {
        if (round > 0) {
            // Both surfaces close what lies between them where nothing should.
            lay();
            for (const std::uint32_t i : without_) {
                const LineGrid::Line& line = grid.lines()[i];
                const double low = std::clamp(on_lines[0][i], line.enters, line.leaves);
                const double high = std::clamp(on_lines[1][i], line.enters, line.leaves);
                const double cost = high > low ? costs_.false_inside : 0.0;
                targets[0][i] = {0.5 * (low + high), 0.0, cost};
                targets[1][i] = {0.5 * (low + high), cost, 0.0};
            }
        }
        for (std::size_t k = 0; k < 2; ++k) {
            fitRound<kSide>(between, targets[k], round, heights[k]);
        }
    }
    FittedPair fitted;
    for (std::size_t k = 0; k < 2; ++k) {
        fitted.heights[k] = coded<kSide>(heights[k]);
    }
    lay();
    for (std::size_t i = 0; i < grid.lines().size(); ++i) {
        if (grid.lines()[i].misses()) {
            continue;
        }
        const CellColumn column = columns_[i];
        const double low = std::clamp(on_lines[0][i], column.enters, column.leaves);
        const double high = std::max(low, std::clamp(on_lines[1][i], column.enters, column.leaves));
        const double held = betweenTo(column, high, walls_) - betweenTo(column, low, walls_);
        fitted.wrong += costs_.false_outside * (betweenTo(column, column.leaves, walls_) - held) +
                        costs_.false_inside * (high - low - held);
    }
    fitted.wrong *= grid.volumePerLength();
    return fitted;
}

FittedPair PairFitter::fit(std::uint32_t side, int rounds) const {
    return side == 2 ? fitOf<2>(rounds) : side == 3 ? fitOf<3>(rounds) : fitOf<5>(rounds);
}

}  // namespace relief
