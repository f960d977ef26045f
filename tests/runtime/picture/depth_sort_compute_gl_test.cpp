// The depth sort as compute, in OpenGL 4.3 and in OpenGL ES 3.1: at the edges of its blocks, for numbers that are none,
// beside the fragment path, and with the caller's storage and images as they were.
#include <gtest/gtest.h>

#include <limits>

#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/picture/frame.h"
#include "runtime/picture/particle_renderer.h"
#include "tests/runtime/picture/depth_sort_fixture.h"

namespace relief {
namespace {

class DepthSortComputeGlTest : public GlTest {
  protected:
    static DepthSorter make(std::uint32_t capacity, StepPath path = StepPath::kCompute) {
        auto sorter = DepthSorter::create(capacity, path);
        EXPECT_TRUE(sorter) << sorter.error().message;
        return std::move(*sorter);
    }
    static std::vector<Element> sorted(DepthSorter& sorter, const Cloud& cloud) {
        sorter.update(cloud.texture, cloud.width, cloud.extent(), kEye,
                      DepthSorter::sequencePasses(cloud.extent()));
        return readOrder(sorter);
    }
    static std::vector<Element> stablySorted(const Cloud& cloud) {
        std::vector<Element> expected = latticeElements(cloud, cloud.extent());
        std::stable_sort(expected.begin(), expected.end(),
                         [](const Element& a, const Element& b) { return a.key > b.key; });
        return expected;
    }
};

// A row is 256 elements; a block is one row, and of more than 512 rows two: the sorter sees more and fewer in turn.
TEST_P(DepthSortComputeGlTest, AStableSortOfEverySize) {
    Pcg32 random(41);
    DepthSorter sorter = make(300'001);
    std::vector<std::uint32_t> counts{1,   2,   3,    31,   32,     33,     255,    256, 257,
                                      511, 513, 1000, 4096, 65'535, 65'536, 65'537, 7};
    if (GetParam() == GlApi::kGl33Core) {
        counts.insert(counts.end(), {131'071, 1025, 131'072, 131'073, 262'145, 300'001, 16'384});
    }
    for (const std::uint32_t count : counts) {
        const Cloud cloud = latticeCloud(count, 1024, random);
        EXPECT_TRUE(sorted(sorter, cloud) == stablySorted(cloud)) << count << " particles";
        EXPECT_EQ(sorter.count(), count);
        EXPECT_EQ(sorter.passesDone(), 0U);
    }
    sorter.update(GlTexture(), 1, 0, kEye, 1);
    EXPECT_EQ(sorter.count(), 0U);
}

TEST_P(DepthSortComputeGlTest, EqualKeysStayInTheOrderOfTheirIndices) {
    constexpr std::uint32_t kCount = 20'000;
    for (const float w : {0.0F, -1.0F}) {  // all at one place, or all dead
        Cloud cloud;
        cloud.particles.assign(kCount, glm::vec4(1.0F, 2.0F, 3.0F, w));
        cloud.upload();
        DepthSorter sorter = make(kCount);
        const std::vector<Element> order = sorted(sorter, cloud);
        ASSERT_EQ(order.size(), kCount);
        for (std::uint32_t i = 0; i < kCount; ++i) {
            ASSERT_EQ(order[i].index, i);
            ASSERT_EQ(order[i].key != 0, w >= 0.0F);
        }
    }
}

// The squares of these range over all that floats have: every digit of a key has many values.
TEST_P(DepthSortComputeGlTest, NumbersOfAnySizeAndNumbersThatAreNone) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr std::uint32_t kCount = 5000;
    Pcg32 random(43);
    Cloud cloud;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const auto power = static_cast<int>(random.next() % 130) - 65;
        cloud.particles.emplace_back(
            kEye + glm::vec3(std::ldexp(random.between(-1.0F, 1.0F), power), 0.0F, 0.0F),
            i % 7 == 0 ? -1.0F : 0.0F);
    }
    const std::array<float, 6> odd{kNan, -kNan, kInfinity, -kInfinity, 3e38F, -3e38F};
    for (std::uint32_t i = 0; i < odd.size(); ++i) {
        cloud.particles[700 * i + 1][static_cast<int>(i % 3)] = odd[i];
    }
    cloud.upload();
    DepthSorter sorter = make(kCount);
    const std::vector<Element> order = sorted(sorter, cloud);
    ASSERT_EQ(order.size(), kCount);
    expectPermutation(order);
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end(), before));
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
        const Element& element = order[rank];
        EXPECT_EQ(element.key != 0, cloud.particles[element.index].w >= 0.0F);
        if (rank < odd.size()) {
            EXPECT_EQ(element.index % 700, 1U) << "what is nowhere, or farther than floats go, comes first";
        }
    }
    DepthSorter fragments = make(kCount, StepPath::kFragment);
    std::vector<Element> other = sorted(fragments, cloud);
    EXPECT_GE(other.size(), order.size());
    if (context_->software()) {  // a GPU may fuse other operations: other last bits of a key
        other.resize(order.size());
        EXPECT_TRUE(order == other);
    }
}

// A particle system on each path, sorted and drawn on the same: places of the lattice have the same keys on every GPU.
TEST_P(DepthSortComputeGlTest, BothPathsGiveTheSamePicture) {
    constexpr std::uint32_t kCount = 3000;
    auto renderer = ParticleRenderer::create(std::nullopt);
    ASSERT_TRUE(renderer) << renderer.error().message;
    Camera camera;
    camera.eye = kEye;
    camera.fov = 90.0F;
    ParticleStyle style;
    style.sprite = Sprite::kQuad;
    style.opacity = 0.5F;
    style.diameter = 0.5F;
    for (const glm::vec3& color : {glm::vec3(1.0F, 0.2F, 0.1F), glm::vec3(0.1F, 0.3F, 1.0F)}) {
        style.looks.emplace_back().color = {{0.0F, color}};
    }
    std::vector<std::vector<std::uint8_t>> pictures;
    for (const bool drawn_in_order : {true, false}) {
        for (const StepPath path : {StepPath::kFragment, StepPath::kCompute}) {
            auto particles = ParticleSystem::create({.capacity = kCount, .path = path});
            auto frame = Frame::create(96, 64);
            ASSERT_TRUE(particles && frame);
            Pcg32 random(47);
            std::vector<Birth> births;
            for (const glm::vec4& place : latticeCloud(kCount, 256, random).particles) {
                births.push_back(
                    {glm::vec3(place), glm::vec3(0.0F), place.w < 0.0F ? 0.1F : 1.0F, random.next() % 2});
            }
            particles->spawn(births);
            particles->step(0.25F);  // the one life in nine that is short is over
            DepthSorter sorter = make(kCount, path);
            sorter.update(particles->positions(), particles->textureWidth(), particles->extent(), kEye,
                          DepthSorter::sequencePasses(kCount));
            ParticleOrder order;
            if (drawn_in_order) {
                order = {&sorter.order(), sorter.count()};
            }
            glBindFramebuffer(GL_FRAMEBUFFER, frame->target().framebuffer);
            const std::array<GLfloat, 4> black{};
            const GLfloat far = 1.0F;
            glClearBufferfv(GL_COLOR, 0, black.data());
            glClearBufferfv(GL_DEPTH, 0, &far);
            glBindFramebuffer(GL_FRAMEBUFFER, 0);
            ASSERT_TRUE(renderer->draw(*particles, camera, style, frame->target(), order));
            pictures.push_back(frame->read());
        }
    }
    EXPECT_EQ(pictures[0], pictures[1]);
    EXPECT_NE(pictures[0], pictures[2]) << "the order makes no difference: the test does not test";
}

TEST_P(DepthSortComputeGlTest, TheCallersStorageAndImagesAreKept) {
    Pcg32 random(53);
    const Cloud cloud = latticeCloud(2000, 1024, random);
    const GlTexture image = makeImageTexture2D(GL_R32F, 4, 4);
    glBindImageTexture(0, image.name(), 0, GL_FALSE, 0, GL_READ_ONLY, GL_R32F);
    const GlBuffer whole = StorageUnits::make(1024);
    const GlBuffer part = StorageUnits::make(4096);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, whole.name());
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 2, part.name(), 1024, 512);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, whole.name());
    const auto state = [] {
        std::vector<GLint64> values;
        for (GLuint unit = 0; unit < StorageUnits::kUnits; ++unit) {
            for (const GLenum what : {GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
                                      GL_SHADER_STORAGE_BUFFER_SIZE}) {
                glGetInteger64i_v(what, unit, &values.emplace_back());
            }
        }
        GLint value = 0;
        glGetIntegerv(GL_SHADER_STORAGE_BUFFER_BINDING, &value);
        values.push_back(value);
        for (const GLenum what : {GL_IMAGE_BINDING_NAME, GL_IMAGE_BINDING_ACCESS, GL_IMAGE_BINDING_FORMAT}) {
            glGetIntegeri_v(what, 0, &value);
            values.push_back(value);
        }
        glGetIntegerv(GL_CURRENT_PROGRAM, &value);
        values.push_back(value);
        return values;
    };
    const std::vector<GLint64> before = state();
    DepthSorter sorter = make(2000);
    EXPECT_EQ(state(), before) << "create";
    sorter.update(cloud.texture, cloud.width, cloud.extent(), kEye, 1);
    EXPECT_EQ(state(), before) << "update";
    EXPECT_TRUE(readOrder(sorter) == stablySorted(cloud));
}

TEST_P(DepthSortComputeGlTest, AutoTakesComputeWhereAGpuDraws) {
    Pcg32 random(59);
    const Cloud cloud = latticeCloud(3, 1024, random);
    DepthSorter sorter = make(3, StepPath::kAuto);
    sorter.update(cloud.texture, cloud.width, cloud.extent(), kEye, 0);
    EXPECT_EQ(sorter.count(), context_->software() ? 4U : 3U);
}

RELIEF_INSTANTIATE_GL_TESTS(DepthSortComputeGlTest);

}  // namespace
}  // namespace relief
