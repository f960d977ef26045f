// SPDX-License-Identifier: Apache-2.0
// Coarse likenesses of a level's colliders, which stand in for them while a program loads these (runtime/stream).
#pragma once

#include <cstdint>
#include <functional>

#include "bake/pipeline/bake.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

/// Bytes on the GPU: a collider that takes no more has none, as that would save little.
inline constexpr std::uint64_t kCoarseFrom = 65'536;

/// Whether a collider of a level has one: of a single map of patches, and not a small one.
[[nodiscard]] bool hasCoarse(const Collider& fine);

/// The collider that a coarse one stands for.
struct FineCollider {
    Bounds box;     ///< solidBox()
    Bounds bounds;  ///< of its mesh
    std::uint64_t gpu_bytes = 0;

    [[nodiscard]] static FineCollider of(const Collider& fine);
};

/// One of a sixteenth of the bytes, whose box holds that of the fine one, so that a program need not sort its bodies anew when
/// it takes one for the other. Shells of open sheets are as thick as its texels ask for.
/// \param request  that the fine one was baked by.
/// \param bake  bakes the same mesh by another request.
/// Errors: those of bake().
[[nodiscard]] Result<Collider> bakeCoarse(const BakeRequest& request, const FineCollider& fine,
                                          const std::function<Result<BakeResult>(const BakeRequest&)>& bake);

/// The roots of a coarse one that hold the box of a tile, as a collider of their own.
/// \param coarse  bakeCoarse() of the whole that the tile was cut from.
[[nodiscard]] Collider coarseTile(const Collider& coarse, const FineCollider& tile);

}  // namespace relief
