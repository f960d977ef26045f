// SPDX-License-Identifier: Apache-2.0
#include "formats/depth_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/matrix.hpp>

#include "formats/base/finite.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

float length(const glm::vec3& v) {
    return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

float dot(const glm::vec3& a, const glm::vec3& b) {
    return a.x * b.x + (a.y * b.y + a.z * b.z);
}

/// Transforms directions from map space to object space. T's rows are orthogonal, so the columns of its inverse are its
/// rows times object_per_map squared; the two factors are applied separately to avoid overflow.
glm::vec3 fromMap(const DepthMap& map, const glm::vec3& q) {
    const auto column = [&](int k) {
        return glm::vec3(map.object_to_map.row[k]) * map.object_per_map[k] * map.object_per_map[k];
    };
    return column(0) * q.x + (column(1) * q.y + column(2) * q.z);
}

/// Returns the vote of a plane, in object space.
/// \param from  P − O, where O is the point at depth 0 on the ray of the texel's centre
/// \param ray   direction of that ray, per unit of depth
float planeVote(const Surface& surface, const glm::vec3& from, const glm::vec3& ray) {
    return dot(surface.normal, from) - surface.depth * dot(surface.normal, ray);
}

const Vote kFarOutsideVote{kFarOutside, glm::vec3(0.0F)};

std::optional<Vote> voteOrthographic(const DepthMap& map, const glm::vec3& p) {
    // Compare as floats first: casting a coordinate outside the range of int is undefined.
    const float x = p.x * static_cast<float>(map.width);
    const float y = p.y * static_cast<float>(map.height);
    const bool in_window = x >= 1.0F && y >= 1.0F && x < static_cast<float>(map.width - 1) &&
                           y < static_cast<float>(map.height - 1);
    const bool in_depth = p.z >= 0.0F && p.z <= 1.0F;
    if (!map.encloses && !(in_window && in_depth)) {
        return std::nullopt;
    }
    if (!in_window) {
        return kFarOutsideVote;
    }
    const auto column = static_cast<std::uint32_t>(x);
    const auto row = static_cast<std::uint32_t>(y);
    const Texel texel = decodeTexel(map.format, map.texelAt(0, column, row));
    if (!texel.front && !texel.back) {
        return map.empty_is_outside ? std::optional(kFarOutsideVote) : std::nullopt;
    }

    // Offset from the texel's centre.
    const float across_x = (x - (static_cast<float>(column) + 0.5F)) * (1.0F / static_cast<float>(map.width));
    const float across_y = (y - (static_cast<float>(row) + 0.5F)) * (1.0F / static_cast<float>(map.height));
    const bool planes = map.decode == Decode::kPlane;
    const glm::vec3 from = planes ? fromMap(map, {across_x, across_y, p.z}) : glm::vec3(0.0F);
    const glm::vec3 ray = planes ? fromMap(map, {0.0F, 0.0F, 1.0F}) : glm::vec3(0.0F);
    const auto voteOf = [&](const Surface& surface, bool keeps_nearest) {
        const float ahead = keeps_nearest ? surface.depth - p.z : p.z - surface.depth;
        const float distance = planes ? planeVote(surface, from, ray) : map.object_per_map.z * ahead;
        return Vote{distance, surface.normal};
    };
    Vote best;
    const auto add = [&](const Vote& one) { best = replaces(one.distance, best.distance) ? one : best; };
    if (texel.front) {
        add(voteOf(*texel.front, map.compare != Compare::kGreater));
    }
    if (texel.back) {
        add(voteOf(*texel.back, false));
    }
    // The collider does not extend past the far end of the volume.
    if (!in_depth && best.distance < 0.0F) {
        return kFarOutsideVote;
    }
    return best;
}

std::optional<Vote> voteCube(const DepthMap& map, const glm::vec3& p) {
    // Compare each component because std::max may drop a NaN from an overflow in the transform.
    const auto withinCube = [&](float half) {
        return std::abs(p.x) <= half && std::abs(p.y) <= half && std::abs(p.z) <= half;
    };
    const bool in_volume = withinCube(1.0F);
    if (!map.encloses && !in_volume) {
        return std::nullopt;
    }
    if (!withinCube(1e15F)) {  // the squares below must not overflow
        return kFarOutsideVote;
    }
    const float radius = length(p);
    // At the exact centre, any direction is valid.
    const glm::vec3 direction = radius > 0.0F ? p / radius : glm::vec3(1.0F, 0.0F, 0.0F);
    const CubeCoordinates at = cubeCoordinates(direction);
    const auto size = static_cast<float>(map.width);
    const auto x = std::min(static_cast<std::uint32_t>(at.s * size), map.width - 1);
    const auto y = std::min(static_cast<std::uint32_t>(at.t * size), map.width - 1);
    const Texel texel = decodeTexel(map.format, map.texelAt(at.face, x, y));
    if (!texel.front) {
        return map.empty_is_outside ? std::optional(kFarOutsideVote) : std::nullopt;
    }
    const Surface& surface = *texel.front;
    float distance = 0.0F;
    if (map.decode == Decode::kPlane) {
        const glm::vec3 center = cubeDirection(
            {at.face, (static_cast<float>(x) + 0.5F) / size, (static_cast<float>(y) + 0.5F) / size});
        const glm::vec3 ray = center / length(center);
        distance = planeVote(surface, fromMap(map, p), fromMap(map, ray));
    } else {
        const float ahead =
            map.compare == Compare::kGreater ? radius - surface.depth : surface.depth - radius;
        distance = ahead * length(map.object_per_map * direction);
    }
    if (!in_volume && !(distance >= 0.0F)) {
        return kFarOutsideVote;
    }
    return Vote{distance, surface.normal};
}

std::optional<Vote> voteLocal(const DepthMap& map, const glm::vec3& p) {
    const std::optional<PatchVote> local = votePatches(map.texels, p);
    if (!local) {
        return map.encloses ? std::optional(kFarOutsideVote) : std::nullopt;
    }
    const float root = map.object_per_map.x;  // T has a rotation and a uniform scale
    const auto row = [&](int i) { return glm::vec3(map.object_to_map.row[i]) * root; };
    return Vote{local->distance * root,
                row(0) * local->normal.x + (row(1) * local->normal.y + row(2) * local->normal.z)};
}

}  // namespace

const char* projectionName(Projection projection) {
    constexpr std::array kNames = {"orthographic", "cube", "local"};
    return kNames.at(static_cast<std::size_t>(projection));
}

const char* compareName(Compare compare) {
    constexpr std::array kNames = {"less", "greater", "both"};
    return kNames.at(static_cast<std::size_t>(compare));
}

const char* decodeName(Decode decode) {
    return decode == Decode::kProjected ? "projected" : "plane";
}

glm::vec3 Affine::apply(const glm::vec3& p) const {
    const auto one = [&](const glm::vec4& r) { return r.x * p.x + (r.y * p.y + (r.z * p.z + r.w)); };
    return {one(row[0]), one(row[1]), one(row[2])};
}

glm::dmat3 Affine::linear() const {
    // glm expects columns.
    return glm::transpose(glm::dmat3(glm::vec3(row[0]), glm::vec3(row[1]), glm::vec3(row[2])));
}

glm::dmat3 Affine::inverse() const {
    return glm::inverse(linear());
}

bool Affine::isFinite() const {
    return std::all_of(std::begin(row), std::end(row), [](const glm::vec4& r) {
        return relief::isFinite(glm::vec3(r)) && std::isfinite(r.w);
    });
}

std::span<const std::byte> DepthMap::texelAt(std::uint32_t face, std::uint32_t x, std::uint32_t y) const {
    const std::size_t size = texelSize(format);
    return std::span(texels).subspan(((std::size_t{face} * height + y) * width + x) * size, size);
}

std::span<std::byte> DepthMap::texelAt(std::uint32_t face, std::uint32_t x, std::uint32_t y) {
    const std::size_t size = texelSize(format);
    return std::span(texels).subspan(((std::size_t{face} * height + y) * width + x) * size, size);
}

void DepthMap::setPatches(std::span<const PatchRecord> records) {
    const PatchMapSize size = patchMapSize(records.size());
    width = size.width;
    height = size.height;
    const auto bytes = static_cast<std::size_t>(texelBytes());
    texels.clear();
    texels.reserve(bytes);
    for (const PatchRecord& record : records) {
        appendPatchTexel(texels, record);
    }
    texels.resize(bytes);
}

std::optional<Vote> vote(const DepthMap& map, const glm::vec3& p) {
    const glm::vec3 in_map = map.object_to_map.apply(p);
    switch (map.projection()) {
        case Projection::kCube:
            return voteCube(map, in_map);
        case Projection::kLocal:
            return voteLocal(map, in_map);
        case Projection::kOrthographic:
            break;
    }
    return voteOrthographic(map, in_map);
}

CubeCoordinates cubeCoordinates(const glm::vec3& d) {
    const float ax = std::abs(d.x);
    const float ay = std::abs(d.y);
    const float az = std::abs(d.z);
    std::uint32_t face = 0;
    float sc = 0.0F;
    float tc = 0.0F;
    float major = 1.0F;
    if (ax >= ay && ax >= az) {
        face = d.x < 0.0F ? 1 : 0;
        sc = d.x < 0.0F ? d.z : -d.z;
        tc = -d.y;
        major = ax;
    } else if (ay >= az) {
        face = d.y < 0.0F ? 3 : 2;
        sc = d.x;
        tc = d.y < 0.0F ? -d.z : d.z;
        major = ay;
    } else {
        face = d.z < 0.0F ? 5 : 4;
        sc = d.z < 0.0F ? -d.x : d.x;
        tc = -d.y;
        major = az;
    }
    return {face, 0.5F * (sc / major + 1.0F), 0.5F * (tc / major + 1.0F)};
}

glm::vec3 cubeDirection(const CubeCoordinates& at) {
    const float sc = 2.0F * at.s - 1.0F;
    const float tc = 2.0F * at.t - 1.0F;
    switch (at.face) {
        case 0:
            return {1.0F, -tc, -sc};
        case 1:
            return {-1.0F, -tc, sc};
        case 2:
            return {sc, 1.0F, tc};
        case 3:
            return {sc, -1.0F, -tc};
        case 4:
            return {sc, -tc, 1.0F};
        default:
            return {-sc, -tc, -1.0F};
    }
}

}  // namespace relief
