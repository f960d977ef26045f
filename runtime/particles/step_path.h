// SPDX-License-Identifier: Apache-2.0
// Selects fragment or compute shaders for the GPU work on particles: steps, births, depth sort and rendering.
#pragma once

#include <cstdint>

#include "formats/base/result.h"

namespace relief {

/// All paths run the same GLSL; results differ only by rounding.
enum class StepPath : std::uint8_t {
    kAuto,      ///< kCompute if the context has compute shaders and renders on a GPU, else kFragment
    kFragment,  ///< one fragment per particle, as in the paper: OpenGL 3.3, OpenGL ES 3.0, WebGL2
    kCompute,   ///< one invocation per particle: OpenGL 4.3, OpenGL ES 3.1
};

/// Returns kFragment or kCompute for the current context.
/// Errors: kUnsupported (kCompute requested without compute shaders).
[[nodiscard]] Result<StepPath> resolvePath(StepPath wanted);

}  // namespace relief
