// How a step of the particles runs on the GPU.
#pragma once

#include <cstdint>

namespace relief {

/// Every path runs the same step.glsl, and gives the same particles but for rounding.
enum class StepPath : std::uint8_t {
    kAuto,      ///< kCompute where the context has compute shaders and a GPU draws, else kFragment
    kFragment,  ///< a fragment a particle, as in the paper: OpenGL 3.3, OpenGL ES 3.0, WebGL2
    kCompute,   ///< an invocation a particle: OpenGL 4.3, OpenGL ES 3.1
};

}  // namespace relief
