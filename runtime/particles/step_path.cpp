// SPDX-License-Identifier: Apache-2.0
#include "runtime/particles/step_path.h"

#include <string>

#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/gl_object.h"

namespace relief {

Result<StepPath> resolvePath(StepPath wanted) {
    if (wanted == StepPath::kCompute && !hasCompute()) {
        return fail(ErrorCode::kUnsupported,
                    "compute shaders need OpenGL 4.3 or OpenGL ES 3.1, and this context has " +
                        std::string(reinterpret_cast<const char*>(glGetString(GL_VERSION))) +
                        "; use fragment shaders");
    }
    if (wanted == StepPath::kAuto) {
        return hasCompute() && !isSoftwareRenderer() ? StepPath::kCompute : StepPath::kFragment;
    }
    return wanted;
}

}  // namespace relief
