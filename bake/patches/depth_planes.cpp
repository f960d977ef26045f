#include "bake/patches/depth_planes.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bake/mesh/loops.h"
#include "bake/patches/leaf_fitter.h"

namespace relief {
namespace {

/// Samples of a cell: its middle, and eight so far from its sides.
constexpr double kBesideCorner = 0.1;
constexpr std::size_t kSamples = 9;
/// A turn of the normal counts as much as this error of the distance, in cells.
constexpr double kTurn = 0.25;
/// More planes are worth their bytes from these mean errors on, in cells, and if they leave less than this share.
constexpr double kOneGains = 0.004;
constexpr double kTwoGain = 0.005;
constexpr double kLeftAtMost = 0.6;
/// In cells, that the corners of a cell lie behind both planes.
constexpr double kBehind = 1.0 / 512.0;
/// In cells, that heights of a patch can hold.
constexpr double kHighest = 3.9;
/// In cells: a nearer surface has no direction.
constexpr double kNoDirection = 1e-6;
/// Of the volume of a cell whose depths are off by its size: so much counts as much as volume on the wrong side.
constexpr double kWorth = 3e-3;
/// Bytes beside a bit in the record above, or beside the record of a patch.
constexpr double kOneBytes = kPatchTexelBytes;
constexpr double kTwoBytes = 3.0 * kPatchTexelBytes;
constexpr double kSecondBytes = 2.0 * kPatchTexelBytes;

/// A point of a cell and the surface nearest to it.
struct Sample {
    glm::dvec3 at{0.0};      // unit cube
    double distance = 0.0;   // cells
    glm::dvec3 normal{0.0};  // from the point inside to the surface
    std::uint32_t triangle = 0;

    [[nodiscard]] CellPlane plane() const { return {normal, dot(normal, glm::dvec3(0.5) - at) - distance}; }
    [[nodiscard]] double errorOf(double distance_there, const glm::dvec3& normal_there) const {
        return std::abs(distance_there + distance) + kTurn * length(normal_there - normal);
    }
    [[nodiscard]] double errorOf(const CellPlane& one) const { return errorOf(one.at(at), one.normal); }
    [[nodiscard]] double errorOf(const CellPlane& one, const CellPlane& other) const {
        return other.at(at) > one.at(at) ? errorOf(other) : errorOf(one);
    }
};

glm::dvec3 placeOf(std::size_t sample) {
    if (sample + 1 == kSamples) {
        return glm::dvec3(0.5);
    }
    const auto side = [&](unsigned bit) {
        return (sample >> bit & 1U) != 0 ? 1.0 - kBesideCorner : kBesideCorner;
    };
    return {side(0), side(1), side(2)};
}

Sample sampleAt(const MeshQuery& query, const MeshCell& cell, const glm::dvec3& at) {
    const glm::dvec3 p = cell.low + cell.size * at;
    const ClosestPoint closest = query.closest(glm::vec3(p));
    const glm::dvec3 way = closest.point - p;
    const double distance = length(way) / cell.size;
    return {at, distance, distance > kNoDirection ? unit(way) : unitNormal(query.mesh(), closest.triangle),
            closest.triangle};
}

template <class ErrorOf>
double meanOf(std::span<const Sample> samples, const ErrorOf& error_of) {
    double sum = 0.0;
    for (const Sample& sample : samples) {
        sum += error_of(sample);
    }
    return sum / static_cast<double>(samples.size());
}

bool liesBehind(const CellPlane& plane) {
    for (unsigned i = 0; i < 8; ++i) {
        if (!(plane.at(glm::dvec3(i & 1U, i >> 1U & 1U, i >> 2U)) < -kBehind)) {
            return false;
        }
    }
    return true;
}

/// A patch of 2² heights; nullopt: its heights do not reach so far.
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

/// The plane nearest to the cell, and the one that is missed most beside it.
std::optional<Two> twoOf(std::span<const Sample> samples) {
    const auto nearest = std::ranges::min_element(samples, {}, &Sample::distance);
    const CellPlane one = nearest->plane();
    const auto missed =
        std::ranges::max_element(samples, {}, [&](const Sample& sample) { return sample.errorOf(one); });
    const CellPlane other = missed->plane();
    const std::optional<PatchRecord> first = patchOf(one);
    const std::optional<PatchRecord> second = patchOf(other);
    if (!first || !second || !liesBehind(one) || !liesBehind(other)) {
        return std::nullopt;
    }
    return Two{{*first, *second}, {one, other}};
}

std::array<Sample, kSamples> samplesOf(const MeshQuery& query, const MeshCell& cell) {
    std::array<Sample, kSamples> samples;
    for (std::size_t i = 0; i < kSamples; ++i) {
        samples[i] = sampleAt(query, cell, placeOf(i));
    }
    return samples;
}

/// A cell without a surface that is inside.
/// \param now  the plane that it has: that of the cell above, or of a root its own.
DepthGain gainOfEmpty(const MeshQuery& query, PatchNode& node, const CellPlane& now, bool root) {
    const std::array<Sample, kSamples> samples = samplesOf(query, node.cell);
    const CellPlane middle = planeOfMiddle(query, node);
    const auto errorWith = [](const auto&... planes) {
        return [=](const Sample& sample) { return sample.errorOf(planes...); };
    };
    const double before = meanOf(samples, errorWith(now));
    const double with_one = root ? before : meanOf(samples, errorWith(middle));
    DepthGain gain{.node = &node};
    double left = before;
    if (before - with_one > kOneGains && with_one < kLeftAtMost * before) {
        gain.planes = DepthPlanes::kOne;
        gain.bytes = kOneBytes;
        left = with_one;
    }
    if (left > kTwoGain) {
        if (const std::optional<Two> two = twoOf(samples)) {
            const double with_two = meanOf(samples, errorWith(two->planes[0], two->planes[1]));
            if (left - with_two > kTwoGain && with_two < kLeftAtMost * left) {
                gain.planes = DepthPlanes::kTwo;
                gain.bytes = root ? kSecondBytes : kTwoBytes;
                left = with_two;
            }
        }
    }
    const double size = node.cell.size;
    gain.volume = kWorth * (before - left) * size * size * size;
    return gain;
}

/// The face beyond a cell with a single surface that is nearer to points of its inside.
std::optional<std::pair<Sample, double>> faceBeyond(const MeshQuery& query, const PatchNode& node) {
    const MeshCell& cell = node.cell;
    std::optional<Sample> beyond;
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
                beyond = sample;
            }
        }
    }
    const double mean = sum / static_cast<double>(kSamples);
    if (!beyond || !(mean > kTwoGain) || !liesBehind(beyond->plane())) {
        return std::nullopt;
    }
    return std::pair(*beyond, mean);
}

class Chooser {
  public:
    explicit Chooser(const MeshQuery& query) : query_(query) {}

    void visitRoot(PatchNode& root) {
        visit(root, root.split || root.surface() ? CellPlane() : planeOfMiddle(query_, root), true);
    }
    [[nodiscard]] const std::vector<DepthGain>& gains() const { return gains_; }

  private:
    void visit(PatchNode& node, const CellPlane& above, bool root) {
        if (node.split) {
            const CellPlane plane = planeOfSplit(query_, node);
            for (unsigned i = 0; i < 8; ++i) {
                // In the unit cube of the octant.
                const glm::dvec3 middle = 0.5 * glm::dvec3(i & 1U, i >> 1U & 1U, i >> 2U) + 0.25;
                visit((*node.children)[i], {plane.normal, 2.0 * plane.at(middle)}, false);
            }
        } else if (node.surface()) {
            if (!node.shape().pair) {
                if (const auto beyond = faceBeyond(query_, node); beyond && patchOf(beyond->first.plane())) {
                    const double size = node.cell.size;
                    add({&node, DepthPlanes::kTwo, kSecondBytes,
                         kWorth * beyond->second * size * size * size});
                }
            }
        } else if (node.inside()) {
            add(gainOfEmpty(query_, node, above, root));
        }
    }
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
            const glm::dvec3 middle = 0.5 * glm::dvec3(i & 1U, i >> 1U & 1U, i >> 2U) + 0.25;
            agree += (plane.at(middle) < 0.0) == child.inside() ? 1 : -1;
        }
    }
    if (agree < 0) {  // of meshes that are not wound
        plane = {-plane.normal, -plane.offset};
    }
    return plane;
}

CellPlane planeOfMiddle(const MeshQuery& query, const PatchNode& node) {
    const glm::dvec3 middle = node.cell.middle();
    const ClosestPoint closest = query.closest(glm::vec3(middle));
    const bool inside = node.inside();
    glm::dvec3 away = middle - closest.point;
    away = length(away) > 0.0 ? (inside ? -away : away) : unitNormal(query.mesh(), closest.triangle);
    const double distance = closest.distance / node.cell.size;
    return {unit(away), inside ? -distance : distance};
}

std::optional<std::array<PatchRecord, 2>> depthPlanesOf(const MeshQuery& query, const PatchNode& node) {
    if (node.surface()) {
        const auto beyond = faceBeyond(query, node);
        const auto record = beyond ? patchOf(beyond->first.plane()) : std::nullopt;
        return record ? std::optional(std::array<PatchRecord, 2>{PatchRecord(), *record}) : std::nullopt;
    }
    const std::optional<Two> two = twoOf(samplesOf(query, node.cell));
    return two ? std::optional(two->records) : std::nullopt;
}

DepthPlaneChoice::DepthPlaneChoice(const MeshQuery& query, std::span<PatchNode> roots) {
    std::vector<Chooser> choosers(roots.size(), Chooser(query));
    forEachIndex(0, roots.size(), 1, [&](std::size_t i) { choosers[i].visitRoot(roots[i]); });
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
