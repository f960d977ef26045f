// SPDX-License-Identifier: Apache-2.0
#include "formats/world/world_field.h"

namespace relief {
namespace {

/// Margin around the box of a body, relative to its longest side, because maps extend slightly beyond the box of their
/// mesh. Also covers rounding of its largest coordinate.
constexpr float kMargin = 0.01F;
constexpr float kRounding = 1e-5F;

bool isLocal(const Collider& collider) {
    return collider.maps.size() == 1 && collider.maps[0].format == MapFormat::kPatches &&
           collider.maps[0].encloses && collider.maps[0].empty_is_outside;
}

}  // namespace

WorldField::WorldField(LoadedWorld loaded) : loaded_(std::move(loaded)) {
    for (std::size_t i = 0; i < world().bodies.size(); ++i) {
        Bounds placed = toWorld(poseOf(world().bodies[i]), solidBox(colliderOf(i)));
        const glm::vec3 margin(kMargin * placed.longestSide() + kRounding * placed.farthest());
        placed.min -= margin;
        placed.max += margin;
        boxes_.push_back(placed);
        local_.push_back(isLocal(colliderOf(i)) ? 1 : 0);
    }
}

void WorldField::addSample(std::size_t body, const glm::vec3& p, WorldSample& best) const {
    const FieldSample sample = relief::evaluate(colliderOf(body), toObject(body, p));
    const Pose placed = poseOf(world().bodies[body]);
    const float distance = sample.distance >= kFarOutside ? kFarOutside : placed.scale * sample.distance;
    if (sample.map >= 0 && (best.body < 0 || distance < best.distance)) {
        best = {distance, placed.rotation * sample.normal, static_cast<int>(body)};
    }
}

WorldSample WorldField::evaluate(const glm::vec3& p) const {
    WorldSample best;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
        if (local_[i] == 0 || boxes_[i].contains(p)) {
            addSample(i, p, best);
        } else if (best.body < 0) {
            best = {kFarOutside, glm::vec3(0.0F), static_cast<int>(i)};
        }
    }
    return best;
}

WorldSample WorldField::evaluate(const glm::vec3& p, std::span<const std::uint32_t> bodies) const {
    WorldSample best;
    for (const std::uint32_t i : bodies) {
        addSample(i, p, best);
    }
    return best;
}

std::vector<std::uint32_t> WorldField::bodiesIn(const Bounds& box) const {
    std::vector<std::uint32_t> bodies;
    for (std::uint32_t i = 0; i < boxes_.size(); ++i) {
        if (boxes_[i].meets(box)) {
            bodies.push_back(i);
        }
    }
    return bodies;
}

glm::vec3 WorldField::toObject(std::size_t body, const glm::vec3& p) const {
    return relief::toObject(poseOf(world().bodies[body]), p);
}

glm::vec3 WorldField::turn(std::size_t body, const glm::vec3& v) const {
    const Pose placed = poseOf(world().bodies[body]);
    return placed.scale * (placed.rotation * v);
}

}  // namespace relief
