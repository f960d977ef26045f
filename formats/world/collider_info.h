// SPDX-License-Identifier: Apache-2.0
// Collider properties that a web page needs in addition to the texels: ColliderInfo in runtime/web/relief.d.ts.
#pragma once

#include "formats/collider.h"
#include "formats/fields/json_value.h"

namespace relief {

[[nodiscard]] Json colliderInfo(const Collider& collider);

}  // namespace relief
