// The depth sort, on each path: against std::stable_sort; as fragments against the network pass by pass, and for what
// must hold after every pass; as compute for its blocks, for numbers that are none, and beside the fragments.
#include "runtime/picture/depth_sort.h"

#include <gtest/gtest.h>

#include <functional>
#include <numeric>

#include "runtime/gl/gl_functions.h"
#include "tests/runtime/picture/depth_sort_fixture.h"
#include "tests/runtime/picture/disorder.h"

namespace relief {
namespace {

class DepthSortGlTest : public DepthSorterTest {};
class DepthSortNetworkGlTest : public DepthSorterTest {};  // fragments alone

TEST_P(DepthSortGlTest, AWholeSequenceIsAStableSort) {
    Pcg32 random(3);
    std::vector<std::uint32_t> counts{1, 2, 3, 1000, 1024, 1025, 70'000};
    if (GetParam().api == GlApi::kGl33Core) {
        counts.push_back(300'000);
    }
    for (const std::uint32_t count : counts) {
        for (const std::uint32_t levels : {4U, 1024U}) {  // ties almost everywhere, ties here and there
            if (count == 300'000 && levels == 4) {
                continue;
            }
            const Cloud cloud = latticeCloud(count, levels, random);
            make(count);
            ASSERT_FALSE(HasFatalFailure());
            update(cloud, DepthSorter::sequencePasses(count));
            ASSERT_EQ(sorter_->count(), ranksFor(count));
            std::vector<Element> expected = latticeElements(cloud, ranksFor(count));
            std::stable_sort(expected.begin(), expected.end(),
                             [](const Element& a, const Element& b) { return a.key > b.key; });
            EXPECT_TRUE(readOrder(*sorter_) == expected) << count << " particles, " << levels << " levels";
            EXPECT_EQ(sorter_->passesDone(), 0U);
        }
    }
}

TEST(DepthSort, SequencesHaveTheLengthOfThePaper) {
    const std::array<std::array<std::uint32_t, 2>, 9> lengths{
        {{0, 0}, {1, 0}, {2, 1}, {3, 3}, {4, 3}, {5, 6}, {1024, 55}, {1025, 66}, {1U << 20, 210}}};
    for (const auto& [count, passes] : lengths) {
        EXPECT_EQ(DepthSorter::sequencePasses(count), passes) << count;
    }
    EXPECT_EQ(DepthSorter::sequencePasses(DepthSorter::kCapacityMax), 300U);
    EXPECT_EQ(DepthSorter::passesPerFrame(1U << 20, 30), 7U);
    EXPECT_EQ(DepthSorter::passesPerFrame(1U << 20, 50), 5U);
    EXPECT_EQ(DepthSorter::passesPerFrame(8, 50), 1U);
    EXPECT_EQ(DepthSorter::passesPerFrame(1, 50), 0U);
}

// Batcher's network as loops over its pairs (Knuth, Algorithm M): after each pass, element for element.
TEST_P(DepthSortNetworkGlTest, EveryPassIsThatOfTheNetwork) {
    constexpr std::uint32_t kCount = 2048;
    Pcg32 random(5);
    const Cloud cloud = latticeCloud(kCount, 1024, random);
    make(kCount);
    std::vector<Element> expected = latticeElements(cloud, kCount);
    std::uint32_t passes = 0;
    for (std::uint32_t p = 1; p < kCount; p *= 2) {
        for (std::uint32_t k = p; k >= 1; k /= 2) {
            for (std::uint32_t j = k % p; j + k < kCount; j += 2 * k) {
                for (std::uint32_t i = j; i < std::min(j + k, kCount - k); ++i) {
                    if (i / (2 * p) == (i + k) / (2 * p) && before(expected[i + k], expected[i])) {
                        std::swap(expected[i], expected[i + k]);
                    }
                }
            }
            EXPECT_EQ(sorter_->passesDone(), passes);
            ++passes;
            update(cloud, 1);
            ASSERT_TRUE(readOrder(*sorter_) == expected) << "block " << 2 * p << " stride " << k;
        }
    }
    EXPECT_EQ(passes, DepthSorter::sequencePasses(kCount));
    EXPECT_TRUE(std::is_sorted(expected.begin(), expected.end(), before));
}

TEST_P(DepthSortNetworkGlTest, ARestartBeginsAWholeSequence) {
    constexpr std::uint32_t kCount = 4000;
    Pcg32 random(6);
    const Cloud first = latticeCloud(kCount, 1024, random);
    const Cloud second = latticeCloud(kCount, 1024, random);
    for (const bool restarted : {false, true}) {
        make(kCount);
        update(first, DepthSorter::sequencePasses(kCount) / 2);
        if (restarted) {
            sorter_->restart();
            EXPECT_EQ(sorter_->passesDone(), 0U);
        }
        update(second, DepthSorter::sequencePasses(kCount));
        const std::vector<Element> order = readOrder(*sorter_);
        EXPECT_EQ(std::is_sorted(order.begin(), order.end(), before), restarted);
    }
}

TEST_P(DepthSortNetworkGlTest, NoPassRaisesTheNumberOfInversions) {
    constexpr std::uint32_t kCount = 1500;  // in 2048: the absent are elements like others
    Pcg32 random(7);
    const Cloud shuffled = latticeCloud(kCount, 1024, random);
    const auto by = [&](auto less) {
        Cloud cloud;
        cloud.particles = shuffled.particles;
        std::sort(cloud.particles.begin(), cloud.particles.end(),
                  [&](const glm::vec4& a, const glm::vec4& b) {
                      return less(glm::distance(glm::vec3(a), kEye), glm::distance(glm::vec3(b), kEye));
                  });
        return cloud;
    };
    Cloud reversed = by(std::less<>());
    reversed.upload();
    Cloud nearly = by(std::greater<>());
    for (int i = 0; i < 40; ++i) {
        std::swap(nearly.particles[random.next() % kCount], nearly.particles[random.next() % kCount]);
    }
    nearly.upload();
    for (const Cloud* cloud : std::array<const Cloud*, 3>{&shuffled, &reversed, &nearly}) {
        make(kCount);
        update(*cloud, 0);
        std::vector<Element> last = readOrder(*sorter_);
        std::uint64_t inversions = countInversions(last, before);
        EXPECT_GT(inversions, 10'000U);
        for (std::uint32_t pass = 0; pass < DepthSorter::sequencePasses(kCount); ++pass) {
            update(*cloud, 1);
            const std::vector<Element> order = readOrder(*sorter_);
            std::uint64_t moved = 0;
            for (std::size_t i = 0; i < order.size(); ++i) {
                moved += order[i].index != last[i].index ? 1 : 0;
            }
            const std::uint64_t now = countInversions(order, before);
            ASSERT_LE(now + moved / 2, inversions) << "pass " << pass << ": an exchange that gained nothing";
            inversions = now;
            last = order;
        }
        EXPECT_EQ(inversions, 0U);
        // And sorted stays sorted, from any pass of a sequence to the next.
        for (std::uint32_t pass = 0; pass < DepthSorter::sequencePasses(kCount); ++pass) {
            update(*cloud, 1);
            ASSERT_EQ(readOrder(*sorter_), last);
        }
    }
}

// The same measure does see a network that worsens an order: a bitonic sort's first passes over sorted input.
TEST(Disorder, InversionsAreCountedAndABitonicPassRaisesThem) {
    Pcg32 random(9);
    std::vector<int> values(257);
    for (int& value : values) {
        value = static_cast<int>(random.next() % 50);
    }
    std::uint64_t inversions = 0;
    for (std::size_t j = 0; j < values.size(); ++j) {
        for (std::size_t i = 0; i < j; ++i) {
            inversions += values[j] < values[i] ? 1 : 0;
        }
    }
    EXPECT_EQ(countInversions(values, std::less<>()), inversions);

    std::vector<int> sorted(8);
    std::iota(sorted.begin(), sorted.end(), 0);
    EXPECT_EQ(countInversions(sorted, std::less<>()), 0U);
    for (std::size_t i = 0; i < 8; i += 2) {  // its pairs point up and down in turns
        if ((sorted[i] < sorted[i + 1]) == ((i & 2) != 0)) {
            std::swap(sorted[i], sorted[i + 1]);
        }
    }
    EXPECT_EQ(countInversions(sorted, std::less<>()), 2U);

    const std::array<double, 4> drawn{4.0, 1.0, 2.0, 3.0};
    const Disorder disorder = disorderOf(drawn);
    EXPECT_DOUBLE_EQ(disorder.adjacent, 2.0 / 3.0);
    EXPECT_DOUBLE_EQ(disorder.pairs, 0.5);
    EXPECT_DOUBLE_EQ(disorder.depth_error, 1.0);  // |4−4|, |1−3|, |2−2|, |3−1|
}

TEST_P(DepthSortGlTest, KeysAreDistancesAndTheDeadHaveNone) {
    Pcg32 random(13);
    Cloud cloud;
    for (int i = 0; i < 3000; ++i) {
        cloud.particles.emplace_back(random.between(-1.0F, 1.0F), random.between(-1.0F, 1.0F),
                                     random.between(-1.0F, 1.0F), i % 5 == 0 ? -1.0F : static_cast<float>(i));
    }
    const glm::vec3 eye{0.3F, 0.1F, 1.7F};
    cloud.particles[1] = glm::vec4(eye, 0.0F);       // at the eye, and alive
    cloud.particles[2] = {1e30F, 0.0F, 0.0F, 0.0F};  // its square is beyond floats
    cloud.upload();
    make(4000);
    sorter_->update(cloud.texture, cloud.width, 2900, eye, DepthSorter::sequencePasses(2900));
    const std::vector<Element> order = readOrder(*sorter_);
    ASSERT_EQ(order.size(), ranksFor(2900));
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end(), before));
    EXPECT_EQ(order[0].index, 2U);
    for (const Element& element : order) {
        const bool alive = element.index < 2900 && element.index % 5 != 0;  // beyond the extent: leftovers
        ASSERT_EQ(element.key != 0, alive) << element.index;
        if (alive && element.index > 2) {
            // Three roundings, 3 · 2^-24 of the whole, on top of those of the differences, twice 2^-24.
            const glm::dvec3 away = glm::dvec3(cloud.particles[element.index]) - glm::dvec3(eye);
            const double exact = glm::dot(away, away);
            ASSERT_NEAR(std::bit_cast<float>(element.key), exact, exact * 6.0 * 0x1p-24);
        }
    }
}

TEST_P(DepthSortGlTest, TheCallersStateIsKeptAndDoesNoHarm) {
    Pcg32 random(29);
    const Cloud cloud = latticeCloud(2000, 1024, random);
    make(2000);
    update(cloud, DepthSorter::sequencePasses(2000));
    const std::vector<Element> plain = readOrder(*sorter_);

    const GlTexture other = makeTexture2D(GL_RGBA8, 4, 4, GL_RGBA, GL_UNSIGNED_BYTE);
    const std::array<GLuint, 1> others{other.name()};
    const auto framebuffer = makeFramebuffer(others);
    ASSERT_TRUE(framebuffer);
    const GlVertexArray array = makeVertexArray();
    glBindVertexArray(array.name());
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer->name());
    for (GLenum unit = 0; unit < 2; ++unit) {
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_2D, other.name());
    }
    glViewport(1, 2, 3, 4);
    glScissor(0, 0, 1, 1);
    const std::array<GLenum, 7> switches{GL_SCISSOR_TEST,   GL_BLEND,     GL_DEPTH_TEST,
                                         GL_STENCIL_TEST,   GL_CULL_FACE, GL_RASTERIZER_DISCARD,
                                         GL_SAMPLE_COVERAGE};
    for (const GLenum what : switches) {
        glEnable(what);
    }
    glCullFace(GL_FRONT_AND_BACK);
    glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE);

    make(2000);
    update(cloud, DepthSorter::sequencePasses(2000));
    const auto integer = [](GLenum what) {
        GLint value[4] = {};
        glGetIntegerv(what, value);
        return static_cast<GLuint>(value[0]);
    };
    EXPECT_EQ(integer(GL_CURRENT_PROGRAM), 0U);
    EXPECT_EQ(integer(GL_VERTEX_ARRAY_BINDING), array.name());
    EXPECT_EQ(integer(GL_DRAW_FRAMEBUFFER_BINDING), framebuffer->name());
    EXPECT_EQ(integer(GL_READ_FRAMEBUFFER_BINDING), framebuffer->name());
    EXPECT_EQ(integer(GL_VIEWPORT), 1U);
    EXPECT_EQ(integer(GL_COLOR_WRITEMASK), 0U);
    EXPECT_EQ(integer(GL_ACTIVE_TEXTURE), static_cast<GLuint>(GL_TEXTURE1));
    EXPECT_EQ(integer(GL_TEXTURE_BINDING_2D), other.name());
    glActiveTexture(GL_TEXTURE0);
    EXPECT_EQ(integer(GL_TEXTURE_BINDING_2D), other.name());
    for (const GLenum what : switches) {
        EXPECT_TRUE(glIsEnabled(what)) << what;
    }
    EXPECT_EQ(readOrder(*sorter_), plain);
}

TEST_P(DepthSortGlTest, CapacitiesOutOfRangeAreErrorsAndExtentsBeyondAreLeftOut) {
    EXPECT_EQ(DepthSorter::create(0).error().code, ErrorCode::kUsage);
    EXPECT_EQ(DepthSorter::create(DepthSorter::kCapacityMax + 1).error().code, ErrorCode::kUsage);
    Pcg32 random(31);
    const Cloud cloud = latticeCloud(300, 1024, random);
    make(100);
    update(cloud, DepthSorter::sequencePasses(100));
    const std::vector<Element> order = readOrder(*sorter_);
    ASSERT_EQ(order.size(), ranksFor(100));
    for (const Element& element : order) {
        EXPECT_TRUE(element.index < 100 || element.key == 0);
    }
}

RELIEF_INSTANTIATE_STEP_TESTS(DepthSortGlTest);
INSTANTIATE_TEST_SUITE_P(Fragments, DepthSortNetworkGlTest,
                         testing::Values(StepCase{GlApi::kGl33Core, StepPath::kFragment},
                                         StepCase{GlApi::kGles30, StepPath::kFragment}),
                         stepTestName);

}  // namespace
}  // namespace relief
