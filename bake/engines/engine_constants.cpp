// SPDX-License-Identifier: Apache-2.0
#include "bake/engines/engine_constants.h"

#include <glm/gtc/quaternion.hpp>
#include <string>

#include "formats/patch_tree.h"

namespace relief {

Result<const DepthMap*> engineMap(const Collider& collider) {
    if (collider.maps.size() != 1 || collider.maps.front().format != MapFormat::kPatches) {
        return fail(ErrorCode::kUsage,
                    "engines read one map of patches, and this collider has " +
                        (collider.maps.size() == 1
                             ? std::string("a map of format ") + mapFormatName(collider.maps.front().format)
                             : std::to_string(collider.maps.size()) + " maps") +
                        "; bake it again without --map and --paper");
    }
    return &collider.maps.front();
}

EngineConstants engineConstants(const DepthMap& map, std::uint32_t first) {
    const auto [roots, levels] = patchTreeSize(map.texels);
    EngineConstants constants;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::vec4& row = map.object_to_map.row[i];
        constants.rows[i] = {row.x, row.y, row.z, row.w};
    }
    constants.size = {map.object_per_map.x, static_cast<float>(roots.x), static_cast<float>(roots.y),
                      static_cast<float>(roots.z)};
    constants.place = {static_cast<std::int32_t>(first), static_cast<std::int32_t>(roots.x),
                       static_cast<std::int32_t>(roots.x * roots.y), static_cast<std::int32_t>(levels)};
    return constants;
}

EngineConstants placedConstants(const EngineConstants& constants, const Pose& pose) {
    EngineConstants placed = constants;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& row = constants.rows[i];
        // row · conj(q) (p − position) / scale + w, in doubles: a level may be large.
        const glm::dquat rotation(pose.rotation);
        const glm::dvec3 turned = rotation * glm::dvec3(row[0], row[1], row[2]) / double{pose.scale};
        const double offset = double{row[3]} - glm::dot(turned, glm::dvec3(pose.position));
        placed.rows[i] = {static_cast<float>(turned.x), static_cast<float>(turned.y),
                          static_cast<float>(turned.z), static_cast<float>(offset)};
    }
    placed.size[0] *= pose.scale;
    return placed;
}

void fillRow(std::vector<std::byte>& texels, std::size_t row) {
    texels.resize((texels.size() + row - 1) / row * row);
}

}  // namespace relief
