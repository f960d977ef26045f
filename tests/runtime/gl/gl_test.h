// A current OpenGL context for each test, once for OpenGL 3.3 core and once for OpenGL ES 3.0. A test fails,
// and is not skipped, where there is no context: Mesa's llvmpipe gives one on every machine.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "runtime/gl/gl_context.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/gl_object.h"

namespace relief {

inline std::string glApiTestName(const testing::TestParamInfo<GlApi>& info) {
    return info.param == GlApi::kGles30 ? "Gles30" : "Gl33Core";
}

inline GlApi apiOf(GlApi api) {
    return api;
}

/// Of tests whose parameter names an API, by apiOf().
template <class Param>
class GlTestOf : public testing::TestWithParam<Param> {
  protected:
    void SetUp() override {
        Result<std::unique_ptr<GlContext>> context = GlContext::create(apiOf(this->GetParam()));
        ASSERT_TRUE(context) << context.error().message;
        context_ = std::move(*context);
        this->RecordProperty("context", context_->description());
    }
    void TearDown() override {
        if (context_) {
            EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
        }
    }

    // Outlives the members of a fixture, which give their GL names back.
    std::unique_ptr<GlContext> context_;
};

using GlTest = GlTestOf<GlApi>;

#define RELIEF_INSTANTIATE_GL_TESTS(suite) \
    INSTANTIATE_TEST_SUITE_P(Apis, suite, testing::Values(GlApi::kGl33Core, GlApi::kGles30), glApiTestName)

}  // namespace relief
