// SPDX-License-Identifier: Apache-2.0
// A distance volume of bricks, used as a collider.
#pragma once

#include "formats/bricks/brick_atlas.h"
#include "runtime/bench/rival_step.h"

namespace relief {

/// Uploads a volume. Errors: kLimit (GL limits for bricks or texels), kFailure.
[[nodiscard]] Result<Rival> makeBrickRival(const BrickAtlas& atlas);

}  // namespace relief
