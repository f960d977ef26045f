// SPDX-License-Identifier: Apache-2.0
// Tests of the simulation: once for each path that a step can take, in both APIs.
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
    /// The path of the case at hand, whatever the options say.
    [[nodiscard]] static ParticleSystemOptions onPath(ParticleSystemOptions options) {
        options.path = GetParam().path;
        return options;
    }
};

// Compute in OpenGL ES is step_path_gl_test.cpp's, the same bits as fragments there, and depth_sort_gl_test.cpp's.
#define RELIEF_INSTANTIATE_STEP_TESTS(suite)                                                  \
    INSTANTIATE_TEST_SUITE_P(Paths, suite,                                                    \
                             testing::Values(StepCase{GlApi::kGl33Core, StepPath::kFragment}, \
                                             StepCase{GlApi::kGles30, StepPath::kFragment},   \
                                             StepCase{GlApi::kGl33Core, StepPath::kCompute}), \
                             stepTestName)

// What the CPU decides alone, such as which arguments are refused.
#define RELIEF_INSTANTIATE_STEP_TESTS_ONCE(suite)                                                            \
    INSTANTIATE_TEST_SUITE_P(Paths, suite, testing::Values(StepCase{GlApi::kGl33Core, StepPath::kFragment}), \
                             stepTestName)

}  // namespace relief
