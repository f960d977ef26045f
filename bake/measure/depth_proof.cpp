// SPDX-License-Identifier: Apache-2.0
#include "bake/measure/depth_proof.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "bake/mesh/loops.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

using Kind = PatchRecord::Kind;

/// Bound of the rounding errors of w − H in floats, in units of its largest operand. About 20 operations have an error
/// of 2⁻²⁴ each; the slopes of H multiply those of u and v by up to 8.
constexpr double kHeightRounding = 512.0 * 0x1p-24;
/// The same for a row of the transform to map space: three products and three sums, fused or not.
constexpr double kTransformRounding = 8.0 * 0x1p-24;
/// Bound of the rounding errors of distances in doubles.
constexpr double kDistanceRounding = 1e-9;
/// Larger coordinates and distances may overflow in floats.
constexpr double kRangeMax = 1e30;

enum class Side : std::int8_t { kInside, kOutside, kBoth };

Side sideOf(bool inside) {
    return inside ? Side::kInside : Side::kOutside;
}

/// A leaf of the tree.
struct Cell {
    glm::dvec3 low{0.0};      ///< corner, map space
    double size = 1.0;        ///< map space
    PatchRecord record;       ///< its own, or that of its split parent
    Side side = Side::kBoth;  ///< kBoth: of a patch or pair
};

/// Limit of the cells in memory, about 150 bytes each.
constexpr std::size_t kCellsMax = 4'000'000;

/// Lists all leaves of a valid tree; nullopt if there are more than kCellsMax.
std::optional<std::vector<Cell>> cellsOf(PatchTexels texels) {
    struct Node {
        glm::dvec3 low;
        double size;
        std::uint32_t texel;
    };
    const glm::uvec3 roots = patchTreeSize(texels).roots;
    if (std::uint64_t{roots.x} * roots.y * roots.z > kCellsMax) {
        return std::nullopt;
    }
    std::vector<Node> nodes;
    forEachPoint(glm::uvec3(0), roots, [&](const glm::uvec3& at) {
        nodes.push_back({glm::dvec3(at), 1.0, 1 + static_cast<std::uint32_t>(nodes.size())});
    });
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (std::max(nodes.size(), cells.size()) > kCellsMax) {
            return std::nullopt;
        }
        const Node node = nodes[i];
        const PatchRecord record = patchTexel(texels, node.texel);
        if (record.kind() != Kind::kSplit) {
            const Side side =
                record.kind() == Kind::kPatch ? Side::kBoth : sideOf(record.kind() == Kind::kInside);
            cells.push_back({node.low, node.size, record, side});
            continue;
        }
        const double half = 0.5 * node.size;
        std::uint32_t child = record.first();
        for (std::uint32_t octant = 0; octant < 8; ++octant) {
            const glm::dvec3 low = node.low + half * glm::dvec3(octant & 1U, octant >> 1U & 1U, octant >> 2U);
            if ((record.children() >> octant & 1U) != 0) {
                nodes.push_back({low, half, child++});
            } else {
                cells.push_back({low, half, record, sideOf((record.low >> (10U + octant) & 1U) != 0)});
            }
        }
    }
    return cells;
}

/// Extends an interval to a value.
void extend(LineSpan& span, double value) {
    span = {std::min(span.begin, value), std::max(span.end, value)};
}

/// The heights of a patch as a function of u and v.
class Heights {
  public:
    Heights(PatchTexels texels, const PatchRecord& patch)
        : side_(static_cast<int>(patch.side())), squares_(side_ - 1) {
        patchHeights(texels, patch).decode(values_);
    }

    [[nodiscard]] double largest() const {
        double largest = 0.0;
        for (const double value : values_) {
            largest = std::max(largest, std::abs(value));
        }
        return largest;
    }

    [[nodiscard]] double at(double u, double v) const {
        const int column = squareOf(u);
        const int row = squareOf(v);
        const double s = u * squares_ - column;
        const double t = v * squares_ - row;
        return (1.0 - t) * ((1.0 - s) * value(column, row) + s * value(column + 1, row)) +
               t * ((1.0 - s) * value(column, row + 1) + s * value(column + 1, row + 1));
    }

    /// Bounds both derivatives over a square around (u, v). \param half  half its side.
    [[nodiscard]] std::array<LineSpan, 2> slopes(double u, double v, double half) const {
        std::array<LineSpan, 2> slopes{LineSpan{1e300, -1e300}, LineSpan{1e300, -1e300}};
        const int columns = squareOf(u + half) + 1;
        const int rows = squareOf(v + half) + 1;
        // A bilinear height has its extreme slopes along the edges of its square.
        for (int row = squareOf(v - half); row <= rows; ++row) {
            for (int column = squareOf(u - half); column <= columns; ++column) {
                if (column < columns) {
                    extend(slopes[0], squares_ * (value(column + 1, row) - value(column, row)));
                }
                if (row < rows) {
                    extend(slopes[1], squares_ * (value(column, row + 1) - value(column, row)));
                }
            }
        }
        return slopes;
    }

  private:
    [[nodiscard]] int squareOf(double u) const {
        return std::clamp(static_cast<int>(std::floor(u * squares_)), 0, squares_ - 1);
    }
    [[nodiscard]] double value(int column, int row) const {
        return values_[static_cast<std::size_t>(row * side_ + column)];
    }

    int side_;
    int squares_;
    std::array<double, std::size_t{kPatchSideMax} * kPatchSideMax> values_{};
};

/// Returns the side of a patch in a box: the mean value form of w − H.
/// \param centre, half  of the box, in the unit cube of the cell.
Side patchSide(PatchTexels texels, const PatchRecord& patch, const glm::dvec3& centre, double half) {
    const Heights heights(texels, patch);
    const PatchFrame frame = patch.frame();
    const glm::dvec3 at = frame.across(centre);
    // In every frame, u and v differ by at most `half` from those of the centre.
    const auto [by_u, by_v] = heights.slopes(at.x, at.y, half);
    glm::dvec3 steepest(0.0);
    for (const double u : {by_u.begin, by_u.end}) {
        for (const double v : {by_v.begin, by_v.end}) {
            const glm::dvec3 gradient = frame.gradient(static_cast<float>(u), static_cast<float>(v));
            steepest = glm::max(steepest, glm::abs(gradient));
        }
    }
    const double change =
        half * (steepest.x + steepest.y + steepest.z) + kHeightRounding * std::max(3.0, heights.largest());
    const double above = at.z - heights.at(at.x, at.y);
    const bool outside_below = (patch.low & 16U) != 0;
    return std::abs(above) <= change ? Side::kBoth : sideOf((above < 0.0) != outside_below);
}

/// A box to examine.
struct Box {
    glm::dvec3 centre{0.0};      ///< map space
    double half = 0.5;           ///< half its side, map space
    std::uint32_t cell = 0;      ///< index
    std::uint32_t triangle = 0;  ///< a nearby triangle
    Side truth = Side::kBoth;
    float bound = 0.0F;    ///< of the depth of its wrong points, object units; 0: there are none
    float deepest = 0.0F;  ///< depth of its centre if the centre is wrong, else 0
};

class Prover {
  public:
    Prover(const MeshQuery& query, const Collider& collider, std::vector<Cell> cells)
        : query_(query),
          collider_(collider),
          texels_(collider.maps.front().texels),
          cells_(std::move(cells)) {
        const Affine& frame = collider.maps.front().object_to_map;
        offset_ = {frame.row[0].w, frame.row[1].w, frame.row[2].w};
        to_map_ = frame.linear();
        to_object_ = frame.inverse();
        for (int corner = 0; corner < 4; ++corner) {
            const glm::dvec3 way(1.0, (corner & 1) != 0 ? -1.0 : 1.0, (corner & 2) != 0 ? -1.0 : 1.0);
            radius_ = std::max(radius_, glm::length(to_object_ * way));
        }
        const glm::dvec3 roots(patchTreeSize(texels_).roots);
        for (unsigned corner = 0; corner < 8; ++corner) {
            const glm::dvec3 share(corner & 1U, corner >> 1U & 1U, corner >> 2U);
            farthest_ = glm::max(farthest_, glm::abs(objectOf(share * roots)));
        }
        double terms = 0.0;
        for (int i = 0; i < 3; ++i) {
            double sum = std::abs(offset_[i]);
            for (int k = 0; k < 3; ++k) {
                sum += std::abs(to_map_[k][i]) * farthest_[k];
            }
            terms = std::max(terms, sum);
        }
        rounding_ = radius_ * kTransformRounding * terms;
    }

    /// Whether floats represent the distances and positions of all cells.
    [[nodiscard]] bool isInRange() const {
        const double scale = double{collider_.maps.front().object_per_map.x};
        const bool distances = std::all_of(cells_.begin(), cells_.end(), [&](const Cell& cell) {
            return cell.record.kind() == Kind::kSplit || cell.record.kind() == Kind::kPatch ||
                   std::abs(double{std::bit_cast<float>(cell.record.high)}) * scale < kRangeMax;
        });
        return distances && std::isfinite(rounding_) &&
               glm::all(glm::lessThan(farthest_, glm::dvec3(kRangeMax)));
    }

    [[nodiscard]] bool rootsContainMesh() const {
        const glm::dvec3 roots(patchTreeSize(texels_).roots);
        const Bounds& box = query_.mesh().bounds;
        bool hold = true;
        for (unsigned i = 0; i < 8; ++i) {
            const glm::dvec3 q = to_map_ * glm::dvec3(box.corner(i)) + offset_;
            hold = hold && glm::all(glm::greaterThanEqual(q, glm::dvec3(0.0))) &&
                   glm::all(glm::lessThanEqual(q, roots));
        }
        return hold;
    }

    [[nodiscard]] DepthProof prove(const DepthProofOptions& options) const {
        DepthProof proof;
        const double least = options.bound_fraction_min * double{query_.mesh().bounds.longestSide()};
        std::vector<Box> boxes;
        for (const Cell& cell : cells_) {
            boxes.push_back({.centre = cell.low + 0.5 * cell.size,
                             .half = 0.5 * cell.size,
                             .cell = static_cast<std::uint32_t>(boxes.size())});
        }
        std::vector<Box> open;
        double closed = 0.0;  // the largest bound of a box that is not divided
        while (!boxes.empty()) {
            forEachIndex(0, boxes.size(), 64, [&](std::size_t i) { examine(boxes[i], proof.deepest); });
            proof.boxes += boxes.size();
            for (const Box& box : boxes) {
                if (double{box.deepest} > proof.deepest) {
                    proof.deepest = double{box.deepest};
                    proof.place = glm::vec3(objectOf(box.centre));
                }
            }
            open.insert(open.end(), boxes.begin(), boxes.end());
            const double goal = std::max(options.tolerance * proof.deepest, least);
            std::erase_if(open, [&](const Box& box) {
                const bool enough = double{box.bound} <= goal;
                closed = enough ? std::max(closed, double{box.bound}) : closed;
                return enough;
            });
            boxes = divideLargest(open, options.boxes_max - std::min(options.boxes_max, proof.boxes));
        }
        for (const Box& box : open) {
            closed = std::max(closed, double{box.bound});
        }
        proof.depth = std::max(closed, proof.deepest) + rounding_;
        return proof;
    }

  private:
    [[nodiscard]] glm::dvec3 objectOf(const glm::dvec3& in_map) const {
        return to_object_ * (in_map - offset_);
    }

    /// Removes the boxes with at least half the largest bound, and returns their octants; none if there are more than
    /// `most`. The others wait, because a deeper error may still close them.
    [[nodiscard]] static std::vector<Box> divideLargest(std::vector<Box>& open, std::uint64_t most) {
        float largest = 0.0F;
        for (const Box& box : open) {
            largest = std::max(largest, box.bound);
        }
        const auto divides = [&](const Box& box) { return box.bound >= 0.5F * largest; };
        std::vector<Box> octants;
        if (8 * static_cast<std::uint64_t>(std::count_if(open.begin(), open.end(), divides)) > most) {
            return octants;
        }
        std::erase_if(open, [&](const Box& box) {
            if (!divides(box)) {
                return false;
            }
            for (unsigned octant = 0; octant < 8; ++octant) {
                Box part = box;
                part.half *= 0.5;
                part.centre +=
                    part.half * (2.0 * glm::dvec3(octant & 1U, octant >> 1U & 1U, octant >> 2U) - 1.0);
                octants.push_back(part);
            }
            return true;
        });
        return octants;
    }

    [[nodiscard]] Side fieldOf(const Box& box) const {
        const Cell& cell = cells_[box.cell];
        if (cell.side != Side::kBoth) {
            return cell.side;
        }
        const glm::dvec3 centre = (box.centre - cell.low) / cell.size;
        const double half = box.half / cell.size;
        if (!cell.record.isPair()) {
            return patchSide(texels_, cell.record, centre, half);
        }
        const auto sideIn = [&](std::uint32_t i) {
            return patchSide(texels_, patchTexel(texels_, cell.record.first() + i), centre, half);
        };
        const Side first = sideIn(0);
        const Side second = sideIn(1);
        // One patch with outside decides an intersection; one patch with inside decides a union.
        const Side enough = (cell.record.low & 16U) != 0 ? Side::kOutside : Side::kInside;
        return first == enough || second == enough ? enough : first == second ? first : Side::kBoth;
    }

    /// \param known  errors of at most this depth need not be found.
    void examine(Box& box, double known) const {
        const glm::dvec3 exact = objectOf(box.centre);
        const glm::vec3 centre(exact);
        const double radius =
            (box.half * radius_ + glm::length(glm::dvec3(centre) - exact)) * (1.0 + kDistanceRounding);
        const ClosestPoint closest = query_.closest(centre, box.triangle);
        const double distance = closest.distance * (1.0 - kDistanceRounding);
        box.triangle = closest.triangle;
        const Side field = fieldOf(box);
        Side here = box.truth;
        if (here == Side::kBoth && (field != Side::kBoth || distance > known)) {
            here = sideOf(query_.inside(centre));
        }
        if (distance > radius) {
            box.truth = here;
        }
        const bool agree = field != Side::kBoth && field == here;
        const double bound = !agree              ? (closest.distance + radius) * (1.0 + kDistanceRounding)
                             : distance > radius ? 0.0
                                                 : radius - distance;
        // A NaN is no proof.
        box.bound = !(bound <= 0.0) ? std::nextafter(static_cast<float>(bound), kFarOutside) : 0.0F;
        const bool wrong =
            !agree && distance > known && sideOf(evaluateInside(collider_, centre).inside) != here;
        box.deepest = wrong ? static_cast<float>(distance) : 0.0F;
    }

    const MeshQuery& query_;
    const Collider& collider_;
    PatchTexels texels_;
    std::vector<Cell> cells_;
    glm::dmat3 to_map_{1.0};
    glm::dmat3 to_object_{1.0};
    glm::dvec3 offset_{0.0};
    glm::dvec3 farthest_{0.0};  // largest coordinates of the roots, object space
    double radius_ = 0.0;       // object units, of a box whose half side is 1
    double rounding_ = 0.0;     // object units, of the transform to map space
};

}  // namespace

DepthProof proveDepth(const MeshQuery& query, const Collider& collider, const DepthProofOptions& options) {
    const auto unproven = [](const char* why) { return DepthProof{.unproven = why}; };
    if (collider.maps.size() != 1 || collider.maps.front().format != MapFormat::kPatches) {
        return unproven("the collider is not one map of patches");
    }
    if (!query.watertight()) {
        return unproven("the mesh is not closed");
    }
    if (query.hasVoids()) {
        return unproven("the boundary of a filled cavity is approximate");
    }
    std::optional<std::vector<Cell>> cells = cellsOf(collider.maps.front().texels);
    if (!cells) {
        return unproven("the map has too many cells");
    }
    const Prover prover(query, collider, std::move(*cells));
    if (!prover.isInRange()) {
        return unproven("the map has coordinates or distances out of range");
    }
    if (!prover.rootsContainMesh()) {
        return unproven("the mesh reaches outside the cells of the map");
    }
    return prover.prove(options);
}

}  // namespace relief
