// SPDX-License-Identifier: Apache-2.0
// The GPU path of the work on particles: steps, births, the depth sort, their pictures.
#pragma once

#include <cstdint>

#include "formats/base/result.h"

namespace relief {

/// Every path runs the same GLSL, and gives the same particles but for rounding.
enum class StepPath : std::uint8_t {
    kAuto,      ///< kCompute where the context has compute shaders and a GPU draws, else kFragment
    kFragment,  ///< a fragment a particle, as in the paper: OpenGL 3.3, OpenGL ES 3.0, WebGL2
    kCompute,   ///< an invocation a particle: OpenGL 4.3, OpenGL ES 3.1
};

/// kFragment or kCompute, in the current context.
/// Errors: kUnsupported (kCompute is wanted and the context has no compute shaders).
[[nodiscard]] Result<StepPath> chosenPath(StepPath wanted);

}  // namespace relief
