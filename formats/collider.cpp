// SPDX-License-Identifier: Apache-2.0
#include "formats/collider.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include "formats/base/text.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

/// Returns the bounding box of a map's volume in object space.
Bounds volumeBox(const DepthMap& map) {
    const float low = map.projection() == Projection::kCube ? -1.0F : 0.0F;
    const glm::vec3 high =
        map.projection() == Projection::kLocal ? glm::vec3(patchTreeSize(map.texels).roots) : glm::vec3(1.0F);
    Bounds box;
    for (int corner = 0; corner < 8; ++corner) {
        glm::dvec3 p(0.0);
        for (int i = 0; i < 3; ++i) {
            const glm::dvec4 row = map.object_to_map.row[i];
            const glm::dvec3 axis(row);
            p += axis * (((corner >> i & 1) != 0 ? high[i] : low) - row.w) / glm::dot(axis, axis);
        }
        box.add(glm::vec3(p));
    }
    return box;
}

}  // namespace

void Bounds::add(const glm::vec3& p) {
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
}

float Bounds::longestSide() const {
    const glm::vec3 s = size();
    return std::max({s.x, s.y, s.z});
}

float Bounds::farthest() const {
    const glm::vec3 far = glm::max(glm::abs(min), glm::abs(max));
    return std::max({far.x, far.y, far.z});
}

bool Bounds::meets(const Bounds& other) const {
    return glm::all(glm::lessThanEqual(min, other.max)) && glm::all(glm::lessThanEqual(other.min, max));
}

std::string RecordedOption::text() const {
    return optionName(name) + (value == "true" ? "" : " " + shellQuoted(value));
}

std::string Provenance::optionsText() const {
    std::string text;
    for (const RecordedOption& option : options) {
        text.append(text.empty() ? "" : " ").append(option.text());
    }
    return text;
}

bool Collider::hasPatches() const {
    return std::any_of(maps.begin(), maps.end(),
                       [](const DepthMap& map) { return map.format == MapFormat::kPatches; });
}

std::uint64_t Collider::texelBytes() const {
    std::uint64_t bytes = 0;
    for (const DepthMap& map : maps) {
        bytes += map.texelBytes();
    }
    return bytes;
}

FieldSample evaluate(const Collider& collider, const glm::vec3& p) {
    FieldSample best;
    best.distance = Vote{}.distance;
    for (std::size_t i = 0; i < collider.maps.size(); ++i) {
        if (const std::optional<Vote> v = vote(collider.maps[i], p);
            v && replaces(v->distance, best.distance)) {
            best = {v->distance, v->normal, static_cast<int>(i)};
        }
    }
    if (best.map < 0) {
        best.distance = kFarOutside;
    }
    return best;
}

InsideSample evaluateInside(const Collider& collider, const glm::vec3& p) {
    Vote best;
    InsideSample sample;
    for (std::size_t i = 0; i < collider.maps.size() && best.distance < 0.0F; ++i) {
        const DepthMap& map = collider.maps[i];
        if (map.projection() == Projection::kLocal &&
            isOutsidePatches(map.texels, map.object_to_map.apply(p))) {
            return {.map = static_cast<int>(i)};
        }
        if (const std::optional<Vote> v = vote(map, p); v && replaces(v->distance, best.distance)) {
            best = *v;
            sample.map = static_cast<int>(i);
        }
    }
    sample.inside = sample.map >= 0 && best.distance < 0.0F;
    if (sample.inside) {
        sample.normal = best.normal;
    }
    return sample;
}

bool mayBeInside(const Collider& collider, const Bounds& box) {
    const auto isOutside = [&](const DepthMap& map) {
        if (map.format != MapFormat::kPatches || !map.encloses) {
            return false;
        }
        // apply() is monotone in each coordinate, also after rounding, so the corners bound all points.
        Bounds in_map;
        for (unsigned i = 0; i < 8; ++i) {
            in_map.add(map.object_to_map.apply(box.corner(i)));
        }
        return !mayBeInsidePatches(map.texels, in_map.min, in_map.max);
    };
    return std::none_of(collider.maps.begin(), collider.maps.end(), isOutside);
}

std::optional<Bounds> insideBox(const Collider& collider) {
    std::optional<Bounds> box;
    for (const DepthMap& map : collider.maps) {
        if (map.encloses && map.empty_is_outside) {
            const Bounds volume = volumeBox(map);
            box = box ? Bounds{glm::max(box->min, volume.min), glm::min(box->max, volume.max)} : volume;
        }
    }
    return box;
}

Bounds solidBox(const Collider& collider) {
    Bounds box = insideBox(collider).value_or(collider.bounds);
    box.add(collider.bounds.min);
    box.add(collider.bounds.max);
    return box;
}

float finestTexel(const Collider& collider) {
    const float longest = collider.bounds.longestSide();
    float finest = longest;
    for (const DepthMap& map : collider.maps) {
        const glm::vec3& unit = map.object_per_map;
        if (map.projection() == Projection::kLocal) {
            finest = std::min(finest, static_cast<float>(patchSpacing(map.texels)) * unit.x);
        } else if (map.projection() == Projection::kCube) {
            // A cube face covers one side of the volume, whose half sides are `unit`.
            finest =
                std::min(finest, 2.0F * std::min({unit.x, unit.y, unit.z}) / static_cast<float>(map.width));
        } else {
            finest = std::min(
                {finest, unit.x / static_cast<float>(map.width), unit.y / static_cast<float>(map.height)});
        }
    }
    return std::max({finest, longest / 2048.0F, 1e-9F});
}

}  // namespace relief
