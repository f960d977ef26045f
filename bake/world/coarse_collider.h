// SPDX-License-Identifier: Apache-2.0
// Bakes coarse versions of a level's colliders, which a program uses while it loads the fine ones (runtime/stream).
#pragma once

#include <cstdint>
#include <functional>

#include "bake/pipeline/bake.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

/// Colliders up to this size in bytes on the GPU have no coarse version, because it would save little.
inline constexpr std::uint64_t kCoarseFrom = 65'536;

/// Returns whether a collider of a level gets a coarse version: `fine` is a single patch map larger than kCoarseFrom.
[[nodiscard]] bool hasCoarse(const Collider& fine);

/// The properties of a collider that determine its coarse version.
struct FineCollider {
    Bounds box;     ///< solidBox()
    Bounds bounds;  ///< of its mesh
    std::uint64_t gpu_bytes = 0;

    [[nodiscard]] static FineCollider of(const Collider& fine);
};

/// Bakes a coarse collider with a sixteenth of the bytes. Its box contains the box of the fine collider, so that a
/// program need not rebuild its grid of bodies when it replaces the coarse collider. Shells of open sheets are as thick
/// as the coarse texels require.
/// \param request  the request that baked the fine collider.
/// \param bake  bakes the same mesh with another request.
/// Errors: those of bake().
[[nodiscard]] Result<Collider> bakeCoarse(const BakeRequest& request, const FineCollider& fine,
                                          const std::function<Result<BakeResult>(const BakeRequest&)>& bake);

/// Returns the roots of a coarse collider that contain the box of a tile, as a separate collider.
/// \param coarse  bakeCoarse() of the collider that the tile was cut from.
[[nodiscard]] Collider coarseTile(const Collider& coarse, const FineCollider& tile);

}  // namespace relief
