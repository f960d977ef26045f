// SPDX-License-Identifier: Apache-2.0
#include "bake/engines/engine_constants.h"

#include <string>

namespace relief {

Result<const DepthMap*> engineMap(const Collider& collider) {
    if (collider.maps.size() != 1 || collider.maps.front().format != MapFormat::kPatches) {
        return fail(ErrorCode::kUsage,
                    "engines read one map of patches, but this collider has " +
                        (collider.maps.size() == 1
                             ? std::string("a map of format ") + mapFormatName(collider.maps.front().format)
                             : std::to_string(collider.maps.size()) + " maps") +
                        "; bake it again without --map and --paper");
    }
    return &collider.maps.front();
}

PatchConstants placedConstants(PatchConstants constants, const Pose& pose) {
    for (glm::vec4& row : constants.row) {
        row = fromWorld(pose, row);
    }
    constants.size.x *= pose.scale;
    return constants;
}

void fillRow(std::vector<std::byte>& texels, std::size_t row) {
    texels.resize((texels.size() + row - 1) / row * row);
}

}  // namespace relief
