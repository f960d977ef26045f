// SPDX-License-Identifier: Apache-2.0
// The two APIs that every shader and every class of runtime/ works with.
#pragma once

namespace relief {

enum class GlApi { kGl33Core, kGles30 };

}  // namespace relief
