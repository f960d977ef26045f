// SPDX-License-Identifier: Apache-2.0
#include "bake/patches/depth_planes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <iterator>
#include <limits>
#include <optional>

#include "bake/mesh/loops.h"
#include "bake/patches/leaf_fitter.h"

namespace relief {
namespace {

/// A cell is sampled at its center, and at eight points this far from its sides.
constexpr double kBesideCorner = 0.02;
constexpr std::size_t kSamples = 9;
/// Distance error, in cells, that weighs as much as a difference of 1 between the normals.
constexpr double kTurn = 0.25;
/// Planes are added only if they lower the mean error by this much, in cells, ...
constexpr double kGain = 0.004;
/// ... and, in a leaf without a surface, lower it to less than this fraction.
constexpr double kErrorRatioMax = 0.6;
/// Assumed maximum mean error, in cells: cells are skipped if planes would not pay off even at this error.
constexpr double kErrorMax = 1.0;
/// The corners of a cell lie at least this far behind its depth planes, in cells.
constexpr double kBehind = 1.0 / 256.0;
/// Maximum heights in a patch, in cells: of the lowest code, and of any code. Higher codes are too coarse for a normal.
constexpr double kBaseMax = 3.9;
constexpr double kPatchHeightMax = 7.8;
/// Below this distance, in cells, the direction to the surface is unknown.
constexpr double kNoDirection = 1e-6;
/// Points this far beyond a boundary of the solid are outside, in cells.
constexpr double kBeyond = 1e-3;
/// Weight of the depth error (cells times the volume of the cell), relative to misclassified volume.
constexpr double kWorth = 1e-3;
/// A flat face is at least this long, in cells of the leaves that get its plane, ...
constexpr double kFaceLength = 4.0;
/// ... within this distance of their centers, in cells, ...
constexpr double kFaceNear = 2.0;
/// ... and tilted by more than this angle, in radians, relative to the plane that the leaves would otherwise have.
/// The angle is clamped to kFaceTurnMax, the maximum error of a coarse plane of 7 + 7 bits.
constexpr double kFaceTurn = 0.016;
constexpr double kFaceTurnMax = 0.03;
/// Tolerance of the flatness test, in cells: the distances of the leaf's corners to the mesh and to the plane of the
/// face agree within this.
constexpr double kFaceFlat = 1e-3;
/// Weight of that angle (radians times the volume of the cell), relative to misclassified volume.
constexpr double kFaceWorth = 0.01;
/// Safety factor for upper bounds of errors, because queries round points to floats.
constexpr double kRoundingMargin = 1.01;
/// The search in a leaf ends early only if the errors of the leaf are too small by this factor. Later searches for planes
/// worth slightly less then need not repeat it.
constexpr double kEarlyEndFactor = 1.6;
/// Bytes of one plane in its own record; bytes of the records of a second plane, or of two.
constexpr double kOneBytes = DepthGain::kBytesMin;
constexpr double kPairBytes = 2.0 * kPatchTexelBytes;

/// Bit k of `corner` is the coordinate on axis k.
glm::dvec3 cornerOfCube(unsigned corner) {
    return {corner & 1U, corner >> 1U & 1U, corner >> 2U & 1U};
}

/// A point inside and the nearest surface.
struct Sample {
    glm::dvec3 at{0.0};      // unit cube
    PatchVote without{};     // the vote without depth planes
    double distance = 0.0;   // cells
    glm::dvec3 normal{0.0};  // from the point to the surface

    [[nodiscard]] CellPlane plane() const { return {normal, dot(normal, glm::dvec3(0.5) - at) - distance}; }
    [[nodiscard]] double errorOf(const PatchVote& vote) const {
        return std::abs(double{vote.distance} + distance) + kTurn * length(glm::dvec3(vote.normal) - normal);
    }
};

/// A sample before the search for its nearest surface, with bounds on its distance from the results of other samples.
struct Candidate {
    Sample sample;
    double least = 0.0;
    double most = std::numeric_limits<double>::infinity();
    std::optional<std::uint32_t> hint{};  // the triangle at `most`

    void limitBy(const Sample& other, const glm::dvec3& point, std::uint32_t triangle) {
        least = std::max(least, other.distance - length(sample.at - other.at));
        if (const double there = length(point - sample.at); there < most) {
            most = there;
            hint = triangle;
        }
    }
    [[nodiscard]] double maxError() const {
        const double vote = sample.without.distance;
        return std::max(std::abs(vote + least), std::abs(vote + most)) + 2.0 * kTurn;
    }
};

/// A tree of a single root: its record, and up to six more texels.
class SmallTree {
  public:
    SmallTree() = default;
    explicit SmallTree(const PatchRecord& root) { add(root); }

    void add(const PatchRecord& texel) { texels_[count_++] = texel; }
    [[nodiscard]] PatchTexels texels() const { return std::as_bytes(std::span(texels_).first(count_)); }

  private:
    std::array<PatchRecord, 8> texels_{{{1U | 1U << 16U, 1U | 1U << 16U}}};  // a root and one level below it
    std::size_t count_ = 1;
};

/// Computes votes at points of a cell, from the cell's own tree or from a tree in which the cell is an octant.
class Cell {
  public:
    Cell() = default;
    explicit Cell(unsigned octant) : low_(0.5 * cornerOfCube(octant)), size_(0.5) {}

    [[nodiscard]] PatchVote vote(const SmallTree& tree, const glm::dvec3& at) const {
        // A point on an upper side would be outside of the root.
        const glm::dvec3 p = glm::min(low_ + size_ * at, glm::dvec3(1.0 - kNoDirection));
        PatchVote vote = *votePatches(tree.texels(), glm::vec3(p));
        vote.distance /= static_cast<float>(size_);
        return vote;
    }

  private:
    glm::dvec3 low_{0.0};
    double size_ = 1.0;
};

/// Encodes 2² heights, which may exceed the limit of PatchHeights::of(). The lowest code is at most kBaseMax.
PatchHeights heightsOf(const std::array<double, 4>& heights) {
    const double above = std::max(0.0, std::ranges::max(heights) - kBaseMax);
    const int shift = static_cast<int>(std::ceil(512.0 * above));
    std::array<double, 5> held{};
    std::ranges::copy(heights, held.begin());
    held[4] = std::min(std::ranges::min(heights), kBaseMax);
    for (double& height : held) {
        height -= shift / 512.0;
    }
    PatchHeights result = PatchHeights::of(held, 2);
    result.base += shift;
    return result;
}

/// Returns a patch of 2² heights on the plane. The plane is shifted outwards if a corner of the cell is not behind it,
/// because the leaf may omit a corner of the surface. Returns nullopt if the heights are out of range.
std::optional<PatchRecord> patchOf(CellPlane plane) {
    const glm::dvec3 size = glm::abs(plane.normal);
    const std::uint8_t first = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    double highest = -kBehind;
    for (unsigned i = 0; i < 8; ++i) {
        highest = std::max(highest, plane.at(cornerOfCube(i)));
    }
    plane.offset -= highest + kBehind;
    std::array<double, 4> heights{};
    for (unsigned i = 0; i < 4; ++i) {
        glm::dvec3 corner(0.0);
        corner[(first + 1) % 3] = i & 1U;
        corner[(first + 2) % 3] = i >> 1U;
        heights[i] = -plane.at(corner) / plane.normal[first];
    }
    const bool mirrored = std::ranges::min(heights) < -kBaseMax;
    for (double& height : heights) {
        height = mirrored ? 1.0 - height : height;
    }
    if (!(std::ranges::min(heights) >= -kBaseMax && std::ranges::max(heights) <= kPatchHeightMax)) {
        return std::nullopt;
    }
    const PatchFrame frame{.first = first, .mirrored = static_cast<std::uint8_t>(mirrored ? 1 : 0)};
    const PatchRecord patch =
        PatchRecord::patch(frame, (plane.normal[first] < 0.0) != mirrored, heightsOf(heights), 0);
    for (unsigned i = 0; i < 8; ++i) {
        if (!(Cell().vote(SmallTree(patch), cornerOfCube(i)).distance < 0.0F)) {
            return std::nullopt;
        }
    }
    return patch;
}

/// The votes of a record at the samples of a leaf.
using Votes = std::array<PatchVote, kSamples>;

/// The record with the lowest mean error.
struct Best {
    PatchRecord record;
    double error = std::numeric_limits<double>::infinity();

    void consider(const PatchRecord& other, double its_error) {
        if (its_error < error) {
            *this = {other, its_error};
        }
    }
};

/// The tree that determines the votes in a leaf without depth planes.
struct Baseline {
    Cell cell;
    SmallTree tree;
};

/// Chooses the depth planes of one leaf.
class LeafChooser {
  public:
    /// \param baseline  nullopt for a root without a surface, which uses the plane of its center.
    /// \param roots_per_cell  the size of the cell, in roots.
    LeafChooser(const MeshQuery& query, PatchNode& node, const std::optional<Baseline>& baseline,
                double roots_per_cell)
        : query_(query), node_(node), baseline_(baseline), roots_per_cell_(roots_per_cell) {}

    /// Adds the planes of the leaf unless none can be worth more than `byte`.
    void addTo(FamilyGains& found, double byte) {
        const double bytes = node_.surface() ? kPairBytes : kOneBytes;
        const auto maxWorth = [&](double error) { return error > kGain ? volume(error) / bytes : 0.0; };
        double error = takeSamples([&](double most) { return maxWorth(kEarlyEndFactor * most) <= byte; });
        if (maxWorth(error) > byte) {
            dropBuriedSamples();
            error = errorWithout();
        }
        if (maxWorth(error) > byte) {
            node_.surface() ? addSurface(found.gains) : addEmpty(found.gains);
        } else {
            found.rest = std::max(found.rest, maxWorth(error));
        }
    }

  private:
    [[nodiscard]] double errorOf(const Votes& votes) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            sum += samples_[i].errorOf(votes[i]);
        }
        return sum / static_cast<double>(kSamples);
    }
    [[nodiscard]] Votes votesWithout() const {
        Votes votes;
        std::ranges::transform(samples_, votes.begin(), &Sample::without);
        return votes;
    }
    [[nodiscard]] double errorWithout() const { return baseline_ ? errorOf(votesWithout()) : kErrorMax; }

    /// \param hopeless  whether planes cannot pay off at a given mean error; if true for the upper bound, the search ends.
    /// \return an upper bound of the mean error; exact after a complete search.
    template <class Hopeless>
    double takeSamples(const Hopeless& hopeless) {
        const MeshCell& cell = node_.cell;
        std::vector<Candidate> candidates = candidatesOf();
        double sum = 0.0;
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            double most = sum;
            for (std::size_t k = i; k < candidates.size(); ++k) {
                most += candidates[k].maxError();
            }
            most *= kRoundingMargin / static_cast<double>(kSamples);
            if (baseline_ && hopeless(most)) {
                return most;
            }
            Sample& sample = candidates[i].sample;
            const glm::dvec3 p = cell.low + cell.size * sample.at;
            const ClosestPoint closest = query_.closest(glm::vec3(p), candidates[i].hint);
            const glm::dvec3 way = closest.point - p;
            sample.distance = length(way) / cell.size;
            if (sample.distance > kNoDirection) {
                sample.normal = unit(way);
                sum += sample.errorOf(sample.without);
                samples_.push_back(sample);
            }
            for (std::size_t k = i + 1; k < candidates.size(); ++k) {
                candidates[k].limitBy(sample, sample.at + way / cell.size, closest.triangle);
            }
        }
        return errorWithout();
    }
    /// The points of the leaf that are inside.
    [[nodiscard]] std::vector<Candidate> candidatesOf() const {
        std::vector<Candidate> candidates;
        candidates.reserve(kSamples);
        for (unsigned i = 0; i < kSamples; ++i) {
            const glm::dvec3 at =
                i < 8 ? glm::mix(glm::dvec3(kBesideCorner), glm::dvec3(1.0 - kBesideCorner), cornerOfCube(i))
                      : glm::dvec3(0.5);
            const PatchVote vote = baseline_ ? baseline_->cell.vote(baseline_->tree, at) : PatchVote{};
            if (node_.surface()
                    ? vote.distance < 0.0F
                    : node_.empty() || query_.inside(glm::vec3(node_.cell.low + node_.cell.size * at))) {
                candidates.push_back({.sample = {.at = at, .without = vote}});
            }
        }
        return candidates;
    }
    /// Drops samples whose nearest surface is not a boundary of the solid: it lies within another body or in a filled
    /// void. Samples that are outside, in a corner that the surface of the leaf omits, get a negative distance.
    void dropBuriedSamples() {
        const auto inside = [&](const glm::dvec3& at) {
            return query_.inside(glm::vec3(node_.cell.low + node_.cell.size * at));
        };
        std::vector<Sample> kept;
        for (Sample& sample : samples_) {
            if (inside(sample.at + (sample.distance + kBeyond) * sample.normal)) {
                if (inside(sample.at)) {
                    continue;
                }
                sample.distance = -sample.distance;
                sample.normal = -sample.normal;
            }
            kept.push_back(sample);
        }
        samples_ = std::move(kept);
    }

    /// For a leaf without a surface.
    void addEmpty(std::vector<DepthGain>& gains) const {
        const auto flatOf = [](const CellPlane& plane, double per_cell) {
            return PatchRecord::flat(true, glm::vec3(plane.normal),
                                     static_cast<float>(per_cell * plane.offset));
        };
        Best one;
        for (const Sample& sample : samples_) {
            one.consider(flatOf(sample.plane(), roots_per_cell_),
                         errorOf(votesOf(flatOf(sample.plane(), 1.0))));
        }
        const double before = baseline_ ? errorWithout() : one.error;
        DepthGain first{.node = &node_};
        double left = before;
        if (pays(before, one.error)) {
            left = one.error;
            first.to = DepthPlanes::kOne;
            first.records[0] = one.record;
            first.bytes = kOneBytes;
            first.volume = volume(before - one.error);
        }
        DepthGain second{.node = &node_};
        const std::vector<Patch> patches = left > kGain ? patchesOf() : std::vector<Patch>();
        if (!patches.empty()) {
            const Patch& nearest = *std::ranges::min_element(
                patches, {}, [&](const Patch& patch) { return errorOf(patch.votes); });
            const Best other = bestWith(nearest.votes, patches);
            if (pays(left, other.error)) {
                second.to = DepthPlanes::kTwo;
                second.records = {nearest.record, other.record};
                second.bytes = kPairBytes + (baseline_ ? kOneBytes : 0.0);
                second.volume = volume(before - other.error);
            }
        }
        if (first.to == DepthPlanes::kOne && second.to == DepthPlanes::kTwo) {
            if (second.worth() < first.worth()) {
                second.from = first.to;
                second.bytes -= first.bytes;
                second.volume -= first.volume;
            } else {
                first.to = DepthPlanes::kNone;
            }
        }
        std::ranges::copy_if(std::array{first, second}, std::back_inserter(gains),
                             [](const DepthGain& gain) { return gain.to != DepthPlanes::kNone; });
    }

    /// For a leaf with a single surface: adds the plane of a face outside the cell that is nearer for some points.
    void addSurface(std::vector<DepthGain>& gains) const {
        const std::vector<Patch> patches = patchesOf();
        const Best best = bestWith(votesWithout(), patches);
        const double gain = errorWithout() - best.error;
        if (gain > kGain) {
            gains.push_back(
                {&node_, DepthPlanes::kNone, DepthPlanes::kTwo, {best.record, {}}, kPairBytes, volume(gain)});
        }
    }

    static bool pays(double before, double after) {
        return before - after > kGain && after < kErrorRatioMax * before;
    }
    [[nodiscard]] double volume(double error) const {
        return kWorth * error * node_.cell.size * node_.cell.size * node_.cell.size;
    }
    [[nodiscard]] Votes votesOf(const PatchRecord& record) const {
        const SmallTree tree(record);
        Votes votes;
        std::ranges::transform(samples_, votes.begin(),
                               [&](const Sample& sample) { return Cell().vote(tree, sample.at); });
        return votes;
    }
    /// A plane of a sample with the whole cell behind it.
    struct Patch {
        PatchRecord record;
        Votes votes;
    };
    [[nodiscard]] std::vector<Patch> patchesOf() const {
        std::vector<Patch> patches;
        for (const Sample& sample : samples_) {
            const std::optional<PatchRecord> record = patchOf(sample.plane());
            const auto same = [&](const Patch& other) {
                return other.record.low == record->low && other.record.high == record->high;
            };
            if (record && std::ranges::none_of(patches, same)) {
                patches.push_back({*record, votesOf(*record)});
            }
        }
        return patches;
    }
    /// Returns the patch with the lowest error in a pair with another patch, whose votes are `other`.
    [[nodiscard]] Best bestWith(const Votes& other, std::span<const Patch> patches) const {
        Best best;
        for (const Patch& patch : patches) {
            Votes pair = other;
            for (std::size_t i = 0; i < samples_.size(); ++i) {
                pair[i] = patch.votes[i].distance > pair[i].distance ? patch.votes[i] : pair[i];
            }
            best.consider(patch.record, errorOf(pair));
        }
        return best;
    }

    const MeshQuery& query_;
    PatchNode& node_;
    const std::optional<Baseline>& baseline_;
    double roots_per_cell_;
    std::vector<Sample> samples_;
};

/// Returns the plane of the nearest face for a leaf without a surface, if that face is flat and the plane of the split
/// cell above is tilted relative to it.
std::optional<DepthGain> facePlane(const MeshQuery& query, std::span<const FlatFace> faces, PatchNode& leaf,
                                   const Baseline& above, double roots_per_cell) {
    const MeshCell& cell = leaf.cell;
    const glm::dvec3 middle = cell.middle();
    const ClosestPoint closest = query.closest(glm::vec3(middle));
    const glm::dvec3 way = (closest.point - middle) / cell.size;
    const double distance = length(way);
    if (!(distance > kNoDirection) || distance > kFaceNear ||
        faces[closest.triangle].length < kFaceLength * cell.size) {
        return std::nullopt;
    }
    // The mesh may graze a leaf without a surface.
    if (!cell.triangles.empty() && query.inside(glm::vec3(middle)) != leaf.inside()) {
        return std::nullopt;
    }
    const double side = leaf.inside() ? 1.0 : -1.0;
    const CellPlane plane{side * unit(way), -side * distance};
    const double turn =
        length(plane.normal - glm::dvec3(above.cell.vote(above.tree, glm::dvec3(0.5)).normal));
    if (turn < kFaceTurn ||
        (leaf.inside() && query.inside(glm::vec3(closest.point + kBeyond * cell.size * plane.normal)))) {
        return std::nullopt;
    }
    for (unsigned i = 0; i < 8; ++i) {
        const glm::dvec3 corner = cornerOfCube(i);
        const double other =
            query.closest(glm::vec3(cell.low + cell.size * corner), closest.triangle).distance / cell.size;
        if (std::abs(other - std::abs(plane.at(corner))) > kFaceFlat) {
            return std::nullopt;
        }
    }
    DepthGain gain{.node = &leaf, .to = DepthPlanes::kOne, .bytes = kOneBytes};
    gain.records[0] = PatchRecord::flat(leaf.inside(), glm::vec3(plane.normal),
                                        static_cast<float>(roots_per_cell * plane.offset));
    gain.volume = kFaceWorth * std::min(turn, kFaceTurnMax) * cell.size * cell.size * cell.size;
    return gain;
}

/// Returns the tree of a leaf with a single surface. 3² heights stand in for 5² heights, which are not fitted yet.
SmallTree treeOf(const PatchNode& leaf) {
    const PatchHeights& heights =
        leaf.heights[std::min<std::size_t>(leaf.chosen - kFlats, leaf.heights.size() - 1)];
    SmallTree tree(PatchRecord::patch(patchFrames()[leaf.frame.index], leaf.turned, heights, 2));
    for (std::uint32_t k = 0; k < heightTexels(heights.side); ++k) {
        tree.add(heights.texel(k));
    }
    return tree;
}

SmallTree treeOfSplit(const MeshQuery& query, const PatchNode& node) {
    const CellPlane plane = planeOfSplit(query, node);
    return SmallTree(
        PatchRecord::split(0, 0xffU, 0, glm::vec3(plane.normal), static_cast<float>(plane.offset)));
}

/// Appends split cells, and the root if it is a leaf. The leaves of each such family are processed together.
void addFamilies(PatchNode& node, std::vector<PatchNode*>& families) {
    families.push_back(&node);
    for (std::size_t i = 0; node.split && i < 8; ++i) {
        if ((*node.children)[i].split) {
            addFamilies((*node.children)[i], families);
        }
    }
}

std::span<PatchNode> membersOf(PatchNode& family) {
    return family.split ? std::span<PatchNode>(*family.children) : std::span(&family, 1);
}

/// A hash of the leaves of a family.
std::uint64_t stateOf(PatchNode& family) {
    std::uint64_t state = 1;
    for (const PatchNode& node : membersOf(family)) {
        state = state << 4U | (node.split ? kPatchShapes.size() : node.chosen);
    }
    return state;
}

/// \param byte, least_byte  as in DepthPlaneChoice::find().
/// \param root_size  object units.
FamilyGains gainsOf(const MeshQuery& query, std::span<const FlatFace> faces, PatchNode& family,
                    double root_size, double byte, double least_byte) {
    FamilyGains found;
    const auto mayPay = [&](const PatchNode& leaf, double bytes) {
        return kWorth * kErrorMax * leaf.cell.size * leaf.cell.size * leaf.cell.size > least_byte * bytes;
    };
    const bool flat = family.split && std::ranges::any_of(family.cell.triangles, [&](std::uint32_t triangle) {
                          return faces[triangle].length >= 0.5 * kFaceLength * family.cell.size;
                      });
    std::optional<Baseline> above;
    const std::span<PatchNode> members = membersOf(family);
    for (unsigned i = 0; i < members.size(); ++i) {
        PatchNode& leaf = members[i];
        if (leaf.split) {
            continue;
        }
        const double roots_per_cell = leaf.cell.size / root_size;
        if (leaf.surface()) {
            if (!leaf.shape().pair && mayPay(leaf, kPairBytes)) {
                const std::optional<Baseline> own = Baseline{{}, treeOf(leaf)};
                LeafChooser(query, leaf, own, roots_per_cell).addTo(found, byte);
            }
            continue;
        }
        const bool deep = leaf.inside() && mayPay(leaf, kOneBytes);
        if (family.split && (flat || deep)) {
            above = Baseline{Cell(i), above ? above->tree : treeOfSplit(query, family)};
        }
        if (flat) {
            if (const std::optional<DepthGain> face = facePlane(query, faces, leaf, *above, roots_per_cell)) {
                found.gains.push_back(*face);
                continue;
            }
        }
        if (deep) {
            LeafChooser(query, leaf, above, roots_per_cell).addTo(found, byte);
        }
    }
    return found;
}

}  // namespace

CellPlane planeOfSplit(const MeshQuery& query, const PatchNode& node) {
    CellPlane plane = meanPlane(clippedTriangles(unitTriangles(query.mesh(), node.cell)));
    int agree = 0;
    for (unsigned i = 0; i < 8; ++i) {
        const PatchNode& child = (*node.children)[i];
        if (!child.split && !child.surface()) {
            const glm::dvec3 middle = 0.5 * cornerOfCube(i) + 0.25;
            agree += (plane.at(middle) < 0.0) == child.inside() ? 1 : -1;
        }
    }
    if (agree < 0) {  // the mesh is not wound outwards
        plane = {-plane.normal, -plane.offset};
    }
    return plane;
}

void DepthPlaneChoice::find(std::span<PatchNode> roots, double byte, double least_byte,
                            const std::function<void()>& progress) {
    std::vector<PatchNode*> families;
    for (PatchNode& root : roots) {
        addFamilies(root, families);
    }
    for (PatchNode* const family : families) {
        known_.try_emplace(family);
    }
    forEachIndex(0, families.size(), 4, [&](std::size_t i) {
        Known& known = known_.find(families[i])->second;
        if (const std::uint64_t state = stateOf(*families[i]); known.state != state) {
            known = {.state = state, .least_byte = least_byte};
        }
        if (known.found.rest > byte) {
            known.found = gainsOf(query_, faces_, *families[i], roots[0].cell.size, byte, known.least_byte);
        }
        progress();
    });
    gains_.clear();
    for (PatchNode* const family : families) {
        std::ranges::copy_if(known_.find(family)->second.found.gains, std::back_inserter(gains_),
                             [&](const DepthGain& gain) { return gain.worth() > byte; });
    }
    std::ranges::stable_sort(gains_, std::greater(), &DepthGain::worth);
}

double DepthPlaneChoice::bytesWorth(double byte) const {
    double bytes = 0.0;
    for (const DepthGain& gain : gains_) {
        bytes += gain.worth() > byte ? gain.bytes : 0.0;
    }
    return bytes;
}

double DepthPlaneChoice::take(double bytes) const {
    for (const DepthGain& gain : gains_) {
        if (gain.bytes <= bytes && gain.node->planes == gain.from) {
            gain.node->planes = gain.to;
            gain.node->depth = gain.records;
            bytes -= gain.bytes;
        }
    }
    return bytes;
}

}  // namespace relief
