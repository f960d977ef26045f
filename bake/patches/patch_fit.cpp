// SPDX-License-Identifier: Apache-2.0
#include "bake/patches/patch_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "bake/patches/lanes.h"

namespace relief {
namespace {

/// Weight of second differences relative to a column: continues the patch straight where no column constrains it.
constexpr double kSmooth = 3e-4;
constexpr double kAnchor = 1e-5;
/// A plane provides no heights if its cosine to the axis of the frame is below this.
constexpr double kSteep = 0.1;
/// All errors below this have the same weight, in units of w.
constexpr float kSmallError = 4e-3F;

/// A symmetric system for kSide² heights. The bilinear basis couples a node with the nodes up to one row and one
/// column ahead; second differences couple it with the nodes two rows ahead.
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
        columns_[j][i - j] += value;
    }
    void addRight(std::size_t i, double value) { right_[i] += value; }

    /// Solves by LDLᵀ, which preserves the band.
    void solve(std::array<double, kNodes>& x) {
        for (std::size_t j = 0; j < kNodes; ++j) {
            const std::array<double, kWidth>& column = columns_[j];
            const double pivot = 1.0 / column[0];
            const std::size_t count = std::min(kBand, kNodes - 1 - j);
            for (std::size_t i = 1; i <= count; ++i) {
                const double factor = column[i] * pivot;
                right_[j + i] -= factor * right_[j];
                double* const other = columns_[j + i].data();
                for (std::size_t k = 0; k <= count - i; k += 2) {
                    storeLanes(other + k, loadLanes<TwoDoubles>(other + k) -
                                              factor * loadLanes<TwoDoubles>(&column[i + k]));
                }
            }
        }
        for (std::size_t j = kNodes; j-- > 0;) {
            const std::array<double, kWidth>& column = columns_[j];
            double sum = right_[j];
            for (std::size_t i = std::min(kBand, kNodes - 1 - j); i > 0; --i) {
                sum -= column[i] * x[j + i];
            }
            x[j] = sum / column[0];
        }
    }

  private:
    static constexpr std::size_t kWidth = (kBand + 3) / 2 * 2;
    std::array<std::array<double, kWidth>, kNodes> columns_{};  // from the diagonal down, padded with zeros
    std::array<double, kNodes> right_{};
};

/// kSide² heights evaluated on the lines of a grid, four at a time.
template <std::size_t kSide>
class HeightLanes {
  public:
    static constexpr std::size_t kSquares = kSide - 1;  // along a side

    HeightLanes(const LineGrid& grid, const std::array<double, kSide * kSide>& heights)
        : lines_(grid.across() / kSquares),
          quarter_(grid.across() / kLanes),
          per_line_(1.0F / static_cast<float>(lines_)) {
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            first_[lane] = static_cast<float>(lane % (kLanes / kSquares) * quarter_) + kOffset;
            const std::size_t square = squareOf(lane);
            for (std::size_t row = 0; row < kSide; ++row) {
                left_[row][lane] = static_cast<float>(heights[row * kSide + square]);
                right_[row][lane] = static_cast<float>(heights[row * kSide + square + 1]);
            }
        }
    }

    [[nodiscard]] static constexpr std::size_t squareOf(std::size_t lane) { return lane * kSquares / kLanes; }
    /// Lines along a side of a square.
    [[nodiscard]] std::size_t lines() const { return lines_; }
    /// Lines in a quarter of a row.
    [[nodiscard]] std::size_t quarter() const { return quarter_; }
    /// The weight of the second height of a square for its index-th row of lines.
    [[nodiscard]] float rowShare(std::size_t index) const {
        return (static_cast<float>(index) + kOffset) * per_line_;
    }
    /// The weights of the second height for the index-th lanes of a row.
    [[nodiscard]] Lanes shares(std::size_t index) const {
        return (first_ + static_cast<float>(index)) * per_line_;
    }

    /// The heights along a row of lines.
    struct Row {
        Lanes left;
        Lanes rise;
        [[nodiscard]] Lanes at(Lanes shares) const { return left + shares * rise; }
    };
    /// \param square  index of the row of squares.
    [[nodiscard]] Row row(std::size_t square, float share) const {
        const Lanes left = left_[square] + share * (left_[square + 1] - left_[square]);
        const Lanes right = right_[square] + share * (right_[square + 1] - right_[square]);
        return {left, right - left};
    }

    /// The height on one line.
    [[nodiscard]] float operator[](std::size_t line) const {
        const std::size_t in_row = line % (kLanes * quarter_);
        const std::size_t j = line / (kLanes * quarter_);
        return row(j / lines_, rowShare(j % lines_)).at(shares(in_row / kLanes))[in_row % kLanes];
    }

    /// Calls visit(line, heights) for each group of four lines, in order, with the index of the first.
    template <class Visit>
    void forEach(const Visit& visit) const {
        std::size_t line = 0;
        for (std::size_t square = 0; square < kSquares; ++square) {
            for (std::size_t j = 0; j < lines_; ++j) {
                const Row across = row(square, rowShare(j));
                for (std::size_t i = 0; i < quarter_; ++i, line += kLanes) {
                    visit(line, across.at(shares(i)));
                }
            }
        }
    }

  private:
    static constexpr auto kOffset = static_cast<float>(LineGrid::kOffset);

    std::size_t lines_;
    std::size_t quarter_;
    float per_line_;
    Lanes first_;        // position of the first lanes in their squares, in lines
    Lanes left_[kSide];  // by row of heights: the left height of each lane's square
    Lanes right_[kSide];
};

/// Sums over lines between two heights, by products of their weights.
struct RowSums {
    Lanes square[3] = {};  // first · first, first · second, second · second
    Lanes right[2] = {};
};

/// Returns the heights of a plane; zeros if the plane is too steep in the frame.
template <std::size_t kSide>
std::array<double, kSide * kSide> heightsOf(const PatchFrame& frame, const CellPlane& plane) {
    std::array<double, kSide * kSide> heights{};
    const CubeAxes axes(frame);
    const glm::dvec3 rises = plane.normal * axes.by;
    if (std::abs(rises.z) < kSteep * length(axes.by[2])) {
        return heights;
    }
    const double at_origin = plane.at(axes.origin);
    for (std::size_t i = 0; i < heights.size(); ++i) {
        const double u = static_cast<double>(i % kSide) / (kSide - 1);
        const double v = static_cast<double>(i / kSide) / (kSide - 1);
        heights[i] = -(at_origin + rises.x * u + rises.y * v) / rises.z;
    }
    return heights;
}

/// One round of least squares.
/// \param anchors  the heights where neither lines nor smoothness constrain them.
/// \param weighted  by the errors of `heights` from the previous round.
template <std::size_t kSide>
void fitRound(const LineGrid& grid, const HeightTargets& targets,
              const std::array<double, kSide * kSide>& anchors, bool weighted,
              std::array<double, kSide * kSide>& heights) {
    static const HeightSystem<kSide> kEmpty;
    HeightSystem<kSide> system = kEmpty;
    const HeightLanes<kSide> before(grid, heights);
    // Solves for the heights relative to the anchors. This is exact for a plane, no matter how few lines meet it.
    const HeightLanes<kSide> anchored(grid, anchors);
    std::size_t line = 0;
    for (std::size_t square = 0; square + 1 < kSide; ++square) {
        RowSums lower;        // products of weights in the lower row of heights
        RowSums upper;        // the same in the upper row
        Lanes mixed[3] = {};  // products of a weight in each row
        for (std::size_t j = 0; j < before.lines(); ++j) {
            const float t = before.rowShare(j);
            const auto row = before.row(square, t);
            const auto anchor = anchored.row(square, t);
            RowSums sum;
            for (std::size_t i = 0; i < before.quarter(); ++i, line += kLanes) {
                const auto height = loadLanes<Lanes>(targets.height(line));
                const auto above = loadLanes<Lanes>(targets.above(line));
                const auto below = loadLanes<Lanes>(targets.below(line));
                const Lanes s = before.shares(i);
                Lanes weight = above * below;
                if (weighted) {
                    const Lanes off = row.at(s) - height;
                    weight = (off > 0.0F ? above : below) * (kSmallError / (kSmallError + absLanes(off)));
                }
                const Lanes second = weight * s;
                const Lanes first = weight - second;
                const Lanes both = first * s;
                sum.square[0] += first - both;
                sum.square[1] += both;
                sum.square[2] += second - both;
                const Lanes above_anchor = height - anchor.at(s);
                sum.right[0] += first * above_anchor;
                sum.right[1] += second * above_anchor;
            }
            for (std::size_t k = 0; k < 3; ++k) {
                const Lanes once = t * sum.square[k];
                const Lanes twice = t * once;
                upper.square[k] += twice;
                mixed[k] += once - twice;
                lower.square[k] += sum.square[k] - 2.0F * once + twice;
            }
            for (std::size_t k = 0; k < 2; ++k) {
                const Lanes once = t * sum.right[k];
                upper.right[k] += once;
                lower.right[k] += sum.right[k] - once;
            }
        }
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const std::size_t node = square * kSide + before.squareOf(lane);
            const auto add = [&](std::size_t a, const RowSums& sums) {
                system.add(a, a, double{sums.square[0][lane]});
                system.add(a + 1, a, double{sums.square[1][lane]});
                system.add(a + 1, a + 1, double{sums.square[2][lane]});
                system.addRight(a, double{sums.right[0][lane]});
                system.addRight(a + 1, double{sums.right[1][lane]});
            };
            add(node, lower);
            add(node + kSide, upper);
            system.add(node + kSide, node, double{mixed[0][lane]});
            system.add(node + kSide, node + 1, double{mixed[1][lane]});
            system.add(node + kSide + 1, node, double{mixed[1][lane]});
            system.add(node + kSide + 1, node + 1, double{mixed[2][lane]});
        }
    }
    system.solve(heights);
    for (std::size_t i = 0; i < heights.size(); ++i) {
        heights[i] += anchors[i];
    }
}

template <std::size_t kSide>
PatchHeights coded(std::array<double, kSide * kSide>& heights) {
    const PatchHeights codes = PatchHeights::of(heights, kSide);
    codes.decode(heights);
    return codes;
}

/// The length up to `w` that should lie between the surfaces of a pair.
double betweenTo(const CellColumn& column, double w, bool walls) {
    const double inside = column.insideTo(w);
    return walls ? inside : w - column.enters - inside;
}

/// The part of a line that should lie between the surfaces of a pair.
struct Part {
    double begin = 0.0;
    double end = 0.0;
    double gain = 0.0;  // relative to no part; 0: no part is best
};

Part bestPart(const CellColumn& column, const ErrorCosts& costs, bool walls) {
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

PatchFitter::PatchFitter(const CellColumns& columns, const ErrorCosts& costs, const CellPlane& mean,
                         std::optional<bool> outside_below)
    : columns_(columns), costs_(costs), mean_(mean), targets_(columns.grid().lines().size()) {
    const std::vector<double>& lengths = columns.grid().lengths();
    std::array<double, kLanes> inside{};
    for (std::size_t i = 0; i < lengths.size(); i += kLanes) {
        for (std::size_t k = 0; k < kLanes; ++k) {
            inside[k] += double{columns.inside()[i + k]} * lengths[i + k];
        }
    }
    double lower = 0.0;  // excess of the inside in the lower half of each column over the upper half
    for (const std::uint32_t line : columns.turning()) {
        const CellColumn column = columns[line];
        const double middle = 0.5 * (column.enters + column.leaves);
        double half = 0.0;
        double all = 0.0;
        if (const double turn = column.turns[0]; column.turns.size() > 1) {
            half = column.insideTo(middle);
            all = column.insideTo(column.leaves);
        } else if (column.inside) {
            half = std::min(turn, middle) - column.enters;
            all = turn - column.enters;
        } else {
            half = std::max(0.0, middle - turn);
            all = column.leaves - turn;
        }
        lower += 2.0 * half - all;
        inside[0] += all - double{columns.inside()[line]} * lengths[line];
    }
    inside_volume_ = ((inside[0] + inside[1]) + (inside[2] + inside[3])) * columns.grid().volumePerLength();
    outside_below_ = outside_below.value_or(lower < 0.0);
    setTargetsWithoutTurns();
    for (const std::uint32_t line : columns.turning()) {
        bool by_error = true;
        targets_.set(line, targetOf(columns[line], by_error));
        if (!by_error) {
            by_error_.resize(lengths.size(), 1.0F);
            by_error_[line] = 0.0F;
            not_by_error_.push_back(line);
        }
    }
}

void PatchFitter::setTargetsWithoutTurns() {
    const LineGrid& grid = columns_.grid();
    const auto above = static_cast<float>(outside_below_ ? costs_.false_outside : costs_.false_inside);
    const auto below = static_cast<float>(outside_below_ ? costs_.false_inside : costs_.false_outside);
    const Lanes none{};
    for (std::size_t line = 0; line < grid.lines().size(); line += kLanes) {
        const auto enters = loadLanes<Lanes>(&grid.enters()[line]);
        const auto leaves = loadLanes<Lanes>(&grid.leaves()[line]);
        const auto inside = loadLanes<Lanes>(&columns_.inside()[line]);
        const auto low = inside == (outside_below_ ? 1.0F : 0.0F);
        const auto meets = leaves > enters;
        storeLanes(targets_.height(line), low ? enters : leaves);
        storeLanes(targets_.above(line), (low & meets) ? allLanes(above) : none);
        storeLanes(targets_.below(line), (~low & meets) ? allLanes(below) : none);
    }
}

HeightTarget PatchFitter::targetOf(const CellColumn& column, bool& by_error) const {
    const double above = outside_below_ ? costs_.false_outside : costs_.false_inside;
    const double below = outside_below_ ? costs_.false_inside : costs_.false_outside;
    if (column.turns.size() == 1 && column.inside != outside_below_) {
        return {column.turns[0], above, below};
    }
    HeightTarget best{.height = column.enters, .above = above};
    double least = column.wrongAt(column.enters, outside_below_, costs_);
    if (const double wrong = column.wrongAt(column.leaves, outside_below_, costs_); wrong < least) {
        best = {.height = column.leaves, .below = below};
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
    const HeightLanes<kSide> on_lines(grid, heights);
    Lanes sums{};
    on_lines.forEach([&](std::size_t line, Lanes height) {
        const Lanes held = clampLanes(height, loadLanes<Lanes>(&grid.enters()[line]),
                                      loadLanes<Lanes>(&grid.leaves()[line]));
        const Lanes off = held - loadLanes<Lanes>(targets_.height(line));
        const Lanes cost =
            off > 0.0F ? loadLanes<Lanes>(targets_.above(line)) : loadLanes<Lanes>(targets_.below(line));
        const Lanes wrong = cost * absLanes(off);
        sums += by_error_.empty() ? wrong : loadLanes<Lanes>(&by_error_[line]) * wrong;
    });
    double wrong = double{sumOfLanes(sums)};
    for (const std::uint32_t line : not_by_error_) {
        wrong += columns_[line].wrongAt(double{on_lines[line]}, outside_below_, costs_);
    }
    return wrong * grid.volumePerLength();
}

template <std::size_t kSide>
FittedPatch PatchFitter::fitOf(int rounds) const {
    const std::array<double, kSide* kSide> anchors = heightsOf<kSide>(columns_.grid().frame(), mean_);
    std::array<double, kSide * kSide> heights{};
    for (int round = 0; round < rounds; ++round) {
        fitRound<kSide>(columns_.grid(), targets_, anchors, round > 0, heights);
    }
    FittedPatch fitted;
    fitted.heights = coded<kSide>(heights);
    fitted.wrong = wrongOf<kSide>(heights);
    return fitted;
}

FittedPatch PatchFitter::fit(std::uint32_t side, int rounds) const {
    return side == 2 ? fitOf<2>(rounds) : side == 3 ? fitOf<3>(rounds) : fitOf<5>(rounds);
}

PairFitter::PairFitter(const CellColumns& columns, const ErrorCosts& costs, const glm::dvec3& normal,
                       std::optional<bool> walls)
    : columns_(columns),
      normal_(normal),
      targets_{HeightTargets(columns.grid().lines().size()), HeightTargets(columns.grid().lines().size())} {
    const std::vector<LineGrid::Line>& lines = columns.grid().lines();
    const auto leastOf = [&](bool of_walls) {
        const ErrorCosts between = of_walls ? costs : ErrorCosts{costs.false_outside, costs.false_inside};
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
    costs_ = walls_ ? costs : ErrorCosts{costs.false_outside, costs.false_inside};
    for (std::uint32_t i = 0; i < lines.size(); ++i) {
        if (lines[i].misses()) {
            continue;
        }
        const CellColumn column = columns[i];
        const Part part = bestPart(column, costs_, walls_);
        if (part.gain > 0.0) {
            targets_[0].set(i, {part.begin, costs_.false_outside,
                                part.begin > column.enters ? costs_.false_inside : 0.0});
            targets_[1].set(
                i, {part.end, part.end < column.leaves ? costs_.false_inside : 0.0, costs_.false_outside});
        } else {
            without_.push_back(i);
        }
    }
}

/// The plane with the given normal, shifted to the mean height of a surface.
template <std::size_t kSide>
std::array<double, kSide * kSide> PairFitter::anchorsOf(std::size_t surface) const {
    std::array<double, kSide* kSide> anchors = heightsOf<kSide>(columns_.grid().frame(), {normal_, 0.0});
    const HeightLanes<kSide> on_lines(columns_.grid(), anchors);
    const HeightTargets& targets = targets_[surface];
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < columns_.grid().lines().size(); ++i) {
        if (*targets.above(i) > 0.0F && *targets.below(i) > 0.0F) {
            sum += double{*targets.height(i)} - double{on_lines[i]};
            ++count;
        }
    }
    for (double& height : anchors) {
        height += count > 0 ? sum / count : 0.0;
    }
    return anchors;
}

template <std::size_t kSide>
FittedPair PairFitter::fitOf(int rounds) const {
    const LineGrid& grid = columns_.grid();
    std::array<HeightTargets, 2> targets = targets_;
    const std::array<std::array<double, kSide * kSide>, 2> anchors = {anchorsOf<kSide>(0),
                                                                      anchorsOf<kSide>(1)};
    std::array<std::array<double, kSide * kSide>, 2> heights{};
    std::array<std::vector<float>, 2> on_lines;
    const auto lay = [&] {
        for (std::size_t k = 0; k < 2; ++k) {
            on_lines[k].resize(grid.lines().size());
            HeightLanes<kSide>(grid, heights[k]).forEach([&](std::size_t line, Lanes height) {
                storeLanes(&on_lines[k][line], height);
            });
        }
    };
    for (int round = 0; round < rounds; ++round) {
        if (round > 0) {
            // Both surfaces meet halfway where nothing should lie between them.
            lay();
            for (const std::uint32_t i : without_) {
                const LineGrid::Line& line = grid.lines()[i];
                const double low = std::clamp(double{on_lines[0][i]}, line.enters, line.leaves);
                const double high = std::clamp(double{on_lines[1][i]}, line.enters, line.leaves);
                const double cost = high > low ? costs_.false_inside : 0.0;
                targets[0].set(i, {0.5 * (low + high), 0.0, cost});
                targets[1].set(i, {0.5 * (low + high), cost, 0.0});
            }
        }
        for (std::size_t k = 0; k < 2; ++k) {
            fitRound<kSide>(grid, targets[k], anchors[k], round > 0, heights[k]);
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
        const double low = std::clamp(double{on_lines[0][i]}, column.enters, column.leaves);
        const double high = std::max(low, std::clamp(double{on_lines[1][i]}, column.enters, column.leaves));
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
