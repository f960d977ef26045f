// The depth sort as compute, in OpenGL 4.3 and in OpenGL ES 3.1: at the edges of its blocks, for numbers that are none, and
// beside the fragment path.
#include <gtest/gtest.h>

#include <limits>

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
};

// A row is 256 elements; a block is one row, and of more than 512 rows two: the sorter sees more and fewer in turn.
TEST_P(DepthSortComputeGlTest, AStableSortOfEverySize) {
    Pcg32 random(41);
    DepthSorter sorter = make(300'001);
    std::vector<std::uint32_t> counts{1,   2,   3,    31,   32,     33,     255,    256, 257,
                                      511, 513, 1000, 4096, 65'535, 65'536, 65'537, 7};
    if (GetParam() == GlApi::kGl33Core) {
        counts.insert(counts.end(), {131'071, 131'073, 300'001, 16'384});
    }
    for (const std::uint32_t count : counts) {
        for (const std::uint32_t levels : {1024U, 1U}) {  // all at one place
            if (levels == 1 && count > 5000) {
                continue;
            }
            const Cloud cloud = latticeCloud(count, levels, random);
            EXPECT_TRUE(sorted(sorter, cloud) == stablySorted(cloud, count)) << count << " particles";
            EXPECT_EQ(sorter.count(), count);
            EXPECT_EQ(sorter.passesDone(), 0U);
        }
    }
    sorter.update(GlTexture(), 1, 0, kEye, 1);
    EXPECT_EQ(sorter.count(), 0U);
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
