// SPDX-License-Identifier: Apache-2.0
#include "bake/measure/patch_cells.h"

#include <bit>
#include <cmath>
#include <glm/common.hpp>

#include "formats/patch_tree.h"

namespace relief {

std::uint32_t patchCount(const DepthMap& map) {
    using Kind = PatchRecord::Kind;
    const auto [roots, levels] = patchTreeSize(map.texels);
    std::uint32_t patches = 0;
    std::uint32_t end = 1 + roots.x * roots.y * roots.z;
    for (std::uint32_t i = 1; i < end; ++i) {
        const PatchRecord record = patchTexel(map.texels, i);
        patches += record.kind() == Kind::kPatch ? 1 : 0;
        // Records are ordered by level: the children of each split cell extend the next level.
        end +=
            record.kind() == Kind::kSplit ? static_cast<std::uint32_t>(std::popcount(record.children())) : 0;
    }
    return patches;
}

double patchSpacingAt(const DepthMap& map, const glm::vec3& p) {
    const glm::vec3 roots(patchTreeSize(map.texels).roots);
    const glm::vec3 last(std::nextafter(roots.x, 0.0F), std::nextafter(roots.y, 0.0F),
                         std::nextafter(roots.z, 0.0F));
    const PatchLeaf leaf =
        patchLeafAt(map.texels, glm::clamp(map.object_to_map.apply(p), glm::vec3(0.0F), last));
    const double cell = double{map.object_per_map.x} * double{leaf.cell};
    if (leaf.record.kind() != PatchRecord::Kind::kPatch) {
        return leaf.beside ? 0.5 * cell : cell;
    }
    const PatchRecord patch =
        leaf.record.isPair() ? patchTexel(map.texels, leaf.record.first()) : leaf.record;
    return cell / (patch.side() - 1);
}

}  // namespace relief
