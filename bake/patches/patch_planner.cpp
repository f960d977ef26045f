// SPDX-License-Identifier: Apache-2.0
#include "bake/patches/patch_planner.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <vector>

#include "bake/mesh/flat_faces.h"
#include "bake/mesh/loops.h"
#include "bake/patches/depth_planes.h"
#include "bake/patches/leaf_fitter.h"
#include "bake/patches/patch_encoder.h"
#include "formats/base/text.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

/// A tree spends at most this fraction of its bytes on depth planes (depth_planes.h).
constexpr double kDepthShareMax = 0.45;
/// Like kSpare, for a tree whose unused bytes are then filled with depth planes.
constexpr double kSpareForDepth = 3e-3;
/// The worth of a byte that the chosen tree leaves unused, relative to a byte of the tree.
constexpr double kSpareByte = 0.25;
/// Factor by which the worth of a byte falls from one search for depth planes to the next.
constexpr double kNextPlanes = 0.7;
/// Minimum bytes per root.
constexpr double kBytesPerRoot = 168.4;
/// PatchOptions::trial_bytes is multiplied by the ratio of the errors with 3² heights to those with 5², clamped to this
/// range. More heights in one patch help a smooth surface a lot, and cost less than eight patches.
constexpr double kTrialFactorMin = 1.2;
constexpr double kTrialFactorMax = 2.5;
constexpr std::uint32_t kLevels = 10;
constexpr int kSteps = 60;
/// Fraction of the reported progress that belongs to the search.
constexpr double kSearchShare = 0.7;
constexpr int kWorthTrials = 12;
/// A tree is large enough if it leaves less than this fraction of the bytes unused.
constexpr double kSpare = 3e-4;
/// The same for an error curve, whose largest tree only has to be near the limit.
constexpr double kSpareOfCurve = 0.3;
/// Minimum factor by which the worth of a byte grows to reach the next smaller tree.
constexpr double kByteWorthGrowth = 1.05;
/// Maximum number of cells visited per byte, a few times the number used. If a byte is worth almost nothing, as among
/// flat faces, trees would grow without limit.
constexpr double kCellsPerByte = 0.6;
/// Minimum worth of a byte below a root with a flat face, in units of the face's area times its length. At this limit,
/// the mean error of a cube is about 1e-6 of its side. Curved meshes of many triangles are not affected at any usual
/// size.
constexpr double kByteWorthMin = 2.5e-12;
/// Keeps cell boundaries away from round coordinates, where models often have walls.
constexpr double kBesideMesh = 1.01;
constexpr double kBesideRoots = 1.00137;
/// Fraction of the space between the mesh and the sides of the roots that is on the low side, per axis.
constexpr glm::dvec3 kOriginShift{0.4171, 0.5337, 0.4623};

/// Maximum number of roots of a tree by texel, unless the tree would then have too many levels.
constexpr double kRootsMax = 64.0;
/// Side of the finest cells, in texels. A feature two texels thick then has two surfaces in most cells, and spans at
/// most three.
constexpr double kTexelsPerCell = 2.0;
/// A leaf represents the surface within this fraction of the texel.
constexpr double kHeldWithin = 0.25;
/// The worth of a byte in a cell that is split no further, in texels cubed.
constexpr double kByteOfTexel = 0.005;
/// Maximum distance from the origin, in texels: a float resolves a sixteenth of a texel there.
constexpr double kDistanceInTexelsMax = 1 << 20;
constexpr int kTexelTrials = 3;
/// If a tree is to be cut, the maximum fraction of its bytes in the records of its roots.
constexpr double kRootsShare = 1.0 / 16.0;
constexpr std::size_t kManyTriangles = 256;

class Planner {
  public:
    Planner(const MeshQuery& query, const PatchOptions& options)
        : query_(query),
          faces_(flatFacesOf(query.mesh())),
          options_(options),
          held_(query.mesh().bounds),
          bytes_(static_cast<double>(options.bytes)),
          fitter_(query, options.costs, options.lines),
          depth_planes_(query, faces_) {
        if (options.roots_contain) {
            held_.add(options.roots_contain->min);
            held_.add(options.roots_contain->max);
        }
    }

    Result<PatchTree> run() {
        if (options_.texel > 0.0) {
            RELIEF_TRY(searchTexel());
            const double most = (1.0 + kDepthShareMax) * takenBytes();
            if (most > static_cast<double>(options_.tile_bytes) && !splitRoots()) {
                planTexel(texel_);
            }
            takeDepthPlanes(byteWorthOfTexel(), byteWorthOfTexel());
        } else {
            roots_.size = rootSizeByBytes();
            makeRoots();
            const double byte = reserveForDepthPlanes(chooseLowestWorth(descend(), kSpare));
            takeDepthPlanes(byte, kSpareByte * byte);
        }
        std::vector<const PatchNode*> roots;
        for (const PatchNode& node : nodes_) {
            roots.push_back(&node);
        }
        DepthMap map = encodePatches(query_, fitter_, roots_, roots, [this](double share) {
            report(kSearchShare + (1.0 - kSearchShare) * share);
        });
        return PatchTree{std::move(map), texel_};
    }

    ErrorCurve errors() {
        roots_.size = rootSizeByBytes();
        makeRoots();
        chooseLowestWorth(descend(), kSpareOfCurve);
        std::ranges::stable_sort(tried_, {}, &ErrorPoint::bytes);
        ErrorCurve curve;
        for (const ErrorPoint& tree : tried_) {
            if (curve.empty() || (tree.bytes > curve.back().bytes && tree.wrong < curve.back().wrong)) {
                curve.push_back(tree);
            }
        }
        return curve;
    }

  private:
    void report(double share) const {
        if (options_.progress) {
            const std::lock_guard lock(report_);
            options_.progress(share);
        }
    }

    /// Returns the number of roots of a given size along each axis.
    [[nodiscard]] glm::dvec3 rootsOf(double size) const {
        const glm::dvec3 room = glm::dvec3(held_.size()) / size * kBesideRoots;
        return glm::max(glm::ceil(room), glm::dvec3(1.0));
    }

    [[nodiscard]] double rootSizeByBytes() const {
        double size = kBesideMesh * static_cast<double>(held_.longestSide());
        const auto fits = [&](const glm::dvec3& n) { return n.x * n.y * n.z * kBytesPerRoot <= bytes_; };
        while (fits(rootsOf(0.95 * size))) {
            size *= 0.95;
        }
        return size;
    }

    void makeRoots() {
        const glm::dvec3 size = held_.size();
        roots_.count = glm::uvec3(rootsOf(roots_.size));
        roots_.origin =
            glm::dvec3(held_.min) - kOriginShift * (glm::dvec3(roots_.count) * roots_.size - size);
        nodes_.clear();
        nodes_.resize(std::size_t{roots_.count.x} * roots_.count.y * roots_.count.z);
        root_byte_worths_.resize(nodes_.size());
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const glm::dvec3 at(i % roots_.count.x, i / roots_.count.x % roots_.count.y,
                                i / roots_.count.x / roots_.count.y);
            nodes_[i].cell.size = roots_.size;
            nodes_[i].cell.low = roots_.origin + roots_.size * at;
        }
        const TriangleMesh& mesh = query_.mesh();
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const Bounds box = boundsOf(cornersOf(mesh, t));
            const auto cellAt = [&](const glm::vec3& p) {
                return glm::uvec3(glm::clamp(glm::floor((glm::dvec3(p) - roots_.origin) / roots_.size),
                                             glm::dvec3(0.0), glm::dvec3(roots_.count) - 1.0));
            };
            forEachPoint(cellAt(box.min), cellAt(box.max) + 1U, [&](const glm::uvec3& at) {
                MeshCell& cell =
                    nodes_[(std::size_t{at.z} * roots_.count.y + at.y) * roots_.count.x + at.x].cell;
                if (meetsUnitCube(cell.inUnit(mesh, t))) {
                    cell.triangles.push_back(t);
                }
            });
        }
        forEachIndex(0, nodes_.size(), 16, [&](std::size_t i) {
            MeshCell& cell = nodes_[i].cell;
            cell.bodies = query_.bodiesAt(glm::vec3(cell.low + cell.size * MeshCell::kKnown));
            root_byte_worths_[i] = minByteWorth(cell);
        });
    }

    /// Minimum misclassified volume, object units cubed, that a byte must save below a root; infinity without
    /// triangles. The value is shared by a root and all its descendants. A value per cell would reject a split that
    /// reveals errors missed by the lines of the cell, if the split also divides a flat face.
    [[nodiscard]] double minByteWorth(const MeshCell& cell) const {
        double least = std::numeric_limits<double>::infinity();
        for (const std::uint32_t triangle : cell.triangles) {
            const FlatFace& face = faces_[triangle];
            if (face.area > 0.0) {
                least = std::min(least, kByteWorthMin * face.area * face.length);
            }
        }
        return least;
    }

    [[nodiscard]] double trialBytes(const PatchNode& node) const {
        if (node.tried < kSinglePatchShapesEnd) {
            return options_.trial_bytes;
        }
        const double improvement = node.errors[3] / node.errors[4];
        return options_.trial_bytes * std::clamp(improvement, kTrialFactorMin, kTrialFactorMax);
    }

    void makeChildren(PatchNode& node) const {
        if (!node.children) {
            node.children = std::make_unique<std::array<PatchNode, 8>>();
            std::array<MeshCell, 8> cells =
                childrenOf(query_, node.cell, unitTriangles(query_.mesh(), node.cell));
            for (std::size_t i = 0; i < 8; ++i) {
                (*node.children)[i].cell = std::move(cells[i]);
            }
        }
    }

    /// Chooses the cheapest tree below a node if a byte is worth `byte` of misclassified volume.
    void choose(PatchNode& node, double byte, std::uint32_t level) {
        if (static_cast<double>(++visited_) > kCellsPerByte * bytes_) {
            return;  // chooseAll() discards the result
        }
        fitter_.tryWorth(node, byte);
        node.chooseLeaf(byte);
        if (node.wasEmpty() || level == kLevels || node.wrong < trialBytes(node) * byte) {
            return;
        }
        makeChildren(node);
        const double cost = node.wrong + byte * node.bytes;
        double bytes = kPatchTexelBytes;
        double wrong = 0.0;
        for (PatchNode& child : *node.children) {
            choose(child, byte, level + 1);
            bytes += child.bytes;
            wrong += child.wrong;
        }
        if (wrong + byte * bytes < cost) {
            node.split = true;
            node.bytes = bytes;
            node.wrong = wrong;
        }
    }

    /// \return the bytes of the whole tree, or infinity if it is far too large.
    double chooseAll(double byte) {
        visited_ = 0;
        at_minimum_ = true;
        forEachIndex(0, nodes_.size(), 4, [&](std::size_t i) {
            const double least = root_byte_worths_[i];
            if (byte > least) {
                at_minimum_ = false;
            }
            choose(nodes_[i], std::isfinite(least) ? std::max(byte, least) : byte, 0);
            report(kSearchShare * std::min(1.0, taken_ / bytes_));
        });
        if (static_cast<double>(visited_) > kCellsPerByte * bytes_) {
            return std::numeric_limits<double>::infinity();
        }
        wrong_ = 0.0;
        for (const PatchNode& node : nodes_) {
            wrong_ += node.wrong;
        }
        taken_ = takenBytes();
        tried_.push_back({taken_, wrong_});
        return taken_;
    }

    /// Bytes of the map of the chosen tree.
    /// \param planes  bytes of depth planes.
    [[nodiscard]] double takenBytes(double planes = 0.0) const {
        double texels = 1.0 + static_cast<double>(nodes_.size()) + planes / kPatchTexelBytes;
        for (const PatchNode& node : nodes_) {
            // A root always has a record.
            texels += std::max(0.0, node.bytes / kPatchTexelBytes - 1.0);
        }
        const PatchMapSize size = patchMapSize(static_cast<std::size_t>(texels));
        return double{kPatchTexelBytes} * size.width * size.height;
    }

    /// A bracket of the worth of a byte, with the bytes of both trees. The tree of `high_worth` fits, the tree of
    /// `low_worth` does not; `low_worth` is 0 if all trees fit.
    struct WorthRange {
        double high_worth = 0.0;
        double bytes_at_high = 0.0;
        double low_worth = 0.0;
        double bytes_at_low = 0.0;
    };

    /// Plans ever larger trees until one does not fit, has no errors, or gains too little from more bytes.
    WorthRange descend() {
        double byte = 1e-3 * static_cast<double>(roots_.size * roots_.size * roots_.size);
        WorthRange range{.high_worth = byte};
        double taken = chooseAll(byte);
        for (int i = 0; i < kSteps && taken <= bytes_; ++i) {
            range.high_worth = byte;
            range.bytes_at_high = taken;
            if (!(wrong_ > 0.0) || at_minimum_) {
                return range;
            }
            // The size is roughly proportional to 1/√(worth of a byte).
            const double share = taken / bytes_;
            byte *= std::clamp(share * share, 1.0 / 16.0, 0.8);
            taken = chooseAll(byte);
        }
        range.low_worth = byte;
        range.bytes_at_low = taken;
        return range;
    }

    void findDepthPlanes(double byte, double least_byte) {
        depth_planes_.find(nodes_, byte, least_byte, [this] { report(kSearchShare); });
    }
    /// Fills the unused bytes with depth planes: first those worth a byte of the tree, then cheaper ones.
    /// \param least_byte  as in DepthPlaneChoice::find().
    void takeDepthPlanes(double byte, double least_byte) {
        for (double spare = spareBytes(); spare >= DepthGain::kBytesMin; byte *= kNextPlanes) {
            findDepthPlanes(std::max(byte, least_byte), least_byte);
            spare = depth_planes_.take(spare);
            if (byte <= least_byte) {
                break;
            }
        }
    }

    /// Unused bytes of the tree, less one row of texels for the padding of the map.
    [[nodiscard]] double spareBytes() const {
        const double all = static_cast<double>(options_.bytes);
        const PatchMapSize size = patchMapSize(static_cast<std::size_t>(all / kPatchTexelBytes));
        return all - takenBytes() - double{kPatchTexelBytes} * size.width;
    }

    /// Shrinks the tree if depth planes are worth more than its last bytes.
    /// \param byte  the worth of a byte for which the tree was chosen.
    /// \return the worth of a byte for the remaining tree.
    double reserveForDepthPlanes(double byte) {
        findDepthPlanes(byte, kSpareByte * byte);
        const double wanted = depth_planes_.bytesWorth(byte);
        if (takenBytes(wanted) <= bytes_) {
            return byte;
        }
        bytes_ -= std::min(wanted, kDepthShareMax * bytes_);
        WorthRange range{.high_worth = byte, .bytes_at_high = taken_};
        while (range.bytes_at_high > bytes_) {
            range.low_worth = range.high_worth;
            range.bytes_at_low = range.bytes_at_high;
            // chooseAll() returns infinity for a tree that is far too large.
            const double factor = range.bytes_at_high / bytes_ * range.bytes_at_high / bytes_;
            range.high_worth *= std::isfinite(factor) ? std::max(kByteWorthGrowth, factor) : 2.0;
            range.bytes_at_high = chooseAll(range.high_worth);
        }
        byte = range.low_worth > 0.0 ? chooseLowestWorth(range, kSpareForDepth) : byte;
        bytes_ = static_cast<double>(options_.bytes);
        return byte;
    }

    /// Finds the lowest worth of a byte whose tree fits, and chooses that tree.
    /// \param unused  fraction of the bytes that the tree may leave unused.
    /// \return the worth of a byte.
    double chooseLowestWorth(WorthRange range, double unused) {
        if (!(range.low_worth > 0.0)) {
            return range.high_worth;
        }
        double byte = range.low_worth;
        const auto square = [](double x) { return x * x; };
        for (int i = 0; i < kWorthTrials && range.bytes_at_high < (1.0 - unused) * bytes_; ++i) {
            const double share = (square(bytes_ / range.bytes_at_high) - 1.0) /
                                 (square(bytes_ / range.bytes_at_high) - square(bytes_ / range.bytes_at_low));
            byte = range.high_worth + std::clamp(share, 0.1, 0.9) * (range.low_worth - range.high_worth);
            const double taken = chooseAll(byte);
            (taken > bytes_ ? range.low_worth : range.high_worth) = byte;
            (taken > bytes_ ? range.bytes_at_low : range.bytes_at_high) = taken;
        }
        if (byte != range.high_worth) {
            chooseAll(range.high_worth);
        }
        return range.high_worth;
    }

    /// Splits cells that do not represent the surface, down to the cell size of the texel.
    void refine(PatchNode& node, std::uint32_t levels) {
        if (texels_ > texels_max_) {
            return;  // planTexel() discards the result
        }
        const bool held = fitter_.hold(node, kHeldWithin * texel_, byteWorthOfTexel());
        if (!held && levels > 0) {
            if (node.cell.triangles.size() >= kManyTriangles) {
                // A bake must be cancellable even if all triangles are in one root.
                report(kSearchShare * rootsDone());
            }
            makeChildren(node);
            node.split = true;
            const auto refineChild = [&](std::size_t i) { refine((*node.children)[i], levels - 1); };
            if (node.cell.triangles.size() >= kManyTriangles) {
                forEachIndex(0, 8, 1, refineChild);
            } else {
                for (std::size_t i = 0; i < 8; ++i) {
                    refineChild(i);
                }
            }
            gather(node);
        } else {
            texels_ += static_cast<std::uint64_t>(node.bytes / kPatchTexelBytes);
        }
    }

    /// Misclassified volume that a byte is worth in a tree by texel; 0 in a tree by bytes.
    [[nodiscard]] double byteWorthOfTexel() const { return kByteOfTexel * texel_ * texel_ * texel_; }

    [[nodiscard]] double rootsDone() const {
        return static_cast<double>(roots_done_) / static_cast<double>(nodes_.size());
    }

    /// Sums up the children of a split node. Merges them if all are equal and have no record.
    static void gather(PatchNode& node) {
        node.bytes = kPatchTexelBytes;
        node.wrong = 0.0;
        bool alike = true;
        const std::array<PatchNode, 8>& children = *node.children;
        for (const PatchNode& child : children) {
            node.bytes += child.bytes;
            node.wrong += child.wrong;
            alike = alike && !child.hasRecord() && child.inside() == children[0].inside();
        }
        if (alike) {
            node.split = false;
            node.chosen = children[0].inside() ? 1 : 0;
            node.bytes = 0.0;
        }
    }

    /// \return whether the tree fits.
    bool planTexel(double texel) {
        texel_ = texel;
        const double longest = static_cast<double>(query_.mesh().bounds.longestSide());
        const auto tooMany = [](const glm::dvec3& n) { return n.x * n.y * n.z > kRootsMax; };
        levels_ = 0;
        roots_.size = kTexelsPerCell * texel;
        while (levels_ < kPatchLevelsMax && roots_.size < kBesideMesh * longest &&
               tooMany(rootsOf(roots_.size))) {
            roots_.size *= 2.0;
            ++levels_;
        }
        makeRoots();
        texels_ = 0;
        texels_max_ = options_.bytes / kPatchTexelBytes;
        roots_done_ = 0;
        forEachIndex(0, nodes_.size(), 1, [&](std::size_t i) {
            refine(nodes_[i], levels_);
            ++roots_done_;
            report(kSearchShare * rootsDone());
        });
        return texels_ <= texels_max_ && takenBytes() <= bytes_;
    }

    /// Replaces the roots with their children while the records of the roots are a small fraction of the tree.
    /// \return whether the tree still fits; if not, it must be discarded.
    bool splitRoots() {
        while (levels_ > 0 &&
               8.0 * kPatchTexelBytes * static_cast<double>(nodes_.size()) <= kRootsShare * takenBytes()) {
            --levels_;
            const glm::uvec3 from = roots_.count;
            const glm::uvec3 to = 2U * from;
            std::vector<PatchNode> children(8 * nodes_.size());
            forEachIndex(0, nodes_.size(), 1, [&](std::size_t i) {
                PatchNode& node = nodes_[i];
                const bool known = node.children != nullptr;
                makeChildren(node);
                const std::size_t x = i % from.x;
                const std::size_t y = i / from.x % from.y;
                const std::size_t z = i / from.x / from.y;
                for (std::size_t k = 0; k < 8; ++k) {
                    PatchNode& child = (*node.children)[k];
                    if (!known) {
                        refine(child, levels_);
                    }
                    children[((2 * z + (k >> 2U)) * to.y + 2 * y + (k >> 1U & 1U)) * to.x + 2 * x +
                             (k & 1U)] = std::move(child);
                }
            });
            nodes_ = std::move(children);
            roots_.count = to;
            roots_.size *= 0.5;
            if (texels_ > texels_max_ || takenBytes() > bytes_) {
                return false;
            }
        }
        return true;
    }

    /// Plans with the given texel. If it takes too many bytes, finds the finest texel that fits, within an eighth of an
    /// octave.
    Result<void> searchTexel() {
        const double finest = double{query_.mesh().bounds.farthest()} / kDistanceInTexelsMax;
        if (options_.texel < finest) {
            return fail(ErrorCode::kUsage,
                        query_.mesh().name + ": --texel is " + shortest(static_cast<float>(options_.texel)) +
                            ", too fine for floats this far from the origin; give at least " +
                            shortest(static_cast<float>(finest)));
        }
        if (planTexel(options_.texel)) {
            return {};
        }
        if (!options_.coarsen) {
            return fail(ErrorCode::kLimit, query_.mesh().name + ": a texel of " +
                                               shortest(static_cast<float>(options_.texel)) +
                                               " takes more than the " + std::to_string(options_.bytes) +
                                               " bytes allowed for a tree of patches; give a larger --texel");
        }
        double fine = options_.texel;
        double coarse = 2.0 * fine;
        while (!planTexel(coarse)) {
            fine = coarse;
            coarse *= 2.0;
        }
        for (int i = 0; i < kTexelTrials; ++i) {
            const double middle = std::sqrt(fine * coarse);
            (planTexel(middle) ? coarse : fine) = middle;
        }
        if (texel_ != coarse) {
            planTexel(coarse);
        }
        return {};
    }

    const MeshQuery& query_;
    std::vector<FlatFace> faces_;  // per triangle
    const PatchOptions& options_;
    Bounds held_;  // of the mesh and PatchOptions::roots_contain
    double bytes_;
    LeafFitter fitter_;
    PatchRoots roots_;
    std::vector<PatchNode> nodes_;
    std::vector<double> root_byte_worths_;  // minByteWorth() of each
    DepthPlaneChoice depth_planes_;
    double wrong_ = 0.0;
    double taken_ = 0.0;  // bytes of the last tree tried
    std::vector<ErrorPoint> tried_;
    std::atomic<std::size_t> visited_ = 0;
    std::atomic<bool> at_minimum_ = false;  // the last tree tried used the minimum worth of a byte everywhere
    double texel_ = 0.0;                    // of the chosen nodes
    std::uint32_t levels_ = 0;              // below the roots, for a tree by texel
    std::atomic<std::uint64_t> texels_ = 0;  // of the leaves so far, for a tree by texel
    std::uint64_t texels_max_ = 0;
    std::atomic<std::size_t> roots_done_ = 0;
    mutable std::mutex report_;
};

}  // namespace

Result<PatchTree> bakePatches(const MeshQuery& query, const PatchOptions& options) {
    return Planner(query, options).run();
}

ErrorCurve planErrors(const MeshQuery& query, const PatchOptions& options) {
    return Planner(query, options).errors();
}

}  // namespace relief
