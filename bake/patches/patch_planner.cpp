// SPDX-License-Identifier: Apache-2.0
#include "bake/patches/patch_planner.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <span>
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

/// A tree gives up at most this fraction of its bytes for depth planes (depth_planes.h).
constexpr double kDepthShareMost = 0.45;
/// The same as kSpare of a tree that depth planes follow, which fill what it leaves.
constexpr double kSpareForDepth = 3e-3;
/// The worth of a byte that is left when the tree is chosen.
constexpr double kSpareByte = 0.25;
/// A root for each so many bytes.
constexpr double kBytesPerRoot = 168.4;
/// PatchOptions::trial_bytes counts times how much 5² heights mend 3², within these: where the surface is smooth, a patch
/// alone gets far, and eight of them cost more.
constexpr double kMendedLeast = 1.2;
constexpr double kMendedMost = 2.5;
constexpr std::uint32_t kLevels = 10;
constexpr int kSteps = 60;
/// Of the time.
constexpr double kSearchShare = 0.7;
constexpr int kNarrowings = 12;
/// Of the bytes: a tree that leaves less is large enough.
constexpr double kSpare = 3e-4;
/// The same of a curve, so that it does not end long before.
constexpr double kSpareOfCurve = 0.3;
/// Minimum factor of a byte's worth from one tree to the next smaller one.
constexpr double kDearer = 1.05;
/// Cells that a tree may look at for each of its bytes, a few times what it takes. Where a byte is worth next to nothing, as
/// among flat faces, trees are larger without end.
constexpr double kCellsPerByte = 0.6;
/// The least worth of a byte below a root with a flat face, in its area times its length. A cube, seen by it, is off by some 1e-6 of its
/// side on average; a curved mesh of many triangles is not held back by it at any usual size.
constexpr double kLeastByte = 2.5e-12;
/// Cells do not end in the planes of even numbers, in which models have walls.
constexpr double kBesideMesh = 1.01;
constexpr double kBesideRoots = 1.00137;
constexpr glm::dvec3 kOriginShift{0.4171, 0.5337,
                                  0.4623};  // of the room that whole roots leave, on the low side

/// By texel: roots, at most, but where the levels below them are too few.
constexpr double kRootsMost = 64.0;
/// The side of the finest cells, in texels: what is two of them thick then has two surfaces in most, and three cells at most.
constexpr double kTexelsPerCell = 2.0;
/// A leaf holds the surface within this share of the texel.
constexpr double kHeldWithin = 0.25;
/// The worth of a byte in a cell that is split no further, in texels.
constexpr double kByteOfTexel = 0.005;
/// From the origin to the farthest place: there a sixteenth of a texel is a step of a float.
constexpr double kTexelsMost = 1 << 20;
constexpr int kTexelNarrowings = 3;
/// Of a tree that is to be cut, the share of its roots' records, at most.
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
        if (options.roots_hold) {
            held_.add(options.roots_hold->min);
            held_.add(options.roots_hold->max);
        }
    }

    Result<PatchTree> run() {
        if (options_.texel > 0.0) {
            RELIEF_TRY(searchTexel());
            const double most = (1.0 + kDepthShareMost) * takenBytes();
            if (most > static_cast<double>(options_.tile_bytes) && !splitRoots()) {
                planTexel(texel_);
            }
            takeDepthPlanes(byteOfTexel());
        } else {
            roots_.size = rootSizeByBytes();
            makeRoots();
            takeDepthPlanes(kSpareByte * leaveForDepth(narrow(descend(), kSpare)));
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
        narrow(descend(), kSpareOfCurve);
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

    /// Of roots of this size, along each axis.
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
        root_bytes_.resize(nodes_.size());
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const glm::dvec3 at(i % roots_.count.x, i / roots_.count.x % roots_.count.y,
                                i / roots_.count.x / roots_.count.y);
            nodes_[i].cell.size = roots_.size;
            nodes_[i].cell.low = roots_.origin + roots_.size * at;
        }
        const TriangleMesh& mesh = query_.mesh();
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            Bounds box;
            addTriangle(box, mesh, t);
            const auto cellAt = [&](const glm::vec3& p) {
                return glm::ivec3(glm::clamp(glm::floor((glm::dvec3(p) - roots_.origin) / roots_.size),
                                             glm::dvec3(0.0), glm::dvec3(roots_.count) - 1.0));
            };
            const glm::ivec3 low = cellAt(box.min);
            const glm::ivec3 high = cellAt(box.max);
            for (int z = low.z; z <= high.z; ++z) {
                for (int y = low.y; y <= high.y; ++y) {
                    for (int x = low.x; x <= high.x; ++x) {
                        MeshCell& cell =
                            nodes_[(std::size_t(z) * roots_.count.y + std::size_t(y)) * roots_.count.x +
                                   std::size_t(x)]
                                .cell;
                        if (meetsUnitCube(cell.inUnit(mesh, t))) {
                            cell.triangles.push_back(t);
                        }
                    }
                }
            }
        }
        forEachIndex(0, nodes_.size(), 16, [&](std::size_t i) {
            MeshCell& cell = nodes_[i].cell;
            cell.bodies = query_.bodiesAt(glm::vec3(cell.low + cell.size * MeshCell::kKnown));
            root_bytes_[i] = leastByte(cell);
        });
    }

    /// Misclassified volume, object units cubed, that a byte has to save below a root; infinity without triangles. A root and all
    /// below it have one such worth: with one for each cell, a split that finds what the lines of its cell missed does not pay if
    /// it also splits a flat face.
    [[nodiscard]] double leastByte(const MeshCell& cell) const {
        double least = std::numeric_limits<double>::infinity();
        for (const std::uint32_t triangle : cell.triangles) {
            const FlatFace& face = faces_[triangle];
            if (face.area > 0.0) {
                least = std::min(least, kLeastByte * face.area * face.length);
            }
        }
        return least;
    }

    [[nodiscard]] double trialBytes(const PatchNode& node) const {
        if (node.tried < kFlatsAndSingles) {
            return options_.trial_bytes;
        }
        const double mended = node.errors[3] / node.errors[4];
        return options_.trial_bytes * std::clamp(mended, kMendedLeast, kMendedMost);
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

    /// The cheapest tree below a node where a byte is worth so much wrong volume.
    void choose(PatchNode& node, double byte, std::uint32_t level) {
        if (static_cast<double>(++looked_at_) > kCellsPerByte * bytes_) {
            return;  // chooseAll() discards it all
        }
        fitter_.tryWorth(node, byte);
        node.chooseLeaf(byte);
        if (node.seenEmpty() || level == kLevels || node.wrong < trialBytes(node) * byte) {
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

    /// \return the bytes of the whole tree; infinity of one that is far too large.
    double chooseAll(double byte) {
        looked_at_ = 0;
        all_least_ = true;
        forEachIndex(0, nodes_.size(), 4, [&](std::size_t i) {
            const double least = root_bytes_[i];
            if (byte > least) {
                all_least_ = false;
            }
            choose(nodes_[i], std::isfinite(least) ? std::max(byte, least) : byte, 0);
            report(kSearchShare * std::min(1.0, taken_ / bytes_));
        });
        if (static_cast<double>(looked_at_) > kCellsPerByte * bytes_) {
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

    /// Of the map of all that is chosen.
    /// \param planes  bytes of depth planes.
    [[nodiscard]] double takenBytes(double planes = 0.0) const {
        double texels = 1.0 + static_cast<double>(nodes_.size()) + planes / kPatchTexelBytes;
        for (const PatchNode& node : nodes_) {
            // A root has a record in any case.
            texels += std::max(0.0, node.bytes / kPatchTexelBytes - 1.0);
        }
        const PatchMapSize size = patchMapSize(static_cast<std::size_t>(texels));
        return kPatchTexelBytes * size.width * size.height;
    }

    /// Worths of a byte, and what their trees take: one that fits, and one that does not; `cheap` 0: none.
    struct ByteRange {
        double dear = 0.0;
        double taken_dear = 0.0;
        double cheap = 0.0;
        double taken_cheap = 0.0;
    };

    /// Plans larger and larger trees, up to one that does not fit, is without errors, or gains too little by more bytes.
    ByteRange descend() {
        double byte = 1e-3 * static_cast<double>(roots_.size * roots_.size * roots_.size);
        ByteRange range{.dear = byte};
        double taken = chooseAll(byte);
        for (int i = 0; i < kSteps && taken <= bytes_; ++i) {
            range.dear = byte;
            range.taken_dear = taken;
            if (!(wrong_ > 0.0) || all_least_) {
                return range;
            }
            // Bytes go by about the square root of their worth.
            const double share = taken / bytes_;
            byte *= std::clamp(share * share, 1.0 / 16.0, 0.8);
            taken = chooseAll(byte);
        }
        range.cheap = byte;
        range.taken_cheap = taken;
        return range;
    }

    void findDepthPlanes(double byte) {
        depth_planes_.find(nodes_, byte, [this] { report(kSearchShare); });
    }
    void takeDepthPlanes(double byte) {
        findDepthPlanes(byte);
        depth_planes_.take(spareBytes());
    }

    /// Bytes that the tree leaves, less a row of texels, which a map fills up.
    [[nodiscard]] double spareBytes() const {
        const double all = static_cast<double>(options_.bytes);
        const PatchMapSize size = patchMapSize(static_cast<std::size_t>(all / kPatchTexelBytes));
        return all - takenBytes() - kPatchTexelBytes * size.width;
    }

    /// Shrinks the tree if depth planes are worth more than its last bytes.
    /// \param byte  the worth of a byte that the tree was chosen by.
    /// \return that of the tree that is left.
    double leaveForDepth(double byte) {
        findDepthPlanes(kSpareByte * byte);  // takeDepthPlanes() needs those, too
        const double wanted = depth_planes_.bytesWorth(byte);
        if (takenBytes(wanted) <= bytes_) {
            return byte;
        }
        bytes_ -= std::min(wanted, kDepthShareMost * bytes_);
        ByteRange range{.dear = byte, .taken_dear = taken_};
        while (range.taken_dear > bytes_) {
            range.cheap = range.dear;
            range.taken_cheap = range.taken_dear;
            // chooseAll() returns infinity for a tree that is far too large.
            const double factor = range.taken_dear / bytes_ * range.taken_dear / bytes_;
            range.dear *= std::isfinite(factor) ? std::max(kDearer, factor) : 2.0;
            range.taken_dear = chooseAll(range.dear);
        }
        byte = range.cheap > 0.0 ? narrow(range, kSpareForDepth) : byte;
        bytes_ = static_cast<double>(options_.bytes);
        return byte;
    }

    /// Searches for the lowest worth of a byte whose tree fits, and chooses that tree.
    /// \param spare  fraction of the bytes that the tree may leave unused.
    /// \return the worth of a byte.
    double narrow(ByteRange range, double spare) {
        if (!(range.cheap > 0.0)) {
            return range.dear;
        }
        double byte = range.cheap;
        const auto square = [](double x) { return x * x; };
        for (int i = 0; i < kNarrowings && range.taken_dear < (1.0 - spare) * bytes_; ++i) {
            const double share = (square(bytes_ / range.taken_dear) - 1.0) /
                                 (square(bytes_ / range.taken_dear) - square(bytes_ / range.taken_cheap));
            byte = range.dear + std::clamp(share, 0.1, 0.9) * (range.cheap - range.dear);
            const double taken = chooseAll(byte);
            (taken > bytes_ ? range.cheap : range.dear) = byte;
            (taken > bytes_ ? range.taken_cheap : range.taken_dear) = taken;
        }
        if (byte != range.dear) {
            chooseAll(range.dear);
        }
        return range.dear;
    }

    /// Splits what does not hold the surface down to the cells of the texel.
    void refine(PatchNode& node, std::uint32_t levels) {
        if (texels_ > texels_most_) {
            return;  // planTexel() discards it all
        }
        const bool held = fitter_.hold(node, kHeldWithin * texel_, byteOfTexel());
        if (!held && levels > 0) {
            if (node.cell.triangles.size() >= kManyTriangles) {
                report(kSearchShare *
                       rootsDone());  // often enough for what ends it, where all is in one root
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

    /// Misclassified volume that a byte is worth in a tree by texel; 0 in one by bytes.
    [[nodiscard]] double byteOfTexel() const { return kByteOfTexel * texel_ * texel_ * texel_; }

    [[nodiscard]] double rootsDone() const {
        return static_cast<double>(roots_done_) / static_cast<double>(nodes_.size());
    }

    /// Sums up the children of a split node, which is none where they are all alike.
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
        const auto tooMany = [](const glm::dvec3& n) { return n.x * n.y * n.z > kRootsMost; };
        levels_ = 0;
        roots_.size = kTexelsPerCell * texel;
        while (levels_ < kPatchLevelsMax && roots_.size < kBesideMesh * longest &&
               tooMany(rootsOf(roots_.size))) {
            roots_.size *= 2.0;
            ++levels_;
        }
        makeRoots();
        texels_ = 0;
        texels_most_ = options_.bytes / static_cast<std::uint64_t>(kPatchTexelBytes);
        roots_done_ = 0;
        forEachIndex(0, nodes_.size(), 1, [&](std::size_t i) {
            refine(nodes_[i], levels_);
            ++roots_done_;
            report(kSearchShare * rootsDone());
        });
        return texels_ <= texels_most_ && takenBytes() <= bytes_;
    }

    /// Takes the cells below the roots for roots, as long as these are a small share of the tree.
    /// \return whether it still fits; or it is of no use any more.
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
            if (texels_ > texels_most_ || takenBytes() > bytes_) {
                return false;
            }
        }
        return true;
    }

    /// The texel, or where that takes too many bytes the finest that does not, within an eighth of an octave.
    Result<void> searchTexel() {
        const double finest = farthest() / kTexelsMost;
        if (options_.texel < finest) {
            return fail(ErrorCode::kUsage, query_.mesh().name + ": --texel is " +
                                               shortest(static_cast<float>(options_.texel)) +
                                               ", finer than floats resolve there; give at least " +
                                               shortest(static_cast<float>(finest)));
        }
        if (planTexel(options_.texel)) {
            return {};
        }
        if (!options_.coarsen) {
            return fail(ErrorCode::kLimit,
                        query_.mesh().name + ": a texel of " + shortest(static_cast<float>(options_.texel)) +
                            " takes more than the " + std::to_string(options_.bytes) +
                            " bytes that a tree of patches may have; give a larger --texel");
        }
        double fine = options_.texel;
        double coarse = 2.0 * fine;
        while (!planTexel(coarse)) {
            fine = coarse;
            coarse *= 2.0;
        }
        for (int i = 0; i < kTexelNarrowings; ++i) {
            const double middle = std::sqrt(fine * coarse);
            (planTexel(middle) ? coarse : fine) = middle;
        }
        if (texel_ != coarse) {
            planTexel(coarse);
        }
        return {};
    }

    /// Of the mesh from the origin, along an axis.
    [[nodiscard]] double farthest() const {
        const Bounds& bounds = query_.mesh().bounds;
        const glm::vec3 far = glm::max(glm::abs(bounds.min), glm::abs(bounds.max));
        return double{std::max({far.x, far.y, far.z})};
    }

    const MeshQuery& query_;
    std::vector<FlatFace> faces_;  // per triangle
    const PatchOptions& options_;
    Bounds held_;  // of the mesh, and of what the roots are to hold beside it
    double bytes_;
    LeafFitter fitter_;
    PatchRoots roots_;
    std::vector<PatchNode> nodes_;
    std::vector<double> root_bytes_;  // leastByte() of each
    DepthPlaneChoice depth_planes_;
    double wrong_ = 0.0;
    double taken_ = 0.0;  // bytes of the tree tried last
    std::vector<ErrorPoint> tried_;
    std::atomic<std::size_t> looked_at_ = 0;
    std::atomic<bool> all_least_ =
        false;                  // in the tree tried last, a byte was worth its least below each root
    double texel_ = 0.0;        // that the nodes were chosen by
    std::uint32_t levels_ = 0;  // below the roots, by texel
    std::atomic<std::uint64_t> texels_ = 0;  // of leaves so far, by texel
    std::uint64_t texels_most_ = 0;
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
