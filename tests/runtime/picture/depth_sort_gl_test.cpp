// The depth sort, on each path: against std::stable_sort, and as fragments against the network pass by pass.
#include "runtime/picture/depth_sort.h"

#include "tests/runtime/picture/depth_sort_fixture.h"

namespace relief {
namespace {

class DepthSortGlTest : public DepthSorterTest {};
class DepthSortNetworkGlTest : public DepthSorterTest {};  // fragments alone

TEST_P(DepthSortGlTest, AWholeSequenceIsAStableSort) {
    Pcg32 random(3);
    for (const std::uint32_t count : {1U, 2U, 3U, 1000U, 1024U, 1025U, 70'000U}) {
        for (const std::uint32_t levels : {4U, 1024U}) {  // ties almost everywhere, ties here and there
            const Cloud cloud = latticeCloud(count, levels, random);
            make(count);
            ASSERT_FALSE(HasFatalFailure());
            update(cloud, DepthSorter::sequencePasses(count));
            ASSERT_EQ(sorter_->count(), ranksFor(count));
            EXPECT_TRUE(readOrder(*sorter_) == stablySorted(cloud, ranksFor(count)))
                << count << " particles, " << levels << " levels";
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
