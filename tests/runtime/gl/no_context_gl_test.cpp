// Without a current context everything that makes objects of the GL says so, and nothing else.
#include <gtest/gtest.h>

#include <string>

#include "runtime/collider/collider_textures.h"
#include "runtime/gl/gl_context.h"
#include "runtime/particles/particle_system.h"
#include "runtime/picture/depth_sort.h"
#include "runtime/picture/frame.h"
#include "runtime/picture/particle_renderer.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief {
namespace {

template <class T>
void expectSaysSo(const Result<T>& result) {
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::kUsage);
    EXPECT_NE(result.error().message.find("no OpenGL context is current"), std::string::npos)
        << result.error().message;
}

void askForEverything() {
    expectSaysSo(ColliderTextures::create(Collider{}));
    expectSaysSo(ParticleSystem::create());
    expectSaysSo(DepthSorter::create(1024));
    expectSaysSo(Frame::create(64, 64));
    expectSaysSo(ParticleRenderer::create(std::nullopt));
}

TEST(NoContext, IsSaidAsSuch) {
    SharedGlContexts::instance().drop();
    askForEverything();
    { ASSERT_TRUE(GlContext::create()); }
    askForEverything();  // also where there was one
}

}  // namespace
}  // namespace relief
