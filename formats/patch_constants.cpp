// SPDX-License-Identifier: Apache-2.0
#include "formats/patch_constants.h"

#include <algorithm>

#include "formats/patch_tree.h"

namespace relief {

PatchConstants patchConstants(const DepthMap& map, std::size_t first) {
    const auto [roots, levels] = patchTreeSize(map.texels);
    PatchConstants constants;
    std::copy_n(map.object_to_map.row, 3, constants.row);
    constants.size = {map.object_per_map.x, glm::vec3(roots)};
    constants.place = glm::uvec4(first, roots.x, roots.x * roots.y, levels);
    return constants;
}

}  // namespace relief
