// SPDX-License-Identifier: Apache-2.0
#include "bake/patches/leaf_fitter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bake/patches/surface_probe.h"

namespace relief {
namespace {

constexpr int kRounds = 2;
constexpr int kFinalRounds = 3;
constexpr int kFinalPairRounds = 4;
/// Shapes that would pay off at this fraction of a byte's worth are tried in the same step, because a later step would
/// have to recompute the columns of the cell.
constexpr double kForesight = 0.5;
/// Parts are assumed to lie between lines if the lines hit less than this fraction of the expected number of triangles
/// that face one way. Their volume is estimated as kVolumePassedBy times the missing area to the power of 3/2.
constexpr double kPassedBy = 0.5;
constexpr double kVolumePassedBy = 0.1;
/// The mean error allowed by LeafFitter::hold(), as a fraction of `within`.
constexpr double kMeanShare = 0.5;

/// Estimates the volume missed between the lines, in cells.
double volumePassedBy(const CellColumns& columns, std::span<const ClippedTriangle> pieces) {
    std::array<double, 2> expected{};
    for (const ClippedTriangle& piece : pieces) {
        expected[dot(piece.normal, columns.grid().along()) > 0.0 ? 1 : 0] +=
            columns.grid().expectedHits(piece);
    }
    double missing = 0.0;
    for (const bool along : {false, true}) {
        const auto hits = static_cast<double>(columns.hits(along));
        missing += hits < kPassedBy * expected[along] ? expected[along] - hits : 0.0;
    }
    const double area = missing * columns.grid().volumePerLength();
    return kVolumePassedBy * area * std::sqrt(area);
}

/// Tries the shapes of one leaf, in the order of kPatchShapes.
class LeafTrial {
  public:
    LeafTrial(const MeshQuery& query, const ErrorCosts& costs, const std::vector<LineGrid>& grids,
              PatchNode& node)
        : costs_(costs),
          node_(node),
          volume_(node.cell.size * node.cell.size * node.cell.size),
          triangles_(unitTriangles(query.mesh(), node.cell)),
          pieces_(node.tried == 0 ? clippedTriangles(triangles_) : std::vector<ClippedTriangle>()),
          columns_(query, node.cell, triangles_, grids[frameOf(node)]) {
        if (node.tried < kSinglePatchShapesEnd) {
            if (node.tried == 0) {
                node.mean = meanPlane(pieces_);
            }
            singles_.emplace(columns_, costs_, node.mean);
        }
        if (node.tried == 0) {
            tryFlats();
        }
    }
    LeafTrial(const LeafTrial&) = delete;
    LeafTrial& operator=(const LeafTrial&) = delete;

    void trySingle() {
        const std::size_t index = node_.tried;
        const FittedPatch fitted = singles_->fit(kPatchShapes[index].side, kRounds);
        fitted_[0] = fitted.heights;
        if (fitted.heights.side < kPatchSideMax) {
            node_.heights[index - kFlats] = fitted.heights;
        }
        node_.add(volume_ * fitted.wrong + node_.missed_volume);
    }
    void beginPairs() {
        pairs_.emplace(columns_, costs_,
                       meanNormalAlong(clippedTriangles(triangles_), columns_.grid().along()));
        node_.pair_least = volume_ * pairs_->least() + node_.missed_volume;
        node_.walls = pairs_->walls();
    }
    void tryPair() {
        const FittedPair fitted = pairs_->fit(kPatchShapes[node_.tried].side, kRounds);
        fitted_ = fitted.heights;
        node_.add(volume_ * fitted.wrong + node_.missed_volume);
    }

    [[nodiscard]] std::span<const UnitTriangle> triangles() const { return triangles_; }
    /// Heights of the last shape tried; a single surface uses the first element.
    [[nodiscard]] const std::array<PatchHeights, 2>& fitted() const { return fitted_; }

  private:
    std::uint8_t frameOf(PatchNode& node) const {
        if (node.tried == 0) {
            node.frame = chooseFrame(pieces_);
        }
        return node.frame.index;
    }
    void tryFlats() {
        node_.missed_volume = volume_ * volumePassedBy(columns_, pieces_);
        const double inside = singles_->insideVolume();
        node_.add(costs_.false_outside * volume_ * inside + node_.missed_volume);
        node_.add(costs_.false_inside * volume_ * (columns_.grid().volume() - inside) + node_.missed_volume);
        node_.turned = singles_->outsideBelow();
    }

    const ErrorCosts& costs_;
    PatchNode& node_;
    double volume_;
    std::vector<UnitTriangle> triangles_;
    std::vector<ClippedTriangle> pieces_;
    CellColumns columns_;
    std::optional<PatchFitter> singles_;
    std::optional<PairFitter> pairs_;
    std::array<PatchHeights, 2> fitted_;
};

}  // namespace

std::vector<ClippedTriangle> clippedTriangles(std::span<const UnitTriangle> triangles) {
    std::vector<ClippedTriangle> pieces;
    pieces.reserve(triangles.size());
    for (const UnitTriangle& triangle : triangles) {
        pieces.push_back(clipToUnitCube(triangle));
    }
    return pieces;
}

LeafFitter::LeafFitter(const MeshQuery& query, const ErrorCosts& costs, const LeafLines& lines)
    : query_(query), costs_(costs) {
    for (const PatchFrame& frame : patchFrames()) {
        grids_.emplace_back(frame, lines.choose);
        kept_grids_.emplace_back(frame, lines.keep);
    }
}

/// \return whether the node has no triangles.
bool LeafFitter::tryEmpty(PatchNode& node) const {
    if (node.tried == 0 && node.empty()) {
        node.in_void = query_.inVoid(node.cell.middle());
        node.add(0.0);
    }
    return node.wasEmpty();
}

void LeafFitter::tryWorth(PatchNode& node, double byte) const {
    if (tryEmpty(node)) {
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
        return next < (node.frame.two_sides ? kPatchShapes.size() : kSinglePatchShapesEnd) &&
               worth * kPatchShapes[next].bytes() + (kPatchShapes[next].pair ? node.pair_least : 0.0) <
                   least();
    };
    if (!pays()) {
        return;
    }
    worth *= kForesight;
    LeafTrial trial(query_, costs_, grids_, node);
    while (node.tried < kSinglePatchShapesEnd && pays()) {
        trial.trySingle();
    }
    if (node.tried < kSinglePatchShapesEnd || !pays()) {
        return;
    }
    trial.beginPairs();
    while (pays()) {
        trial.tryPair();
    }
}

bool LeafFitter::hold(PatchNode& node, double within, double byte) const {
    if (tryEmpty(node)) {
        node.chooseLeaf(byte);
        return true;
    }
    LeafTrial trial(query_, costs_, grids_, node);
    SurfaceProbe probe(query_, node.cell, trial.triangles(), within / node.cell.size);
    const PatchFrame& frame = patchFrames()[node.frame.index];
    const double wrong_max = kMeanShare * within * node.cell.size * node.cell.size;
    const auto holds = [&](std::size_t index) {
        if (node.errors[index] > wrong_max) {
            return false;
        }
        const PatchShape& shape = kPatchShapes[index];
        const bool agrees = index < kFlats ? probe.agreesWithAll(index == 1)
                            : shape.pair   ? probe.agreesWith(frame, trial.fitted(), node.walls)
                                           : probe.agreesWith(frame, trial.fitted()[0], node.turned);
        if (agrees) {
            node.split = false;
            node.chosen = static_cast<std::uint8_t>(index);
            node.bytes = shape.bytes();
            node.wrong = node.errors[index];
        }
        return agrees;
    };
    bool held = holds(0) || holds(1);
    while (!held && node.tried < kSinglePatchShapesEnd) {
        trial.trySingle();
        held = holds(node.tried - std::size_t{1});
    }
    if (!held && node.frame.two_sides) {
        trial.beginPairs();
        while (!held && node.tried < kPatchShapes.size()) {
            trial.tryPair();
            held = holds(node.tried - std::size_t{1});
        }
    }
    if (!held) {
        node.chooseLeaf(byte);
    }
    return held;
}

/// The lines for choosing are too few for the small squares of 5² heights, but sufficient for larger ones.
CellColumns LeafFitter::keptColumns(const PatchNode& node) const {
    return {query_, node.cell, unitTriangles(query_.mesh(), node.cell),
            (node.shape().side < kPatchSideMax ? grids_ : kept_grids_)[node.frame.index]};
}

PatchHeights LeafFitter::heights(const PatchNode& node) const {
    if (node.shape().side < kPatchSideMax) {
        return node.heights[node.chosen - kFlats];
    }
    const CellColumns columns = keptColumns(node);
    return PatchFitter(columns, costs_, node.mean, node.turned).fit(kPatchSideMax, kFinalRounds).heights;
}

std::array<PatchHeights, 2> LeafFitter::pair(const PatchNode& node) const {
    const CellColumns columns = keptColumns(node);
    const glm::dvec3 normal =
        meanNormalAlong(clippedTriangles(unitTriangles(query_.mesh(), node.cell)), columns.grid().along());
    return PairFitter(columns, costs_, normal, node.walls).fit(node.shape().side, kFinalPairRounds).heights;
}

}  // namespace relief
