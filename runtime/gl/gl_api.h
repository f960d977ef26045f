// SPDX-License-Identifier: Apache-2.0
// The two APIs that all shaders and classes of runtime/ support.
#pragma once

namespace relief {

enum class GlApi { kGl33Core, kGles30 };

}  // namespace relief
