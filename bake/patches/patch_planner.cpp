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

#include "bake/mesh/loops.h"
#include "bake/patches/cell_columns.h"
#include "bake/patches/frame_choice.h"
#include "bake/patches/patch_fit.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

constexpr double kTexelBytes = 8.0;
/// A root for each so many bytes.
constexpr double kBytesPerRoot = 160.0;
constexpr int kRounds = 2;
constexpr int kFinalRounds = 3;
constexpr int kFinalPairRounds = 4;
/// PatchOptions::trial_bytes counts times how much 5² heights mend 3², within these: where the surface is smooth, a patch
/// alone gets far, and eight of them cost more.
constexpr double kMendedLeast = 1.2;
constexpr double kMendedMost = 2.5;
constexpr std::uint32_t kLevels = 10;
constexpr int kSteps = 60;
/// Shapes that pay at this share of a byte's worth are tried at once: later steps would look at the cell's columns again.
constexpr double kForesight = 0.5;
/// Of the time.
constexpr double kSearchShare = 0.7;
constexpr int kNarrowings = 12;
/// Of the bytes: a tree that leaves less is large enough.
constexpr double kSpare = 3e-4;
/// Cells that a tree may look at for each of its bytes, a few times what it takes. Where a byte is worth next to nothing, as
/// among flat faces, trees are larger without end.
constexpr double kCellsPerByte = 0.6;
/// Parts lie between lines that meet less than this share of what the area lets expect, of about so much volume for the area's
/// power of 3/2.
constexpr double kPassedBy = 0.5;
constexpr double kVolumePassedBy = 0.1;

/// The contents of a leaf with a surface.
struct Shape {
    std::uint32_t side = 0;  // heights along a side; 0: no surface
    bool pair = false;

    /// Texels beside the leaf's record.
    [[nodiscard]] constexpr std::uint32_t texels() const {
        return (pair ? 2 : 1) * heightTexels(side) + (pair ? 2 : 0);
    }
    /// Beyond a bit in the record above.
    [[nodiscard]] constexpr double bytes() const { return side > 0 ? kTexelBytes * (1.0 + texels()) : 0.0; }
};
/// In the order in which they are tried: outside and inside without a surface, then these.
constexpr std::array<Shape, 8> kShapes = {
    {{}, {}, {2, false}, {3, false}, {5, false}, {2, true}, {3, true}, {5, true}}};
constexpr std::size_t kFlats = 2;
constexpr std::size_t kFlatsAndSingles = 5;

/// Cells do not end in the planes of even numbers, in which models have walls.
constexpr double kBesideRoots = 1.00137;
constexpr glm::dvec3 kOriginShift{0.4171, 0.5337,
                                  0.4623};  // of the room that whole roots leave, on the low side

struct Node {
    FrameChoice frame;
    std::uint8_t tried = 0;  // of kShapes
    std::uint8_t chosen = 0;
    bool split = false;
    bool turned = false;                          // a single surface has the outside below
    bool walls = true;                            // a pair has the inside between
    bool in_void = false;                         // of one without triangles
    std::array<double, kShapes.size()> mistakes;  // of each tried: volume, object units, times its costs
    double pair_least = 0.0;                      // mistakes of the best pair there could be
    double passed_by = 0.0;  // volume between the lines, counted with each one's mistakes
    double bytes = 0.0;
    double wrong = 0.0;
    std::unique_ptr<std::array<Node, 8>> children;
    MeshCell cell;
    std::array<PatchHeights, 2> heights;  // of single surfaces of 2² and 3²

    [[nodiscard]] bool empty() const { return cell.triangles.empty(); }
    /// Without a look at the cell, which is out of reach of the cache: what has a surface is tried as both flats.
    [[nodiscard]] bool seenEmpty() const { return tried == 1; }
    [[nodiscard]] const Shape& shape() const { return kShapes[chosen]; }
    /// Of one without a surface.
    [[nodiscard]] bool inside() const { return empty() ? in_void || cell.bodies.inside() : chosen == 1; }
    [[nodiscard]] double cost(std::size_t index, double byte) const {
        return mistakes[index] + byte * kShapes[index].bytes();
    }
    void add(double wrong_volume) { mistakes[tried++] = wrong_volume; }
};

class Planner {
  public:
    Planner(const MeshQuery& query, const PatchOptions& options)
        : query_(query), options_(options), bytes_(static_cast<double>(options.bytes)) {
        for (const PatchFrame& frame : patchFrames()) {
            grids_.emplace_back(frame, options.lines);
            final_grids_.emplace_back(frame, options.final_lines);
        }
    }

    DepthMap run() {
        makeRoots();
        searchByte();
        return encode();
    }

  private:
    void report(double share) const {
        if (options_.progress) {
            const std::lock_guard lock(report_);
            options_.progress(share);
        }
    }

    void makeRoots() {
        const Bounds& bounds = query_.mesh().bounds;
        const glm::dvec3 size = bounds.size();
        const auto countOf = [&](double root) {
            return glm::max(glm::ceil(size / root * kBesideRoots), glm::dvec3(1.0));
        };
        root_ = 1.01 * static_cast<double>(bounds.longestSide());
        const auto product = [](const glm::dvec3& n) { return n.x * n.y * n.z; };
        while (product(countOf(0.95 * root_)) * kBytesPerRoot <= bytes_) {
            root_ *= 0.95;
        }
        roots_ = glm::uvec3(countOf(root_));
        origin_ = glm::dvec3(bounds.min) - kOriginShift * (glm::dvec3(roots_) * root_ - size);
        nodes_.resize(std::size_t{roots_.x} * roots_.y * roots_.z);
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const glm::dvec3 at(i % roots_.x, i / roots_.x % roots_.y, i / roots_.x / roots_.y);
            nodes_[i].cell.size = root_;
            nodes_[i].cell.low = origin_ + root_ * at;
        }
        const TriangleMesh& mesh = query_.mesh();
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            Bounds box;
            addTriangle(box, mesh, t);
            const auto cellAt = [&](const glm::vec3& p) {
                return glm::ivec3(glm::clamp(glm::floor((glm::dvec3(p) - origin_) / root_), glm::dvec3(0.0),
                                             glm::dvec3(roots_) - 1.0));
            };
            const glm::ivec3 low = cellAt(box.min);
            const glm::ivec3 high = cellAt(box.max);
            for (int z = low.z; z <= high.z; ++z) {
                for (int y = low.y; y <= high.y; ++y) {
                    for (int x = low.x; x <= high.x; ++x) {
                        MeshCell& cell =
                            nodes_[(std::size_t(z) * roots_.y + std::size_t(y)) * roots_.x + std::size_t(x)]
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
        });
    }

    [[nodiscard]] static std::vector<ClippedTriangle> piecesOf(std::span<const UnitTriangle> triangles) {
        std::vector<ClippedTriangle> pieces;
        pieces.reserve(triangles.size());
        for (const UnitTriangle& triangle : triangles) {
            pieces.push_back(clipToUnitCube(triangle));
        }
        return pieces;
    }

    /// In cells.
    [[nodiscard]] static double volumePassedBy(const CellColumns& columns,
                                               std::span<const ClippedTriangle> pieces) {
        double expected = 0.0;
        for (const ClippedTriangle& piece : pieces) {
            expected += columns.grid().expectedHits(piece);
        }
        const auto hits = static_cast<double>(columns.hits());
        const double area = (expected - hits) * columns.grid().volumePerLength();
        return hits < kPassedBy * expected ? kVolumePassedBy * area * std::sqrt(area) : 0.0;
    }

    /// Tries what may pay where a byte is worth so much wrong volume.
    void tryLeaves(Node& node, double byte) const {
        if (node.tried == 0 && node.empty()) {
            node.in_void = query_.inVoid(node.cell.middle());
            node.add(0.0);
        }
        if (node.seenEmpty()) {
            return;
        }
        const auto least = [&] {
            double cost = std::numeric_limits<double>::infinity();
            for (std::size_t i = 0; i < node.tried; ++i) {
                cost = std::min(cost, node.cost(i, byte));
            }
            return cost;
        };
        double worth = byte;
        const auto pays = [&] {
            if (node.tried < kFlats) {
                return true;
            }
            const std::size_t next = node.tried;
            return next < (node.frame.two_sides ? kShapes.size() : kFlatsAndSingles) &&
                   worth * kShapes[next].bytes() + (kShapes[next].pair ? node.pair_least : 0.0) < least();
        };
        if (!pays()) {
            return;
        }
        worth *= kForesight;
        const std::vector<UnitTriangle> triangles = unitTriangles(query_.mesh(), node.cell);
        std::vector<ClippedTriangle> pieces;
        if (node.tried == 0) {
            pieces = piecesOf(triangles);
            node.frame = chooseFrame(pieces);
        }
        const double volume = node.cell.size * node.cell.size * node.cell.size;
        const CellColumns columns(query_, node.cell, triangles, grids_[node.frame.index]);
        if (node.tried < kFlatsAndSingles) {
            const PatchFitter fitter(columns, options_.costs);
            if (node.tried == 0) {
                node.passed_by = volume * volumePassedBy(columns, pieces);
                const double inside = fitter.insideVolume();
                node.add(options_.costs.false_outside * volume * inside + node.passed_by);
                node.add(options_.costs.false_inside * volume * (columns.grid().volume() - inside) +
                         node.passed_by);
                node.turned = fitter.outsideBelow();
            }
            while (node.tried < kFlatsAndSingles && pays()) {
                const FittedPatch fitted = fitter.fit(kShapes[node.tried].side, kRounds);
                if (fitted.heights.side < kPatchSideMax) {
                    node.heights[node.tried - kFlats] = fitted.heights;
                }
                node.add(volume * fitted.wrong + node.passed_by);
            }
        }
        if (node.tried < kFlatsAndSingles || !pays()) {
            return;
        }
        const PairFitter fitter(columns, options_.costs);
        node.pair_least = volume * fitter.least() + node.passed_by;
        node.walls = fitter.walls();
        while (pays()) {
            node.add(volume * fitter.fit(kShapes[node.tried].side, kRounds).wrong + node.passed_by);
        }
    }

    [[nodiscard]] double trialBytes(const Node& node) const {
        if (node.tried < kFlatsAndSingles) {
            return options_.trial_bytes;
        }
        const double mended = node.mistakes[3] / node.mistakes[4];
        return options_.trial_bytes * std::clamp(mended, kMendedLeast, kMendedMost);
    }

    /// The cheapest tree below a node where a byte is worth so much wrong volume.
    void choose(Node& node, double byte, std::uint32_t level) {
        if (static_cast<double>(++looked_at_) > kCellsPerByte * bytes_) {
            return;  // chooseAll() discards it all
        }
        tryLeaves(node, byte);
        node.split = false;
        node.chosen = 0;
        for (std::uint8_t i = 1; i < node.tried; ++i) {
            node.chosen = node.cost(i, byte) < node.cost(node.chosen, byte) ? i : node.chosen;
        }
        node.bytes = node.shape().bytes();
        node.wrong = node.mistakes[node.chosen];
        if (node.seenEmpty() || level == kLevels || node.wrong < trialBytes(node) * byte) {
            return;
        }
        if (!node.children) {
            node.children = std::make_unique<std::array<Node, 8>>();
            std::array<MeshCell, 8> cells =
                childrenOf(query_, node.cell, unitTriangles(query_.mesh(), node.cell));
            for (std::size_t i = 0; i < 8; ++i) {
                (*node.children)[i].cell = std::move(cells[i]);
            }
        }
        const double cost = node.wrong + byte * node.bytes;
        double bytes = kTexelBytes;
        double wrong = 0.0;
        for (Node& child : *node.children) {
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
        forEachIndex(0, nodes_.size(), 4, [&](std::size_t i) {
            choose(nodes_[i], byte, 0);
            report(kSearchShare * std::min(1.0, taken_ / bytes_));
        });
        if (static_cast<double>(looked_at_) > kCellsPerByte * bytes_) {
            return std::numeric_limits<double>::infinity();
        }
        double texels = 1.0 + static_cast<double>(nodes_.size());
        wrong_ = 0.0;
        for (const Node& node : nodes_) {
            // A root has a record in any case.
            texels += std::max(0.0, node.bytes / kTexelBytes - 1.0);
            wrong_ += node.wrong;
        }
        const PatchMapSize size = patchMapSize(static_cast<std::size_t>(texels));
        taken_ = kTexelBytes * size.width * size.height;
        return taken_;
    }

    /// The least worth of a byte at which the tree fits, nearly.
    void searchByte() {
        double byte = 1e-3 * static_cast<double>(root_ * root_ * root_);
        double dear = byte;
        double taken_dear = 0.0;
        double taken = chooseAll(byte);
        for (int i = 0; i < kSteps && taken <= bytes_; ++i) {
            dear = byte;
            taken_dear = taken;
            if (!(wrong_ > 0.0)) {
                return;
            }
            // Bytes go by about the square root of their worth.
            const double share = taken / bytes_;
            byte *= std::clamp(share * share, 1.0 / 16.0, 0.8);
            taken = chooseAll(byte);
        }
        double cheap = byte;
        double taken_cheap = taken;
        const auto square = [](double x) { return x * x; };
        for (int i = 0; i < kNarrowings && taken_dear < (1.0 - kSpare) * bytes_; ++i) {
            const double share = (square(bytes_ / taken_dear) - 1.0) /
                                 (square(bytes_ / taken_dear) - square(bytes_ / taken_cheap));
            byte = dear + std::clamp(share, 0.1, 0.9) * (cheap - dear);
            taken = chooseAll(byte);
            (taken > bytes_ ? cheap : dear) = byte;
            (taken > bytes_ ? taken_cheap : taken_dear) = taken;
        }
        if (byte != dear) {
            chooseAll(dear);
        }
    }

    /// A cell without a patch: the nearest surface.
    [[nodiscard]] PatchRecord flat(const Node& node) const {
        const glm::dvec3 middle = node.cell.middle();
        const ClosestPoint closest = query_.closest(glm::vec3(middle));
        const bool inside = node.inside();
        glm::dvec3 away = middle - closest.point;
        away = length(away) > 0.0 ? (inside ? -away : away) : unitNormal(query_.mesh(), closest.triangle);
        const double distance = closest.distance / root_;
        return PatchRecord::flat(inside, glm::vec3(unit(away)),
                                 static_cast<float>(inside ? -distance : distance));
    }

    [[nodiscard]] PatchRecord splitOf(const Node& node, std::uint32_t first) const {
        std::uint32_t children = 0;
        std::uint32_t inside = 0;
        glm::dvec3 normal(0.0);
        glm::dvec3 center(0.0);
        double area = 0.0;
        for (const ClippedTriangle& piece : piecesOf(unitTriangles(query_.mesh(), node.cell))) {
            normal += piece.area * piece.normal;
            center += piece.area * piece.center;
            area += piece.area;
        }
        normal = length(normal) > 1e-9 * area ? unit(normal) : glm::dvec3(0.0, 1.0, 0.0);
        center /= area;
        int agree = 0;
        for (unsigned i = 0; i < 8; ++i) {
            const Node& child = (*node.children)[i];
            if (hasRecord(child)) {
                children |= 1U << i;
                continue;
            }
            const glm::dvec3 middle = 0.5 * glm::dvec3(i & 1U, i >> 1U & 1U, i >> 2U) + 0.25;
            inside |= child.inside() ? 1U << i : 0U;
            agree += (dot(normal, middle - center) < 0.0) == child.inside() ? 1 : -1;
        }
        normal = agree < 0 ? -normal : normal;  // of meshes that are not wound
        return PatchRecord::split(children, inside, first, glm::vec3(normal),
                                  static_cast<float>(dot(normal, glm::dvec3(0.5) - center)));
    }

    /// The lines to choose by are few for each square of 5² heights, and enough for larger ones.
    [[nodiscard]] CellColumns finalColumns(const Node& node) const {
        return {query_, node.cell, unitTriangles(query_.mesh(), node.cell),
                (node.shape().side < kPatchSideMax ? grids_ : final_grids_)[node.frame.index]};
    }
    [[nodiscard]] PatchHeights finalHeights(const Node& node) const {
        if (node.shape().side < kPatchSideMax) {
            return node.heights[node.chosen - kFlats];
        }
        const CellColumns columns = finalColumns(node);
        return PatchFitter(columns, options_.costs, node.turned).fit(kPatchSideMax, kFinalRounds).heights;
    }
    [[nodiscard]] std::array<PatchHeights, 2> finalPair(const Node& node) const {
        const CellColumns columns = finalColumns(node);
        return PairFitter(columns, options_.costs, node.walls)
            .fit(node.shape().side, kFinalPairRounds)
            .heights;
    }

    /// Writes a leaf with a surface.
    /// \param first  the texels that it has beside its record.
    void writeLeaf(const Node& node, std::uint32_t first, PatchRecord& record,
                   std::vector<PatchRecord>& texels) const {
        const auto write = [&](const PatchHeights& heights, std::uint32_t at) {
            for (std::uint32_t k = 0; k < heightTexels(heights.side); ++k) {
                texels[at + k] = heights.texel(k);
            }
        };
        if (!node.shape().pair) {
            const PatchHeights heights = finalHeights(node);
            record = PatchRecord::patch(patchFrames()[node.frame.index], node.turned, heights, first);
            write(heights, first);
            return;
        }
        const std::array<PatchHeights, 2> pair = finalPair(node);
        record = PatchRecord::pair(node.walls, first);
        for (std::uint32_t k = 0; k < 2; ++k) {
            // Outside is below the lower surface of a wall, and above that of a gap.
            const std::uint32_t at = first + 2 + k * heightTexels(pair[k].side);
            texels[first + k] =
                PatchRecord::patch(patchFrames()[node.frame.index], (k == 0) == node.walls, pair[k], at);
            write(pair[k], at);
        }
    }

    [[nodiscard]] static bool hasRecord(const Node& node) { return node.split || node.shape().side > 0; }

    [[nodiscard]] DepthMap encode() const {
        // Records level by level, and where the children of each begin.
        std::vector<const Node*> records;
        for (const Node& node : nodes_) {
            records.push_back(&node);
        }
        std::vector<std::uint32_t> first(records.size(), 0);
        std::uint32_t levels = 0;
        for (std::size_t at = 0, end = records.size(); at < records.size(); end = records.size()) {
            bool any = false;
            for (; at < end; ++at) {
                first[at] = 1 + static_cast<std::uint32_t>(records.size());
                if (records[at]->split) {
                    any = true;
                    for (const Node& child : *records[at]->children) {
                        if (hasRecord(child)) {
                            records.push_back(&child);
                        }
                    }
                    first.resize(records.size(), 0);
                }
            }
            levels += any ? 1 : 0;
        }
        std::uint32_t next = 1 + static_cast<std::uint32_t>(records.size());
        for (std::size_t i = 0; i < records.size(); ++i) {
            const Node& node = *records[i];
            if (!node.split && hasRecord(node)) {
                first[i] = next;
                next += node.shape().texels();
            }
        }
        std::vector<PatchRecord> texels(next);
        texels[0] = {roots_.x | roots_.y << 16U, roots_.z | levels << 16U};
        std::atomic<std::size_t> done = 0;
        forEachIndex(0, records.size(), 16, [&](std::size_t i) {
            const Node& node = *records[i];
            report(kSearchShare +
                   (1.0 - kSearchShare) * static_cast<double>(++done) / static_cast<double>(records.size()));
            if (node.split) {
                texels[1 + i] = splitOf(node, first[i]);
            } else if (!hasRecord(node)) {
                texels[1 + i] = flat(node);
            } else {
                writeLeaf(node, first[i], texels[1 + i], texels);
            }
        });
        std::vector<std::byte> bytes;
        for (const PatchRecord& texel : texels) {
            appendPatchTexel(bytes, texel);
        }
        DepthMap map;
        map.format = MapFormat::kPatches;
        map.decode = Decode::kPlane;
        map.object_per_map = glm::vec3(static_cast<float>(root_));
        for (int axis = 0; axis < 3; ++axis) {
            map.object_to_map.row[axis] = glm::vec4(0.0F);
            map.object_to_map.row[axis][axis] = static_cast<float>(1.0 / root_);
            map.object_to_map.row[axis].w = static_cast<float>(-origin_[axis] / root_);
        }
        const PatchMapSize size = patchMapSize(texels.size());
        map.width = size.width;
        map.height = size.height;
        bytes.resize(map.texelBytes());
        map.texels = std::move(bytes);
        return map;
    }

    const MeshQuery& query_;
    const PatchOptions& options_;
    double bytes_;
    std::vector<LineGrid> grids_;  // by frame
    std::vector<LineGrid> final_grids_;
    double root_ = 0.0;  // object units
    glm::uvec3 roots_{1};
    glm::dvec3 origin_{0.0};
    std::vector<Node> nodes_;
    double wrong_ = 0.0;
    double taken_ = 0.0;  // bytes of the tree tried last
    std::atomic<std::size_t> looked_at_ = 0;
    mutable std::mutex report_;
};

}  // namespace

DepthMap bakePatches(const MeshQuery& query, const PatchOptions& options) {
    return Planner(query, options).run();
}

}  // namespace relief
