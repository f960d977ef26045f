#include "formats/compare.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "formats/base/text.h"
#include "formats/nearest_surface.h"

namespace relief {
namespace {

std::string vectorText(const glm::vec3& v) {
    return "(" + shortest(v.x) + ", " + shortest(v.y) + ", " + shortest(v.z) + ")";
}

std::string boundsText(const Bounds& bounds) {
    return vectorText(bounds.min) + " to " + vectorText(bounds.max);
}

std::string rowText(const glm::vec4& row) {
    return shortest(row.x) + " " + shortest(row.y) + " " + shortest(row.z) + " " + shortest(row.w);
}

std::string quoted(const std::string& text) {
    return "'" + text + "'";
}

std::string formatText(const DepthMap& map) {
    return std::string(mapFormatName(map.format)) + " (" + depthEncodingName(map.format) + ")";
}

std::string sizeText(const DepthMap& map) {
    return std::to_string(map.width) + "x" + std::to_string(map.height);
}

/// Collects differences in the order of the checks.
class Differences {
  public:
    template <class T, class Text>
    void check(const char* what, const T& a, const T& b, const Text& text) {
        if (!(a == b)) {
            found.push_back({what, text(a), text(b)});
        }
    }
    std::vector<Difference> found;
};

std::vector<Difference> mapStructure(const DepthMap& a, const DepthMap& b) {
    Differences all;
    if (a.format != b.format) {
        all.found.push_back({"format", formatText(a), formatText(b)});
    }
    if (a.width != b.width || a.height != b.height) {
        all.found.push_back({"size", sizeText(a), sizeText(b)});
    }
    all.check("compare", a.compare, b.compare, compareName);
    all.check("decode", a.decode, b.decode, decodeName);
    constexpr const char* kRows[] = {"object_to_map row 0", "object_to_map row 1", "object_to_map row 2"};
    for (std::size_t i = 0; i < 3; ++i) {
        all.check(kRows[i], a.object_to_map.row[i], b.object_to_map.row[i], rowText);
    }
    all.check("object_per_map", a.object_per_map, b.object_per_map, vectorText);
    const auto yesNo = [](bool value) { return value ? "yes" : "no"; };
    all.check("encloses", a.encloses, b.encloses, yesNo);
    all.check("empty_is_outside", a.empty_is_outside, b.empty_is_outside, yesNo);
    return all.found;
}

std::vector<Difference> colliderStructure(const Collider& a, const Collider& b) {
    Differences all;
    all.check("maps", a.maps.size(), b.maps.size(), [](std::size_t n) { return std::to_string(n); });
    all.check("bounds", a.bounds, b.bounds, boundsText);
    all.check("unit", a.unit, b.unit, quoted);
    return all.found;
}

std::vector<Difference> provenanceDifferences(const Provenance& a, const Provenance& b) {
    Differences all;
    all.check("mesh_name", a.mesh_name, b.mesh_name, quoted);
    all.check("mesh_hash", a.mesh_hash, b.mesh_hash, quoted);
    all.check("triangles", a.triangles, b.triangles, [](std::uint64_t n) { return std::to_string(n); });
    all.check("tool_version", a.tool_version, b.tool_version, quoted);
    all.check("options", a.optionsText(), b.optionsText(), quoted);
    return all.found;
}

constexpr double kMargin = 0.1;  // round the box, of its longest side
constexpr double kNear = 0.01;   // of the same
constexpr std::uint64_t kMapsAtAllPoints = 16;
constexpr double kShare = 0.99;  // of DifferenceStatistics::percentile_99

/// The digits of i in a base, mirrored at the point: Halton's sequence along one axis, in [0, 1).
double mirrored(std::uint64_t i, std::uint64_t base) {
    double value = 0.0;
    double digit = 1.0;
    for (; i > 0; i /= base) {
        digit /= static_cast<double>(base);
        value += digit * static_cast<double>(i % base);
    }
    return value;
}

bool knowsDistance(const SurfaceSample& sample) {
    return sample.map >= 0 && std::abs(sample.distance) < kFarOutside;
}

/// Differences of points, added one after the other.
class Points {
  public:
    void add(const SurfaceSample& a, const SurfaceSample& b) {
        ++result_.points;
        result_.only_a += a.inside() && !b.inside() ? 1 : 0;
        result_.only_b += b.inside() && !a.inside() ? 1 : 0;
        if (knowsDistance(a) != knowsDistance(b)) {
            ++result_.one_known;
        } else if (knowsDistance(a)) {
            distances_.push_back(std::abs(double{a.distance} - double{b.distance}));
        }
    }

    PointsDifference done() {
        result_.distances = distances_.size();
        DifferenceStatistics& statistics = result_.distance;
        double sum = 0.0;
        std::sort(distances_.begin(), distances_.end());  // first: the sum then has one order
        for (const double distance : distances_) {
            sum += distance;
            statistics.differing += distance > 0.0 ? 1 : 0;
        }
        if (!distances_.empty()) {
            const auto count = static_cast<double>(distances_.size());
            statistics.max = distances_.back();
            statistics.mean = sum / count;
            statistics.percentile_99 = distances_[static_cast<std::size_t>(std::ceil(kShare * count)) - 1];
        }
        return result_;
    }

  private:
    PointsDifference result_;
    std::vector<double> distances_;
};

}  // namespace

bool ColliderDifference::any() const {
    return !structure.empty() || std::any_of(maps.begin(), maps.end(), [](const MapDifference& map) {
        return !map.structure.empty() || !map.same_texels;
    });
}

ColliderDifference compareColliders(const Collider& a, const Collider& b) {
    ColliderDifference result;
    result.structure = colliderStructure(a, b);
    result.provenance = provenanceDifferences(a.provenance, b.provenance);
    for (std::size_t i = 0; i < std::min(a.maps.size(), b.maps.size()); ++i) {
        result.maps.push_back({mapStructure(a.maps[i], b.maps[i]), a.maps[i].texels == b.maps[i].texels});
    }
    return result;
}

double PointsDifference::sidesPercent() const {
    return points == 0 ? 0.0 : 100.0 * static_cast<double>(only_a + only_b) / static_cast<double>(points);
}

FieldsDifference compareFields(const Collider& a, const Collider& b, const CompareFieldsOptions& options) {
    const glm::dvec3 low = glm::min(glm::dvec3(a.bounds.min), glm::dvec3(b.bounds.min));
    const glm::dvec3 high = glm::max(glm::dvec3(a.bounds.max), glm::dvec3(b.bounds.max));
    const glm::dvec3 size = high - low;
    const double longest = std::max({size.x, size.y, size.z});
    Points box;
    Points near;
    const std::uint64_t maps = std::max<std::uint64_t>(a.maps.size() + b.maps.size(), kMapsAtAllPoints);
    const std::uint64_t points = options.points * kMapsAtAllPoints / maps;
    for (std::uint64_t i = 1; i <= points; ++i) {
        const glm::dvec3 share(mirrored(i, 2), mirrored(i, 3), mirrored(i, 5));
        const glm::dvec3 offset = glm::dvec3(mirrored(i, 7), mirrored(i, 11), mirrored(i, 13)) * 2.0 - 1.0;
        const glm::vec3 p(low - kMargin * longest + share * (size + 2.0 * kMargin * longest));
        const SurfaceSample of_a = nearestSurface(a, p);
        const SurfaceSample of_b = nearestSurface(b, p);
        box.add(of_a, of_b);
        for (const SurfaceSample& of : {of_a, of_b}) {
            if (knowsDistance(of)) {
                const glm::vec3 q(glm::dvec3(of.point) + kNear * longest * offset);
                near.add(nearestSurface(a, q), nearestSurface(b, q));
            }
        }
    }
    return {box.done(), near.done()};
}

}  // namespace relief
