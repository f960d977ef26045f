// SPDX-License-Identifier: Apache-2.0
// What a page needs to know of a collider besides its texels: ColliderInfo of runtime/web/relief.d.ts.
#pragma once

#include "formats/collider.h"
#include "formats/fields/json_value.h"

namespace relief {

[[nodiscard]] Json colliderInfo(const Collider& collider);

}  // namespace relief
