// SPDX-License-Identifier: Apache-2.0
// Simulation tests, run once for each step path in both APIs.
#pragma once

#include <string>

#include "runtime/particles/particle_system.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief {

struct StepCase {
    GlApi api;
    StepPath path;
};

inline GlApi apiOf(const StepCase& step) {
    return step.api;
}

inline std::string stepTestName(const testing::TestParamInfo<StepCase>& info) {
    const bool gles = info.param.api == GlApi::kGles30;
    return info.param.path == StepPath::kCompute ? (gles ? "ComputeGles31" : "ComputeGl43")
                                                 : (gles ? "Gles30" : "Gl33Core");
}

class StepGlTest : public GlTestOf<StepCase> {
  public:
    /// Sets the path of the current case.
    [[nodiscard]] static ParticleSystemOptions onPath(ParticleSystemOptions options) {
        options.path = GetParam().path;
        return options;
    }
};

// Two other files test compute in OpenGL ES: step_path_gl_test.cpp, which expects the bits of the fragment path, and
// depth_sort_gl_test.cpp.
#define RELIEF_INSTANTIATE_STEP_TESTS(suite)                                                  \
    INSTANTIATE_TEST_SUITE_P(Paths, suite,                                                    \
                             testing::Values(StepCase{GlApi::kGl33Core, StepPath::kFragment}, \
                                             StepCase{GlApi::kGles30, StepPath::kFragment},   \
                                             StepCase{GlApi::kGl33Core, StepPath::kCompute}), \
                             stepTestName)

// For code that runs only on the CPU, such as argument validation.
#define RELIEF_INSTANTIATE_STEP_TESTS_ONCE(suite)                                                            \
    INSTANTIATE_TEST_SUITE_P(Paths, suite, testing::Values(StepCase{GlApi::kGl33Core, StepPath::kFragment}), \
                             stepTestName)

}  // namespace relief
