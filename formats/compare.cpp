#include "formats/compare.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <numbers>
#include <span>

#include "formats/base/text.h"

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
    all.check("options", a.options, b.options, quoted);
    return all.found;
}

/// The bits that stand for the depth of an end: a code, the bits of a half, or nothing of a float's.
std::uint16_t depthCode(MapFormat format, std::span<const std::byte> texel, std::size_t end) {
    if (isFrontBack(format)) {
        std::uint16_t code = 0;
        std::memcpy(&code, texel.data() + 2 * (2 + end), sizeof(code));
        return code;
    }
    return static_cast<std::uint16_t>(std::to_integer<unsigned>(texel[2]) << 8 |
                                      std::to_integer<unsigned>(texel[3]));
}

bool hasSurface(MapFormat format, std::span<const std::byte> texel, std::size_t end) {
    if (format == MapFormat::kFloat32) {
        float depth = 0.0F;
        std::memcpy(&depth, texel.data() + 12, sizeof(depth));
        return depth >= 0.0F;
    }
    return depthCode(format, texel, end) != 0;
}

/// By tangent: the cosine of a small angle says little about it.
double degreesBetween(const glm::vec3& a, const glm::vec3& b) {
    if (a == b) {
        return 0.0;
    }
    const glm::dvec3 u(a);
    const glm::dvec3 v(b);
    const double angle = std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));  // libm: for a report
    return angle * 180.0 / std::numbers::pi;
}

/// Amounts above 0; how many are 0 follows from `EndDifference::both`. Floats: half the memory, and their
/// rounding is far below what a depth or a normal is stored with.
struct Amounts {
    std::vector<float> depth;
    std::vector<float> normal;
    double depth_sum = 0.0;
    double normal_sum = 0.0;
};

DifferenceStatistics statisticsOf(std::span<float> amounts, double sum, std::uint64_t count) {
    DifferenceStatistics result;
    result.differing = amounts.size();
    if (amounts.empty()) {
        return result;
    }
    result.max = static_cast<double>(*std::max_element(amounts.begin(), amounts.end()));
    result.mean = sum / static_cast<double>(count);
    // The rank-th of all amounts, from 1; the first of them are zeros.
    const std::uint64_t rank = count - count / 100;
    const std::uint64_t zeros = count - amounts.size();
    if (rank > zeros) {
        const auto at = amounts.begin() + static_cast<std::ptrdiff_t>(rank - zeros - 1);
        std::nth_element(amounts.begin(), at, amounts.end());
        result.percentile_99 = static_cast<double>(*at);
    }
    return result;
}

/// Call in the order of the texels, before statisticsOf reorders them.
double sumOf(std::span<const float> amounts) {
    double sum = 0.0;
    for (const float amount : amounts) {
        sum += static_cast<double>(amount);
    }
    return sum;
}

class MapComparison {
  public:
    MapComparison(const DepthMap& a, const DepthMap& b, const CompareOptions& options)
        : a_(a), b_(b), options_(options) {}

    /// \param end  0 the front, 1 the back.
    EndDifference run(std::size_t end, Amounts& amounts) const {
        const std::size_t size = texelSize(a_.format);
        const std::size_t first_depth = amounts.depth.size();
        const std::size_t first_normal = amounts.normal.size();
        EndDifference result;
        result.ends = a_.texels.size() / size;
        for (std::size_t at = 0; at < a_.texels.size(); at += size) {
            const auto texel_a = std::span(a_.texels).subspan(at, size);
            const auto texel_b = std::span(b_.texels).subspan(at, size);
            const bool in_a = hasSurface(a_.format, texel_a, end);
            const bool in_b = hasSurface(a_.format, texel_b, end);
            result.only_a += in_a && !in_b ? 1 : 0;
            result.only_b += in_b && !in_a ? 1 : 0;
            if (!in_a || !in_b) {
                continue;
            }
            ++result.both;
            if (std::memcmp(texel_a.data(), texel_b.data(), size) != 0) {
                result.beyond += compareSurfaces(texel_a, texel_b, end, amounts) ? 1 : 0;
            }
        }
        const std::span<float> depths = std::span(amounts.depth).subspan(first_depth);
        const std::span<float> normals = std::span(amounts.normal).subspan(first_normal);
        const double depth_sum = sumOf(depths);
        const double normal_sum = sumOf(normals);
        amounts.depth_sum += depth_sum;
        amounts.normal_sum += normal_sum;
        result.depth = statisticsOf(depths, depth_sum, result.both);
        result.normal = statisticsOf(normals, normal_sum, result.both);
        return result;
    }

    [[nodiscard]] std::uint64_t texelsDiffering() const {
        const std::size_t size = texelSize(a_.format);
        std::uint64_t count = 0;
        for (std::size_t at = 0; at < a_.texels.size(); at += size) {
            count += std::memcmp(&a_.texels[at], &b_.texels[at], size) != 0 ? 1 : 0;
        }
        return count;
    }

  private:
    /// \return whether they differ by more than the options allow.
    bool compareSurfaces(std::span<const std::byte> texel_a, std::span<const std::byte> texel_b,
                         std::size_t end, Amounts& amounts) const {
        const Texel decoded_a = decodeTexel(a_.format, texel_a);
        const Texel decoded_b = decodeTexel(a_.format, texel_b);
        const Surface& a = end == 0 ? *decoded_a.front : *decoded_a.back;
        const Surface& b = end == 0 ? *decoded_b.front : *decoded_b.back;
        const double depth =
            a_.format == MapFormat::kFloat32
                ? std::abs(static_cast<double>(a.depth) - static_cast<double>(b.depth)) * double{kDepthSteps}
                : std::abs(static_cast<double>(depthCode(a_.format, texel_a, end)) -
                           static_cast<double>(depthCode(a_.format, texel_b, end)));
        const double normal = degreesBetween(a.normal, b.normal);
        if (depth > 0.0) {
            amounts.depth.push_back(static_cast<float>(depth));
        }
        if (normal > 0.0) {
            amounts.normal.push_back(static_cast<float>(normal));
        }
        return depth > options_.max_depth || normal > options_.max_normal;
    }

    const DepthMap& a_;
    const DepthMap& b_;
    const CompareOptions& options_;
};

void addCounts(EndDifference& total, const EndDifference& end) {
    total.ends += end.ends;
    total.both += end.both;
    total.only_a += end.only_a;
    total.only_b += end.only_b;
    total.beyond += end.beyond;
}

double percentOf(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

double EndDifference::coveragePercent() const {
    return percentOf(coverage(), ends);
}

double EndDifference::beyondPercent() const {
    return percentOf(beyond, both);
}

bool ColliderDifference::structureDiffers() const {
    return !structure.empty() ||
           std::any_of(maps.begin(), maps.end(), [](const MapDifference& m) { return !m.structure.empty(); });
}

bool ColliderDifference::texelsDiffer() const {
    return std::any_of(maps.begin(), maps.end(),
                       [](const MapDifference& m) { return m.texels_differing > 0; });
}

const char* depthUnit(MapFormat format) {
    return format == MapFormat::kFrontBackHalf ? "ulp" : "1/65534";
}

ColliderDifference compareColliders(const Collider& a, const Collider& b, const CompareOptions& options) {
    ColliderDifference result;
    result.structure = colliderStructure(a, b);
    result.provenance = provenanceDifferences(a.provenance, b.provenance);
    Amounts amounts;
    for (std::size_t i = 0; i < std::min(a.maps.size(), b.maps.size()); ++i) {
        const DepthMap& map_a = a.maps[i];
        const DepthMap& map_b = b.maps[i];
        MapDifference& map = result.maps.emplace_back();
        map.index = i;
        map.structure = mapStructure(map_a, map_b);
        map.compared =
            map_a.format == map_b.format && map_a.width == map_b.width && map_a.height == map_b.height;
        if (!map.compared) {
            continue;
        }
        const MapComparison comparison(map_a, map_b, options);
        map.texels = map_a.texels.size() / texelSize(map_a.format);
        map.texels_differing = comparison.texelsDiffering();
        map.front = comparison.run(0, amounts);
        addCounts(result.total, map.front);
        if (isFrontBack(map_a.format)) {
            map.back = comparison.run(1, amounts);
            addCounts(result.total, map.back);
        }
    }
    result.total.depth = statisticsOf(amounts.depth, amounts.depth_sum, result.total.both);
    result.total.normal = statisticsOf(amounts.normal, amounts.normal_sum, result.total.both);
    return result;
}

}  // namespace relief
