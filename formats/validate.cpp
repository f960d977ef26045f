// SPDX-License-Identifier: Apache-2.0
#include "formats/validate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "formats/base/finite.h"
#include "formats/base/hash.h"
#include "formats/base/text.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

constexpr std::uint16_t kHalfSmallest = 0x0400;  // 2^-14
constexpr std::uint16_t kHalfOne = 0x3c00;

/// Nine significant digits distinguish any two floats.
std::string number(double value) {
    return formatted("%.9g", value);
}

std::string words(const glm::vec3& v) {
    return "(" + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + ")";
}

/// Returns the problem of a metadata text, or "".
std::string faultOfText(const char* field, std::string_view text, std::size_t size_max) {
    if (text.size() > size_max) {
        return std::string(field) + " has " + std::to_string(text.size()) + " bytes; at most " +
               std::to_string(size_max) + " are allowed";
    }
    return isPlainText(text) ? "" : std::string(field) + " is not UTF-8 without control characters";
}

std::string faultOfBounds(const Bounds& bounds) {
    if (!isFinite(bounds.min) || !isFinite(bounds.max)) {
        return "bounds are not finite";
    }
    if (bounds.min.x > bounds.max.x || bounds.min.y > bounds.max.y || bounds.min.z > bounds.max.z) {
        return "bounds.min " + words(bounds.min) + " exceeds bounds.max " + words(bounds.max);
    }
    return {};
}

std::string faultOfName(const std::string& name) {
    return name.find('/') != std::string::npos
               ? "provenance.mesh_name contains '/': it must be a name without a folder"
               : faultOfText("provenance.mesh_name", name, kMeshNameMax);
}

std::string faultOfHash(std::string_view hash) {
    return hash.empty() || isHash(hash)
               ? ""
               : "provenance.mesh_hash is neither empty nor 32 lower-case hexadecimal digits";
}

std::string faultOfOptions(const std::vector<RecordedOption>& options) {
    std::string all;
    for (const RecordedOption& option : options) {
        all.append(option.name).append(option.value);
    }
    return faultOfText("provenance.options", all, kOptionsMax);
}

Result<void> validateSize(const DepthMap& map) {
    const std::string size = std::to_string(map.width) + "x" + std::to_string(map.height);
    if (map.width > kMapSizeMax || map.height > kMapSizeMax) {
        return fail(ErrorCode::kLimit, "its size " + size + " exceeds " + std::to_string(kMapSizeMax) + "x" +
                                           std::to_string(kMapSizeMax));
    }
    const bool cube = map.projection() == Projection::kCube;
    const std::uint32_t smallest = map.projection() == Projection::kOrthographic ? kMapSizeMin : 1;
    if (map.width < smallest || map.height < smallest) {
        return invalidInput("its size " + size + " is below " + std::to_string(smallest) + "x" +
                            std::to_string(smallest));
    }
    if (cube && map.width != map.height) {
        return invalidInput("its size " + size + " is not square, but cube faces must be");
    }
    return {};
}

/// Checks that T's rows are orthogonal, because the vote of a plane inverts T under that assumption. Also checks
/// object_per_map against T: its entries are the lengths of the columns of T's inverse, here the reciprocals of the
/// lengths of T's rows.
Result<void> validateTransform(const DepthMap& map) {
    std::array<glm::dvec3, 3> row;  // unit length
    std::array<double, 3> length{};
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::vec4& r = map.object_to_map.row[i];
        if (!isFinite(glm::vec3(r)) || !std::isfinite(r.w)) {
            return invalidInput("object_to_map row " + std::to_string(i) + " is not finite");
        }
        const glm::dvec3 wide(r.x, r.y, r.z);
        length[i] = glm::length(wide);  // floats in double: neither overflows nor underflows
        if (!(length[i] > 0.0)) {
            return invalidInput("object_to_map row " + std::to_string(i) + " is zero");
        }
        row[i] = wide / length[i];
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t next = (i + 1) % 3;
        if (!(std::abs(glm::dot(row[i], row[next])) <= kFrameCosineMax)) {
            return invalidInput("object_to_map is not a rotation with scale: rows " +
                                std::to_string(std::min(i, next)) + " and " +
                                std::to_string(std::max(i, next)) + " are not orthogonal");
        }
    }
    for (int i = 0; i < 3; ++i) {
        const double expected = 1.0 / length[static_cast<std::size_t>(i)];
        const double given = map.object_per_map[i];
        if (!(given > 0.0) || !std::isfinite(given)) {
            return invalidInput("object_per_map " + words(map.object_per_map) +
                                " is not positive and finite");
        }
        if (!(std::abs(given - expected) <= kObjectPerMapTolerance * expected)) {
            return invalidInput("object_per_map." + std::string(1, "xyz"[i]) + " is " + number(given) +
                                " but object_to_map gives " + number(expected));
        }
    }
    return {};
}

/// Returns the problem of a texel, or nullptr.
const char* faultOfFloat(std::span<const std::byte> texel) {
    float channels[4];
    std::memcpy(channels, texel.data(), sizeof(channels));
    const glm::vec3 normal(channels[0], channels[1], channels[2]);
    const float depth = channels[3];
    if (!isFinite(normal) || !std::isfinite(depth)) {
        return "contains a number that is not finite";
    }
    if (depth == -1.0F) {
        return normal == glm::vec3(0.0F) ? nullptr : "is empty (depth -1) but has a normal";
    }
    if (depth < 0.0F || depth > 1.0F) {
        return "has a depth that is neither -1 nor in 0...1";
    }
    const glm::dvec3 n(normal);
    if (std::abs(std::sqrt(glm::dot(n, n)) - 1.0) > static_cast<double>(kUnitLengthTolerance)) {
        return "has a normal that is not of unit length";
    }
    return nullptr;
}

const char* faultOfHalves(std::span<const std::byte> texel) {
    std::uint16_t channels[4];
    std::memcpy(channels, texel.data(), sizeof(channels));
    for (const std::uint16_t depth : {channels[2], channels[3]}) {
        if (depth != 0 && (depth < kHalfSmallest || depth > kHalfOne)) {
            return "has a half-float depth that is neither 0 nor in 2^-14...1";
        }
    }
    return nullptr;
}

}  // namespace

std::string storedMeshName(std::string name) {
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == '/' || c == '\\'; }, '_');
    return cleanUtf8(name, kMeshNameMax);
}

bool isPlainText(std::string_view text) {
    return cleanUtf8(text, std::string::npos, Bidi::kKeep) == text;
}

std::vector<Issue> descriptionIssues(const Collider& collider) {
    const Provenance& from = collider.provenance;
    using enum IssueCode;
    std::vector<Issue> issues = {
        {kBounds, -1, {}, faultOfBounds(collider.bounds)},
        {kUnit, -1, {}, faultOfText("unit", collider.unit, kUnitMax)},
        {kProvenance, -1, {}, faultOfName(from.mesh_name)},
        {kProvenance, -1, {}, faultOfHash(from.mesh_hash)},
        {kProvenance, -1, {}, faultOfText("provenance.tool_version", from.tool_version, kToolVersionMax)},
        {kProvenance, -1, {}, faultOfOptions(from.options)},
        {kMaterials, -1, {}, faultOfMaterials(collider.materials)},
    };
    std::erase_if(issues, [](const Issue& issue) { return issue.message.empty(); });
    return issues;
}

Result<void> validateFrame(const DepthMap& map) {
    if (static_cast<int>(map.format) >= kMapFormatCount) {
        return invalidInput("its format " + std::to_string(static_cast<int>(map.format)) + " is unknown");
    }
    if (static_cast<int>(map.compare) > static_cast<int>(Compare::kBoth)) {
        return invalidInput("its compare " + std::to_string(static_cast<int>(map.compare)) + " is unknown");
    }
    if ((map.compare == Compare::kBoth) != isFrontBack(map.format)) {
        return invalidInput(std::string("its compare \"") + compareName(map.compare) +
                            "\" does not match its format \"" + mapFormatName(map.format) + "\"");
    }
    if (static_cast<int>(map.decode) > static_cast<int>(Decode::kPlane)) {
        return invalidInput("its decode " + std::to_string(static_cast<int>(map.decode)) + " is unknown");
    }
    if (map.format == MapFormat::kPatches && map.decode != Decode::kPlane) {
        return invalidInput("a map of patches must decode planes");
    }
    if (const glm::vec3& s = map.object_per_map;
        map.format == MapFormat::kPatches && (s.x != s.y || s.x != s.z)) {
        return invalidInput("object_per_map " + words(s) + " is not uniform; the cells of patches are cubes");
    }
    return validateSize(map).and_then([&] { return validateTransform(map); });
}

Result<void> validateTexels(const DepthMap& map) {
    if (map.texels.size() != map.texelBytes()) {
        return invalidInput("it has " + std::to_string(map.texels.size()) +
                            " bytes of texels but its size requires " + std::to_string(map.texelBytes()));
    }
    if (map.format == MapFormat::kPatches) {
        return validatePatches(map.texels);
    }
    if (map.format != MapFormat::kFloat32 && map.format != MapFormat::kFrontBackHalf) {
        return {};  // every code is valid
    }
    for (std::uint32_t y = 0; y < map.height; ++y) {
        for (std::uint32_t x = 0; x < map.width; ++x) {
            const std::span<const std::byte> texel = map.texelAt(0, x, y);
            const char* fault =
                map.format == MapFormat::kFloat32 ? faultOfFloat(texel) : faultOfHalves(texel);
            if (fault != nullptr) {
                return invalidInput("texel (" + std::to_string(x) + ", " + std::to_string(y) + ") " + fault);
            }
        }
    }
    return {};
}

Result<void> validate(const Collider& collider) {
    if (const std::vector<Issue> issues = descriptionIssues(collider); !issues.empty()) {
        return invalidInput(issues.front().message);
    }
    if (collider.maps.empty()) {
        return invalidInput("there are no maps");
    }
    for (std::size_t i = 0; i < collider.maps.size(); ++i) {
        const DepthMap& map = collider.maps[i];
        if (const Result<void> ok = validateFrame(map).and_then([&] { return validateTexels(map); }); !ok) {
            return tl::unexpected<Error>(inMap(i, ok.error()));
        }
    }
    return {};
}

Error inMap(std::size_t index, const Error& error) {
    return {error.code, "map " + std::to_string(index) + ": " + error.message};
}

}  // namespace relief
