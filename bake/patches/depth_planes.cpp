#include "bake/patches/depth_planes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <limits>
#include <vector>

#include "bake/mesh/loops.h"
#include "bake/patches/leaf_fitter.h"

namespace relief {
namespace {

/// A cell is sampled at its middle, and at eight points this far from its sides.
constexpr double kBesideCorner = 0.1;
constexpr std::size_t kSamples = 9;
/// Distance error, in cells, that weighs as much as a unit difference of the normals.
constexpr double kTurn = 0.25;
/// Planes are only added if they lower the mean error by this much, in cells, ...
constexpr double kOneGains = 0.004;
constexpr double kTwoGain = 0.005;
/// ... and leave less than this fraction of it.
constexpr double kLeftAtMost = 0.6;
/// The corners of a cell lie at least this far behind both planes, in cells.
constexpr double kBehind = 1.0 / 512.0;
/// Largest height that a patch can hold, in cells.
constexpr double kHighest = 3.9;
/// The direction to a nearer surface is unknown, in cells.
constexpr double kNoDirection = 1e-6;
/// Weight of the depth error, in cells times the volume of the cell, relative to misclassified volume.
constexpr double kWorth = 3e-3;
/// Bytes beside a bit in the record above, or beside the record of a patch.
constexpr double kOneBytes = kPatchTexelBytes;
constexpr double kTwoBytes = 3.0 * kPatchTexelBytes;
constexpr double kSecondBytes = 2.0 * kPatchTexelBytes;

/// Bit k of `corner` is the coordinate on axis k.
glm::dvec3 cornerOfCube(unsigned corner) {
    return {corner & 1U, corner >> 1U & 1U, corner >> 2U & 1U};
}

/// The middle of an octant, x fastest, in the unit cube of its parent.
glm::dvec3 octantMiddle(unsigned octant) {
    return 0.5 * cornerOfCube(octant) + 0.25;
}

/// A point of a cell and the surface nearest to it.
struct Sample {
    glm::dvec3 at{0.0};      // unit cube
    double distance = 0.0;   // cells
    glm::dvec3 normal{0.0};  // from the point inside to the surface
    std::uint32_t triangle = 0;

    [[nodiscard]] CellPlane plane() const { return {normal, dot(normal, glm::dvec3(0.5) - at) - distance}; }
    /// The error of the plane with the greater value at the point.
    [[nodiscard]] double errorOf(const CellPlane& one, const CellPlane& other) const {
        const CellPlane& deciding = other.at(at) > one.at(at) ? other : one;
        return std::abs(deciding.at(at) + distance) + kTurn * length(deciding.normal - normal);
    }
};
using Samples = std::array<Sample, kSamples>;

Sample sampleAt(const MeshQuery& query, const MeshCell& cell, const glm::dvec3& at) {
    const glm::dvec3 p = cell.low + cell.size * at;
    const ClosestPoint closest = query.closest(glm::vec3(p));
    const glm::dvec3 way = closest.point - p;
    const double distance = length(way) / cell.size;
    return {at, distance, distance > kNoDirection ? unit(way) : unitNormal(query.mesh(), closest.triangle),
            closest.triangle};
}

/// The last sample is that of the middle.
Samples samplesOf(const MeshQuery& query, const MeshCell& cell) {
    Samples samples;
    for (unsigned i = 0; i < 8; ++i) {
        samples[i] =
            sampleAt(query, cell,
                     glm::mix(glm::dvec3(kBesideCorner), glm::dvec3(1.0 - kBesideCorner), cornerOfCube(i)));
    }
    samples.back() = sampleAt(query, cell, glm::dvec3(0.5));
    return samples;
}

double meanError(const Samples& samples, const CellPlane& one, const CellPlane& other) {
    double sum = 0.0;
    for (const Sample& sample : samples) {
        sum += sample.errorOf(one, other);
    }
    return sum / static_cast<double>(kSamples);
}

bool liesBehind(const CellPlane& plane) {
    for (unsigned i = 0; i < 8; ++i) {
        if (!(plane.at(cornerOfCube(i)) < -kBehind)) {
            return false;
        }
    }
    return true;
}

/// Returns a patch of 2² heights; nullopt if they are out of range.
std::optional<PatchRecord> patchOf(const CellPlane& plane) {
    const glm::dvec3 size = glm::abs(plane.normal);
    const std::uint8_t first = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const int u = (first + 1) % 3;
    const int v = (first + 2) % 3;
    std::array<double, 4> heights{};
    for (unsigned i = 0; i < 4; ++i) {
        glm::dvec3 corner(0.0);
        corner[u] = i & 1U;
        corner[v] = i >> 1U;
        heights[i] = -plane.at(corner) / plane.normal[first];
        if (!(std::abs(heights[i]) <= kHighest)) {
            return std::nullopt;
        }
    }
    return PatchRecord::patch({0, first, 0}, plane.normal[first] < 0.0, PatchHeights::of(heights, 2), 0);
}

struct Two {
    std::array<PatchRecord, 2> records;
    std::array<CellPlane, 2> planes;
};

/// The plane nearest to the cell, and the plane of the sample with the largest error. Returns nullopt if one cannot be stored or
/// cuts the cell.
std::optional<Two> twoOf(const Samples& samples) {
    const auto nearest = std::ranges::min_element(samples, {}, &Sample::distance);
    const CellPlane one = nearest->plane();
    const auto missed =
        std::ranges::max_element(samples, {}, [&](const Sample& sample) { return sample.errorOf(one, one); });
    const CellPlane other = missed->plane();
    const std::optional<PatchRecord> first = patchOf(one);
    const std::optional<PatchRecord> second = patchOf(other);
    if (!first || !second || !liesBehind(one) || !liesBehind(other)) {
        return std::nullopt;
    }
    return Two{{*first, *second}, {one, other}};
}

double worthOf(const MeshCell& cell, double error) {
    return kWorth * error * cell.size * cell.size * cell.size;
}

/// The gain of a cell without a surface that is inside.
/// \param above  the plane of the split cell above; null for a root, which has a plane of its own.
DepthGain gainOfEmpty(const MeshQuery& query, PatchNode& node, const CellPlane* above) {
    const Samples samples = samplesOf(query, node.cell);
    const CellPlane middle = samples.back().plane();
    const double with_one = meanError(samples, middle, middle);
    const double before = above != nullptr ? meanError(samples, *above, *above) : with_one;
    DepthGain gain{.node = &node};
    double left = before;
    if (before - with_one > kOneGains && with_one < kLeftAtMost * before) {
        gain.planes = DepthPlanes::kOne;
        gain.bytes = kOneBytes;
        left = with_one;
    }
    if (left > kTwoGain) {
        if (const std::optional<Two> two = twoOf(samples)) {
            const double with_two = meanError(samples, two->planes[0], two->planes[1]);
            if (left - with_two > kTwoGain && with_two < kLeftAtMost * left) {
                gain.planes = DepthPlanes::kTwo;
                gain.bytes = above != nullptr ? kTwoBytes : kSecondBytes;
                left = with_two;
            }
        }
    }
    gain.volume = worthOf(node.cell, before - left);
    return gain;
}

/// A face outside a cell with a single surface.
struct FaceBeyond {
    PatchRecord record;
    double error = 0.0;  // mean distance that it corrects, in cells
};

/// The face that is nearer to samples inside than the surface of the cell is. Returns nullopt if there is none, if it cannot
/// be stored, or if its plane cuts the cell.
std::optional<FaceBeyond> faceBeyond(const MeshQuery& query, const PatchNode& node) {
    const MeshCell& cell = node.cell;
    CellPlane plane;
    double most = 0.0;
    double sum = 0.0;
    for (const Sample& sample : samplesOf(query, cell)) {
        if (std::ranges::binary_search(cell.triangles, sample.triangle)) {
            continue;
        }
        double own = std::numeric_limits<double>::infinity();
        for (const std::uint32_t triangle : cell.triangles) {
            const UnitTriangle corners = cell.inUnit(query.mesh(), triangle);
            own = std::min(
                own, length(closestOnTriangle(sample.at, corners[0], corners[1], corners[2]) - sample.at));
        }
        const double gain = own - sample.distance;
        if (gain > kTwoGain && query.inside(glm::vec3(cell.low + cell.size * sample.at))) {
            sum += gain;
            if (gain > most) {
                most = gain;
                plane = sample.plane();
            }
        }
    }
    const double error = sum / static_cast<double>(kSamples);
    if (!(error > kTwoGain) || !liesBehind(plane)) {
        return std::nullopt;
    }
    const std::optional<PatchRecord> record = patchOf(plane);
    return record ? std::optional(FaceBeyond{*record, error}) : std::nullopt;
}

/// Collects the gains of the leaves below one root.
class Chooser {
  public:
    explicit Chooser(const MeshQuery& query) : query_(query) {}

    /// \param above  the plane of the split cell above, in the unit cube of the node; null for a root.
    void visit(PatchNode& node, const CellPlane* above) {
        if (node.split) {
            const CellPlane plane = planeOfSplit(query_, node);
            for (unsigned i = 0; i < 8; ++i) {
                const CellPlane in_octant{plane.normal, 2.0 * plane.at(octantMiddle(i))};
                visit((*node.children)[i], &in_octant);
            }
        } else if (node.surface()) {
            if (const auto beyond = node.shape().pair ? std::nullopt : faceBeyond(query_, node)) {
                add({&node, DepthPlanes::kTwo, kSecondBytes, worthOf(node.cell, beyond->error)});
            }
        } else if (node.inside()) {
            add(gainOfEmpty(query_, node, above));
        }
    }
    [[nodiscard]] const std::vector<DepthGain>& gains() const { return gains_; }

  private:
    void add(const DepthGain& gain) {
        if (gain.planes != DepthPlanes::kNone) {
            gains_.push_back(gain);
        }
    }

    const MeshQuery& query_;
    std::vector<DepthGain> gains_;
};

}  // namespace

CellPlane planeOfSplit(const MeshQuery& query, const PatchNode& node) {
    CellPlane plane = meanPlane(clippedTriangles(unitTriangles(query.mesh(), node.cell)));
    int agree = 0;
    for (unsigned i = 0; i < 8; ++i) {
        const PatchNode& child = (*node.children)[i];
        if (!child.split && !child.surface()) {
            agree += (plane.at(octantMiddle(i)) < 0.0) == child.inside() ? 1 : -1;
        }
    }
    if (agree < 0) {  // the mesh is not wound
        plane = {-plane.normal, -plane.offset};
    }
    return plane;
}

std::optional<std::array<PatchRecord, 2>> planesOfEmpty(const MeshQuery& query, const PatchNode& node) {
    const std::optional<Two> two = twoOf(samplesOf(query, node.cell));
    return two ? std::optional(two->records) : std::nullopt;
}

std::optional<PatchRecord> planeBeyond(const MeshQuery& query, const PatchNode& node) {
    const std::optional<FaceBeyond> beyond = faceBeyond(query, node);
    return beyond ? std::optional(beyond->record) : std::nullopt;
}

DepthPlaneChoice::DepthPlaneChoice(const MeshQuery& query, std::span<PatchNode> roots) {
    std::vector<Chooser> choosers(roots.size(), Chooser(query));
    forEachIndex(0, roots.size(), 1, [&](std::size_t i) { choosers[i].visit(roots[i], nullptr); });
    for (const Chooser& chooser : choosers) {
        gains_.insert(gains_.end(), chooser.gains().begin(), chooser.gains().end());
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

void DepthPlaneChoice::take(double bytes, double byte) const {
    for (const DepthGain& gain : gains_) {
        if (gain.worth() > byte && gain.bytes <= bytes) {
            gain.node->planes = gain.planes;
            bytes -= gain.bytes;
        }
    }
}

}  // namespace relief
