#include "bake/world/coarse_collider.h"

#include <utility>

#include "bake/director/director.h"

namespace relief {
namespace {

constexpr std::uint64_t kCoarser = 16;
/// Of the longest side: more than floats make of the corners of a box.
constexpr float kMargin = 1e-5F;

}  // namespace

bool hasCoarse(const Collider& fine) {
    return fine.maps.size() == 1 && fine.maps[0].format == MapFormat::kPatches &&
           fine.gpuBytes() > kCoarseFrom;
}

Result<Collider> bakeCoarse(const BakeRequest& request, const Collider& fine, TriangleMesh mesh) {
    BakeRequest coarse = request;
    coarse.budget = fine.gpuBytes() / kCoarser;
    coarse.texel.reset();
    coarse.no_check = true;
    Bounds box = solidBox(fine);
    const glm::vec3 margin(kMargin * box.longestSide());
    coarse.roots_hold = Bounds{box.min - margin, box.max + margin};
    Collider collider = RELIEF_TRY(bake(coarse, {}, std::move(mesh))).baked.collider;
    collider.bounds = fine.bounds;  // its own have thicker shells
    return collider;
}

}  // namespace relief
