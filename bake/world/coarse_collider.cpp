// SPDX-License-Identifier: Apache-2.0
#include "bake/world/coarse_collider.h"

#include <algorithm>
#include <cmath>

#include "bake/patches/patch_tiles.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

constexpr std::uint64_t kCoarser = 16;
/// Margin around a box, as a fraction of its longest side; exceeds the rounding of its corners.
constexpr float kMargin = 1e-5F;

}  // namespace

bool hasCoarse(const Collider& fine) {
    return fine.maps.size() == 1 && fine.maps[0].format == MapFormat::kPatches &&
           fine.texelBytes() > kCoarseFrom;
}

FineCollider FineCollider::of(const Collider& fine) {
    return {solidBox(fine), fine.bounds, fine.texelBytes()};
}

Result<Collider> bakeCoarse(const BakeRequest& request, const FineCollider& fine,
                            const std::function<Result<BakeResult>(const BakeRequest&)>& bake) {
    BakeRequest coarse = request;
    coarse.budget = fine.gpu_bytes / kCoarser;
    coarse.texel.reset();
    coarse.no_check = true;
    const glm::vec3 margin(kMargin * fine.box.longestSide());
    coarse.roots_contain = Bounds{fine.box.min - margin, fine.box.max + margin};
    Collider collider = RELIEF_TRY(bake(coarse)).baked.collider;
    collider.bounds = fine.bounds;  // its own bounds include thicker shells
    return collider;
}

Collider coarseTile(const Collider& coarse, const FineCollider& tile) {
    const DepthMap& map = coarse.maps[0];
    const glm::uvec3 roots = patchTreeSize(map.texels).roots;
    const float margin = kMargin * coarse.bounds.longestSide();
    glm::uvec3 first;
    glm::uvec3 count;
    for (int i = 0; i < 3; ++i) {
        // The map transform of patches only scales and translates.
        const double per_unit = 1.0 / double{map.object_per_map.x};
        const auto rootAt = [&](float place) {
            return std::floor(double{place} * per_unit + double{map.object_to_map.row[i].w});
        };
        const double last = roots[i] - 1.0;
        const double low = std::clamp(rootAt(tile.box.min[i] - margin), 0.0, last);
        const double high = std::clamp(rootAt(tile.box.max[i] + margin), low, last);
        first[i] = static_cast<std::uint32_t>(low);
        count[i] = static_cast<std::uint32_t>(high - low) + 1;
    }
    Collider collider;
    collider.bounds = tile.bounds;
    collider.unit = coarse.unit;
    collider.provenance = coarse.provenance;
    collider.maps.push_back(cutPatches(map, first, count));
    return collider;
}

}  // namespace relief
