// SPDX-License-Identifier: Apache-2.0
#include "bake/ground/ground_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "bake/ground/column_ranges.h"
#include "bake/mesh/loops.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

/// Depth of the ground below its lowest point, relative to the longest side.
constexpr double kGroundDepth = 0.05;
/// Patches store heights up to this distance from the bottom of their cell, in units of its side, and slightly beyond.
constexpr double kStoredHeightMax = 3.99;
/// Number of test positions along each axis of a steep cell, at which its two approximations are compared.
constexpr int kTestPositions = 8;
/// The frame of all patches: depth along y.
constexpr PatchFrame kUp{0, 1, 0};
constexpr int kBasesPerCell = 512;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
/// Cells along an axis that floats can distinguish, with a margin for positions within each.
constexpr double kCellsMax = 1 << 20;

/// A cell with a record. Its indices count cells of its level: x and z from the grid's first sample, y from height 0.
struct Cell {
    std::uint32_t x = 0;
    std::int32_t y = 0;
    std::uint32_t z = 0;
    std::uint8_t level = 0;
    PatchRecord::Kind kind = PatchRecord::Kind::kOutside;
    std::uint8_t children = 0;  ///< for a split cell: masks
    std::uint8_t inside = 0;
    bool owner = false;  ///< for a patch: it writes the heights that others share
    /// For a split cell: index of its first child; for a patch: index of its heights.
    std::uint32_t first = 0;
};

class GroundTree {
  public:
    GroundTree(const HeightGrid& grid, const GroundPlace& place)
        : grid_(grid),
          place_(place),
          leaf_level_(place.leaf_level),
          square_level_(leaf_level_ + 2),
          last_level_(square_level_ + 1),
          root_squares_(kLeafSquares << leaf_level_),
          ranges_(grid, leaf_level_ + 1) {}

    Result<Ground> run() {
        if (!findRange()) {
            return Ground();
        }
        RELIEF_TRY(placeRoots());
        RELIEF_TRY(splitCells());
        writeMap();
        return std::move(ground_);
    }

  private:
    [[nodiscard]] double cellSize(unsigned level) const {
        return place_.spacing * root_squares_ / static_cast<double>(1U << level);
    }
    /// Returns the squares along the side of a cell; also 1 for half a square, which has no heights of its own.
    [[nodiscard]] std::uint32_t squaresOf(unsigned level) const {
        return std::max(root_squares_ >> level, 1U);
    }

    /// \param x, z  cells of a level, from the first sample.
    [[nodiscard]] double heightAt(unsigned level, std::size_t x, std::size_t z) const {
        if (level <= square_level_) {
            return grid_.at(x * squaresOf(level), z * squaresOf(level));
        }
        const auto at = [&](std::size_t i, std::size_t j) { return double{grid_.at(i, j)}; };
        const std::size_t x1 = (x + 1) / 2;
        const std::size_t z1 = (z + 1) / 2;
        return 0.25 * ((at(x / 2, z / 2) + at(x1, z / 2)) + (at(x / 2, z1) + at(x1, z1)));
    }

    [[nodiscard]] ColumnRange columnOf(unsigned level, std::uint32_t x, std::uint32_t z) const {
        if (level <= leaf_level_) {
            return ranges_.at(leaf_level_ - level, x, z);
        }
        if (level <= square_level_) {
            return ranges_.ofSquares(std::size_t{x} * squaresOf(level), std::size_t{z} * squaresOf(level),
                                     squaresOf(level));
        }
        ColumnRange half = ranges_.ofSquares(x / 2, z / 2, 1);
        if (half.ground) {
            const std::array<double, 4> corners = {heightAt(level, x, z), heightAt(level, x + 1, z),
                                                   heightAt(level, x, z + 1), heightAt(level, x + 1, z + 1)};
            half.low = static_cast<float>(*std::ranges::min_element(corners));
            half.high = static_cast<float>(*std::ranges::max_element(corners));
        }
        return half;
    }

    /// Returns whether any square has ground.
    bool findRange() {
        ColumnRange all;
        for (std::uint32_t z = 0; z < ranges_.depth(leaf_level_); ++z) {
            for (std::uint32_t x = 0; x < ranges_.width(leaf_level_); ++x) {
                add(all, ranges_.at(leaf_level_, x, z));
            }
        }
        if (!all.ground) {
            return false;
        }
        low_ = place_.heights ? std::min(double{all.low}, place_.heights->x) : double{all.low};
        high_ = place_.heights ? std::max(double{all.high}, place_.heights->y) : double{all.high};
        const glm::dvec3 size(place_.spacing * (grid_.columns - 1), 0.0, place_.spacing * (grid_.rows - 1));
        ground_.bounds.min = glm::vec3(place_.origin + glm::dvec3(0.0, low_, 0.0));
        ground_.bounds.max = glm::vec3(place_.origin + glm::dvec3(size.x, high_, size.z));
        deepest_ = low_ - kGroundDepth * std::max({size.x, high_ - low_, size.z});
        return true;
    }

    Result<void> placeRoots() {
        const double root = cellSize(0);
        const double single = cellSize(last_level_);
        if (!(std::max(std::abs(deepest_), std::abs(high_)) < kFloatSteps * place_.spacing)) {
            return fail(ErrorCode::kLimit,
                        "its heights are too far from 0 for floats to resolve its spacing; shift them by "
                        "--heights low and high, or give a larger spacing");
        }
        if (!(std::max(std::abs(deepest_), std::abs(high_)) < kCellsMax * root &&
              (high_ - deepest_) / single < kCellsMax)) {
            return tooLarge("its heights are so far apart");
        }
        bottom_ = static_cast<std::int32_t>(std::floor(deepest_ / root));
        const auto top = static_cast<std::int32_t>(std::floor(high_ / root)) + 1;
        roots_ = {ranges_.width(leaf_level_), static_cast<std::uint32_t>(top - bottom_),
                  ranges_.depth(leaf_level_)};
        const std::uint64_t count = std::uint64_t{roots_.x} * roots_.y * roots_.z;
        if (std::max({roots_.x, roots_.y, roots_.z}) > 0xffffU || count >= kPatchTexelsMax) {
            return tooLarge("it has so many samples");
        }
        return {};
    }

    [[nodiscard]] tl::unexpected<Error> tooLarge(const std::string& why) const {
        return fail(ErrorCode::kLimit,
                    why + " that the tree exceeds " + std::to_string(kPatchTexelsMax) +
                        " texels of 8 bytes; bake tiles with --world (smaller ones with --heights "
                        "tile=), or give a larger spacing or a smaller range of heights");
    }

    /// Classifies a cell. Returns kSplit if one patch cannot represent its column.
    [[nodiscard]] PatchRecord::Kind kindOf(const Cell& cell, const ColumnRange& column) const {
        const double size = cellSize(cell.level);
        if (!column.ground || !(double{column.high} > size * cell.y)) {
            return PatchRecord::Kind::kOutside;
        }
        const bool fits = double{column.high} - double{column.low} <= kSteepest * size;
        // The next leaf below the surface shares its heights; otherwise points that enter it would hit the planes of
        // many leaves.
        const double margin =
            cell.level == last_level_ && !fits ? 0.0 : cellSize(std::max(unsigned{cell.level}, leaf_level_));
        if (!column.hole && double{column.low} >= size * (cell.y + 1.0) + margin) {
            return PatchRecord::Kind::kInside;
        }
        const bool patch = cell.level == last_level_ || (cell.level >= leaf_level_ && !column.hole && fits);
        return patch ? PatchRecord::Kind::kPatch : PatchRecord::Kind::kSplit;
    }

    Result<void> splitCells() {
        forEachPoint(glm::uvec3(0), roots_, [&](const glm::uvec3& at) {
            Cell cell{.x = at.x, .y = bottom_ + static_cast<std::int32_t>(at.y), .z = at.z};
            cell.kind = kindOf(cell, columnOf(0, at.x, at.z));
            cells_.push_back(cell);
        });
        shared_.assign(std::size_t{ranges_.width(0)} * ranges_.depth(0), kNone);
        for (std::size_t i = 0; i < cells_.size(); ++i) {
            if (cells_[i].kind == PatchRecord::Kind::kSplit) {
                split(i);
            } else if (cells_[i].kind == PatchRecord::Kind::kPatch) {
                placeHeights(cells_[i]);
            }
            if (1 + cells_.size() + std::size_t{height_texels_} > kPatchTexelsMax) {
                return tooLarge("it has so many samples, or rises so steeply,");
            }
        }
        return {};
    }

    void split(std::size_t i) {
        Cell parent = cells_[i];
        parent.first = static_cast<std::uint32_t>(cells_.size());
        levels_ = std::max(levels_, parent.level + 1U);
        for (unsigned octant = 0; octant < 8; ++octant) {
            Cell child{.x = 2 * parent.x + (octant & 1U),
                       .y = 2 * parent.y + static_cast<std::int32_t>(octant >> 1U & 1U),
                       .z = 2 * parent.z + (octant >> 2U)};
            child.level = static_cast<std::uint8_t>(parent.level + 1);
            child.kind = kindOf(child, columnOf(child.level, child.x, child.z));
            const auto bit = static_cast<std::uint8_t>(1U << octant);
            if (child.kind == PatchRecord::Kind::kInside) {
                parent.inside |= bit;
            } else if (child.kind != PatchRecord::Kind::kOutside) {
                parent.children |= bit;
                cells_.push_back(child);
            }
        }
        cells_[i] = parent;
    }

    void placeHeights(Cell& cell) {
        std::uint32_t own = kNone;
        std::uint32_t& place =
            cell.level == leaf_level_ ? shared_[std::size_t{cell.z} * ranges_.width(0) + cell.x] : own;
        cell.owner = place == kNone;
        if (cell.owner) {
            place = height_texels_;
            height_texels_ += heightTexels(squaresOf(cell.level) + 1);
        }
        cell.first = place;
    }

    /// Returns the heights of a patch above its cell's bottom, in units of its side. Cells of a column share codes and
    /// scale.
    [[nodiscard]] PatchHeights heightsOf(const Cell& cell, bool& steep) const {
        const double size = cellSize(cell.level);
        const std::uint32_t across = cell.level <= square_level_ ? squaresOf(cell.level) : 1;
        const unsigned samples =
            std::max(unsigned{cell.level}, square_level_);  // the level of single heights
        std::array<double, std::size_t{kPatchSideMax} * kPatchSideMax> heights{};
        double low = std::numeric_limits<double>::max();
        double high = -low;
        std::size_t count = 0;
        for (std::uint32_t x = 0; x <= across; ++x) {
            for (std::uint32_t z = 0; z <= across; ++z) {  // u is along z, and fastest
                const double height =
                    heightAt(samples, std::size_t{cell.x} * across + x, std::size_t{cell.z} * across + z);
                low = std::min(low, height);
                high = std::max(high, height);
                heights[count++] = height / size;
            }
        }
        steep = high - low > kSteepest * size;
        const double from = steep ? double(cell.y) : std::floor(low / size);
        for (double& height : heights) {
            height -= from;
        }
        if (steep) {
            std::array<double, 4> corners = {heights[0], heights[1], heights[2], heights[3]};
            corners = approximationOf(corners);
            std::copy(corners.begin(), corners.end(), heights.begin());
        }
        PatchHeights patch = PatchHeights::of(std::span(heights).first(count), across + 1);
        patch.base -= kBasesPerCell * (cell.y - static_cast<int>(from));
        return patch;
    }

    /// Approximates the heights of a steep cell by heights that a patch can store. Clamped heights preserve its gentle
    /// edges. Heights scaled towards the cell's middle preserve the line where the surface crosses the middle. The
    /// approximation with the smaller error is used.
    [[nodiscard]] static std::array<double, 4> approximationOf(const std::array<double, 4>& heights) {
        std::array<double, 4> clamped = heights;
        std::array<double, 4> scaled = heights;
        double most = 0.0;
        for (const double height : heights) {
            most = std::max(most, std::abs(height - 0.5));
        }
        for (std::size_t i = 0; i < 4; ++i) {
            clamped[i] = std::clamp(heights[i], -kStoredHeightMax, kStoredHeightMax);
            scaled[i] = 0.5 + (heights[i] - 0.5) * std::min((kStoredHeightMax - 0.5) / most, 1.0);
        }
        int clamped_errors = 0;
        int scaled_errors = 0;
        for (int place = 0; place < kTestPositions * kTestPositions * kTestPositions; ++place) {
            const auto at = [&](int i) { return (i % kTestPositions + 0.5) / kTestPositions; };
            const double s = at(place);
            const double t = at(place / kTestPositions);
            const double w = at(place / (kTestPositions * kTestPositions));
            const auto inside = [&](const std::array<double, 4>& h) {
                const double lower = h[0] + s * (h[1] - h[0]);
                return w < lower + t * (h[2] + s * (h[3] - h[2]) - lower);
            };
            const bool right = inside(heights);
            clamped_errors += inside(clamped) != right ? 1 : 0;
            scaled_errors += inside(scaled) != right ? 1 : 0;
        }
        return clamped_errors < scaled_errors ? clamped : scaled;
    }

    /// The surface of a column as a plane through the middle of its square.
    struct Plane {
        glm::dvec3 normal{0.0, 1.0, 0.0};
        double height = 0.0;
    };
    [[nodiscard]] Plane planeOf(const Cell& cell) const {
        const std::uint32_t squares = squaresOf(cell.level);
        const std::size_t x0 = std::size_t{cell.x} * squares;
        const std::size_t z0 = std::size_t{cell.z} * squares;
        const std::size_t x1 = std::min<std::size_t>(x0 + squares, grid_.columns - 1);
        const std::size_t z1 = std::min<std::size_t>(z0 + squares, grid_.rows - 1);
        const double a = grid_.at(x0, z0);
        const double b = grid_.at(x1, z0);
        const double c = grid_.at(x0, z1);
        const double d = grid_.at(x1, z1);
        const double middle = 0.25 * ((a + b) + (c + d));
        if (std::isnan(middle)) {
            const ColumnRange column = columnOf(cell.level, cell.x, cell.z);
            return {{0.0, 1.0, 0.0}, 0.5 * (double{column.low} + double{column.high})};
        }
        const double by_x = 0.5 * ((b - a) + (d - c)) / (place_.spacing * static_cast<double>(x1 - x0));
        const double by_z = 0.5 * ((c - a) + (d - b)) / (place_.spacing * static_cast<double>(z1 - z0));
        const double per_length = 1.0 / std::sqrt(1.0 + (by_x * by_x + by_z * by_z));
        return {{-by_x * per_length, per_length, -by_z * per_length}, middle};
    }

    [[nodiscard]] PatchRecord flatOf(const Cell& cell) const {
        const bool inside = cell.kind == PatchRecord::Kind::kInside;
        if (!columnOf(cell.level, cell.x, cell.z).ground) {
            return PatchRecord::flat(false, {0.0F, 1.0F, 0.0F}, 1.0F);
        }
        const Plane plane = planeOf(cell);
        const double away = (cell.y + 0.5 - plane.height / cellSize(0)) * plane.normal.y;
        return PatchRecord::flat(inside, glm::vec3(plane.normal),
                                 static_cast<float>(inside ? std::min(away, 0.0) : std::max(away, 0.0)));
    }

    [[nodiscard]] PatchRecord splitOf(const Cell& cell) const {
        const Plane plane = planeOf(cell);
        const double away = (cell.y + 0.5 - plane.height / cellSize(cell.level)) * plane.normal.y;
        return PatchRecord::split(cell.children, cell.inside, 1 + cell.first, glm::vec3(plane.normal),
                                  static_cast<float>(std::clamp(away, -1.0, 1.0)));
    }

    void writeMap() {
        const std::size_t records = 1 + cells_.size();
        std::vector<PatchRecord> texels(records + height_texels_);
        texels[0] = {roots_.x | roots_.y << 16U, roots_.z | levels_ << 16U};
        std::vector<float> steps(cells_.size(), 0.0F);  // of patches that are not steep, object units
        forEachIndex(0, cells_.size(), 256, [&](std::size_t i) {
            const Cell& cell = cells_[i];
            if (cell.kind != PatchRecord::Kind::kPatch) {
                texels[1 + i] = cell.kind == PatchRecord::Kind::kSplit ? splitOf(cell) : flatOf(cell);
                return;
            }
            bool steep = false;
            const PatchHeights heights = heightsOf(cell, steep);
            const auto first = static_cast<std::uint32_t>(records + cell.first);
            texels[1 + i] = PatchRecord::patch(kUp, false, heights, first);
            for (std::uint32_t k = 0; cell.owner && k < heightTexels(heights.side); ++k) {
                texels[first + k] = heights.texel(k);
            }
            steps[i] = steep ? 0.0F : static_cast<float>(double{heights.step()} * cellSize(cell.level));
        });
        ground_.error_max = 0.5 * double{*std::ranges::max_element(steps)};
        countSquares();
        fillMap(texels);
    }

    void countSquares() {
        for (std::uint32_t z = 0; z + 1 < grid_.rows; ++z) {
            for (std::uint32_t x = 0; x + 1 < grid_.columns; ++x) {
                const ColumnRange square = ranges_.ofSquares(x, z, 1);
                ground_.squares += square.ground ? 1 : 0;
                const bool own =
                    x - place_.first.x < place_.squares.x && z - place_.first.y < place_.squares.y;
                const bool steep = double{square.high} - double{square.low} > kSteepest * place_.spacing;
                ground_.steep += own && steep ? 1 : 0;
            }
        }
    }

    void fillMap(const std::vector<PatchRecord>& texels) {
        DepthMap& map = ground_.map;
        const double root = cellSize(0);
        map.format = MapFormat::kPatches;
        map.decode = Decode::kPlane;
        map.object_per_map = glm::vec3(static_cast<float>(root));
        const glm::dvec3 origin = place_.origin + glm::dvec3(0.0, root * bottom_, 0.0);
        for (int axis = 0; axis < 3; ++axis) {
            map.object_to_map.row[axis] = glm::vec4(0.0F);
            map.object_to_map.row[axis][axis] = static_cast<float>(1.0 / root);
            map.object_to_map.row[axis].w = static_cast<float>(-origin[axis] / root + 0.0);  // no −0
        }
        map.setPatches(texels);
    }

    const HeightGrid& grid_;
    const GroundPlace& place_;
    /// Splits from a root down to a leaf of kLeafSquares, to a single square, and to half of a steep square.
    unsigned leaf_level_;
    unsigned square_level_;
    unsigned last_level_;
    std::uint32_t root_squares_;
    ColumnRanges ranges_;
    double low_ = 0.0;  // of the surface
    double high_ = 0.0;
    double deepest_ = 0.0;     // the ground is solid at least down to this height
    std::int32_t bottom_ = 0;  // the lowest row of roots
    glm::uvec3 roots_{0};
    std::uint32_t levels_ = 0;
    std::vector<Cell> cells_;            // in the order of their records
    std::vector<std::uint32_t> shared_;  // heights of each leaf's column; kNone: not placed yet
    std::uint32_t height_texels_ = 0;
    Ground ground_;
};

}  // namespace

Result<Ground> bakeGround(const HeightGrid& grid, const GroundPlace& place) {
    return GroundTree(grid, place).run();
}

}  // namespace relief
