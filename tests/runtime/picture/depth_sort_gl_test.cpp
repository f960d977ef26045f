// SPDX-License-Identifier: Apache-2.0
// The depth sort on each path: against std::stable_sort. While particles move, are born and die, and the viewer moves,
// it checks invariants of every frame and how far the order is from sorted.
#include "runtime/picture/depth_sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "runtime/particles/random.h"
#include "tests/runtime/particles/step_gl_test.h"

namespace relief {
namespace {

struct Element {
    std::uint32_t index = 0;
    std::uint32_t key = 0;
    friend bool operator==(const Element&, const Element&) = default;
};

/// The comparison of the shaders.
bool before(const Element& a, const Element& b) {
    return a.key != b.key ? a.key > b.key : a.index < b.index;
}

std::vector<Element> readOrder(const DepthSorter& sorter) {
    const PassState state;
    const GlFramebuffer target = required(makeFramebuffer({sorter.order().name()}));
    const std::uint32_t width = std::min(sorter.count(), DepthSorter::kWidth);
    const std::uint32_t rows = (sorter.count() + DepthSorter::kWidth - 1) / DepthSorter::kWidth;
    std::vector<std::uint32_t> words(std::size_t{4} * width * rows);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target.name());
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, static_cast<GLsizei>(width), static_cast<GLsizei>(rows), GL_RGBA_INTEGER,
                 GL_UNSIGNED_INT, words.data());
    std::vector<Element> order(sorter.count());
    for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = {words[4 * i], words[4 * i + 1]};
    }
    return order;
}

/// Every index below count() exactly once.
void expectPermutation(const std::vector<Element>& order) {
    std::vector<bool> seen(order.size());
    for (const Element& element : order) {
        ASSERT_LT(element.index, order.size());
        ASSERT_FALSE(seen[element.index]) << "index " << element.index << " twice";
        seen[element.index] = true;
    }
}

/// The test's own particles, in the layout of a particle system.
struct Cloud {
    std::vector<glm::vec4> particles;  // w < 0: dead
    std::uint32_t width = 0;
    GlTexture texture;

    void upload() {
        const PassState state;
        width = std::min(static_cast<std::uint32_t>(particles.size()), 1024U);
        const std::size_t rows = (particles.size() + width - 1) / width;
        std::vector<glm::vec4> texels = particles;
        texels.resize(rows * width, glm::vec4(0.0F, 0.0F, 0.0F, 1.0F));  // stale data that looks alive
        texture = makeTexture2D(GL_RGBA32F, static_cast<GLsizei>(width), static_cast<GLsizei>(rows), GL_RGBA,
                                GL_FLOAT, texels.data());
    }
    [[nodiscard]] std::uint32_t extent() const { return static_cast<std::uint32_t>(particles.size()); }
};

/// Coordinates are multiples of 1/64 in [−8, 8). With an eye at such coordinates, every squared distance is a multiple
/// of 2^-12 below 2^11, exact in float for any order of operations. One in nine particles is dead.
Cloud latticeCloud(std::uint32_t count, std::uint32_t levels, Pcg32& random) {
    Cloud cloud;
    for (std::uint32_t i = 0; i < count; ++i) {
        glm::vec4 particle(0.0F, 0.0F, 0.0F, random.next() % 9 == 0 ? -1.0F : 0.0F);
        for (int axis = 0; axis < 3; ++axis) {
            const auto level = static_cast<float>(random.next() % levels);
            particle[axis] = level * (16.0F / static_cast<float>(levels)) - 8.0F;
        }
        cloud.particles.push_back(particle);
    }
    cloud.upload();
    return cloud;
}

const glm::vec3 kEye{1.5F, -2.25F, 7.0F};

std::vector<Element> stablySorted(const Cloud& cloud, std::uint32_t ranks) {
    std::vector<Element> elements(ranks);
    for (std::uint32_t i = 0; i < elements.size(); ++i) {
        elements[i].index = i;
        if (i < cloud.extent() && cloud.particles[i].w >= 0.0F) {
            const glm::vec3 away = glm::vec3(cloud.particles[i]) - kEye;
            elements[i].key = std::max(std::bit_cast<std::uint32_t>(glm::dot(away, away)), 1U);
        }
    }
    std::ranges::stable_sort(elements, std::greater(), &Element::key);
    return elements;
}

/// One sorter on the path of the case.
class DepthSorterTest : public StepGlTest {
  protected:
    static bool exact() { return GetParam().path == StepPath::kCompute; }
    /// The ranks needed for this many particles.
    static std::uint32_t ranksFor(std::uint32_t extent) {
        return exact() || extent == 0 ? extent : std::bit_ceil(extent);
    }
    void make(std::uint32_t capacity) {
        sorter_ = std::make_unique<DepthSorter>(required(DepthSorter::create(capacity, GetParam().path)));
    }
    void update(const Cloud& cloud, std::uint32_t passes, const glm::vec3& eye = kEye) {
        sorter_->update(cloud.texture, cloud.width, cloud.extent(), eye, passes);
    }
    std::unique_ptr<DepthSorter> sorter_;
};

class DepthSortGlTest : public DepthSorterTest {};
class DepthSortNetworkGlTest : public DepthSorterTest {};  // only fragments
class DepthSortMotionGlTest : public DepthSorterTest {};

// In compute, a row is 256 elements. A block is one row, or two for more than 512 rows: one sorter sees both in turn.
TEST_P(DepthSortGlTest, WholeSequencesAreStableSorts) {
    Pcg32 random(3);
    std::vector<std::uint32_t> counts{1, 2, 3, 1000, 1024, 1025, 70'000};
    if (exact()) {
        counts.insert(counts.end(), {31, 32, 33, 255, 256, 257, 511, 513, 65'535, 65'536, 65'537, 131'071,
                                     131'073, 300'001, 7});
        make(300'001);
    }
    for (const std::uint32_t count : counts) {
        for (const std::uint32_t levels :
             {1U, 4U, 1024U}) {  // one position; ties almost everywhere; some ties
            if (levels < 1024 && count > 70'000) {
                continue;
            }
            const Cloud cloud = latticeCloud(count, levels, random);
            if (!exact()) {
                make(count);
            }
            update(cloud, DepthSorter::sequencePasses(count));
            ASSERT_EQ(sorter_->count(), ranksFor(count));
            EXPECT_TRUE(readOrder(*sorter_) == stablySorted(cloud, ranksFor(count)))
                << count << " particles, " << levels << " levels";
            EXPECT_EQ(sorter_->passesDone(), 0U);
        }
    }
    if (exact()) {
        sorter_->update(GlTexture(), 1, 0, kEye, 1);
        EXPECT_EQ(sorter_->count(), 0U);
    }
}

TEST(DepthSort, SequencesAreAsLongAsInThePaper) {
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

TEST_P(DepthSortNetworkGlTest, RestartsBeginAWholeSequence) {
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

// For numbers of all magnitudes, so that every digit of a key has many values, and for NaN.
TEST_P(DepthSortGlTest, KeysAreDistancesAndZeroForTheDead) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr std::uint32_t kExtent = 4900;
    Pcg32 random(13);
    Cloud cloud;
    for (int i = 0; i < 5000; ++i) {
        const float size = std::ldexp(1.0F, i % 2 == 0 ? 0 : static_cast<int>(random.next() % 120) - 60);
        const float x = random.between(-size, size);
        const float y = random.between(-size, size);
        cloud.particles.emplace_back(x, y, random.between(-size, size),
                                     i % 5 == 0 ? -1.0F : static_cast<float>(i));
    }
    const glm::vec3 eye{0.3F, 0.1F, 1.7F};
    cloud.particles[1] = glm::vec4(eye, 0.0F);  // at the eye, but alive
    const std::array<float, 7> odd{kNan, -kNan, kInfinity, -kInfinity, 3e38F, -3e38F, 1e30F};
    for (std::uint32_t i = 0; i < odd.size(); ++i) {
        cloud.particles[600 * i + 2][static_cast<int>(i % 3)] = odd[i];
    }
    cloud.upload();
    make(5000);
    sorter_->update(cloud.texture, cloud.width, kExtent, eye, DepthSorter::sequencePasses(kExtent));
    const std::vector<Element> order = readOrder(*sorter_);
    ASSERT_EQ(order.size(), ranksFor(kExtent));
    expectPermutation(order);
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end(), before));
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
        const Element& element = order[rank];
        const bool alive = element.index < kExtent && element.index % 5 != 0;  // stale data beyond the extent
        ASSERT_EQ(element.key != 0, alive) << element.index;
        if (rank < odd.size()) {
            EXPECT_EQ(element.index % 600, 2U) << "NaN and infinite distances come first";
        } else if (alive && element.index > 2) {
            // Three roundings, 3 · 2^-24 of the total, plus those of the differences, 2 · 2^-24.
            const glm::dvec3 away = glm::dvec3(cloud.particles[element.index]) - glm::dvec3(eye);
            const double squared = glm::dot(away, away);
            ASSERT_NEAR(std::bit_cast<float>(element.key), squared, squared * 6.0 * 0x1p-24);
        }
    }
}

TEST_P(DepthSortGlTest, InvalidCapacitiesAreErrorsAndLargerExtentsAreIgnored) {
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

TEST_P(DepthSortMotionGlTest, IsAPermutationForChangingExtents) {
    constexpr std::uint32_t kCapacity = 5000;
    Pcg32 random(17);
    make(kCapacity);
    ASSERT_EQ(sorter_->count(), 0U);
    const std::array<std::uint32_t, 16> extents{0,    1,    3, 0, 900, 1024, 1025, 40,
                                                5000, 4097, 2, 0, 600, 2049, 2048, 9};
    for (std::size_t leg = 0; leg < 2 * extents.size(); ++leg) {
        const std::uint32_t extent = extents[leg % extents.size()];
        // The first round ends some legs before their sequence ends, the second none.
        const bool whole = leg >= extents.size();
        // On the compute path every update is a complete sort.
        const std::uint32_t frames = exact() ? 1 : whole ? 40 : 1 + random.next() % 30;
        for (std::uint32_t frame = 0; frame < frames; ++frame) {
            Cloud cloud = latticeCloud(kCapacity, 1024, random);  // all particles move, many die or are born
            const std::uint32_t before_count = sorter_->count();
            sorter_->update(cloud.texture, cloud.width, extent, kEye, 6);
            const std::uint32_t count = sorter_->count();
            ASSERT_GE(count, extent);
            ASSERT_TRUE(count == 0 || exact() || std::has_single_bit(count));
            ASSERT_LE(count, exact() ? extent : std::max(before_count, ranksFor(extent)));
            const std::vector<Element> order = readOrder(*sorter_);
            expectPermutation(order);
            ASSERT_FALSE(HasFatalFailure()) << "leg " << leg << " frame " << frame;
            for (const Element& element : order) {
                const bool alive = element.index < extent && cloud.particles[element.index].w >= 0.0F;
                ASSERT_EQ(element.key != 0, alive);
            }
        }
        // 40 frames of 6 passes are more than two sequences of 91: the sorted region is as small as possible.
        if (whole) {
            ASSERT_EQ(sorter_->count(), ranksFor(extent)) << "leg " << leg;
        }
    }
}

struct Disorder {
    double adjacent = 0.0;     ///< fraction of neighbours out of order; ½ for a random order
    double depth_error = 0.0;  ///< mean of |distance drawn i-th - distance that belongs i-th|, object units

    /// Adds the error of one of `frames` frames, from distances to the eye in drawing order.
    void add(const std::vector<double>& drawn, double frames) {
        std::vector<double> sorted = drawn;
        std::sort(sorted.begin(), sorted.end(), std::greater<>());
        const double n = static_cast<double>(drawn.size()) * frames;
        for (std::size_t i = 0; i < drawn.size(); ++i) {
            adjacent += i > 0 && drawn[i] > drawn[i - 1] ? 1.0 / (n - frames) : 0.0;
            depth_error += std::abs(drawn[i] - sorted[i]) / n;
        }
    }
};

// Snow that falls in a box of 3 · 1 · 3 and wraps to the top, seen by a camera that circles it, at 60 frames per
// second. runtime/METHOD.md states depth errors as fractions of those in index order; the bounds leave a margin of at
// least a fifth for other roundings. New particles wait at the end for one or two
// sequences, so short lives have an effect. Neighbours may be as close in depth as 0.0003, so 4 in 10 of them are
// easily out of order.
TEST_P(DepthSortMotionGlTest, KeepsUpWithMotionWhenSpreadOverFrames) {
    constexpr std::uint32_t kCount = 12'000;  // 16,384 ranks, 105 passes
    struct Case {
        std::uint32_t frames;  // frames per sequence
        float life;  // seconds between two deaths of a flake, of which it is dead 1/20; 0: none dies
        double most;
    };
    for (const Case& c : {Case{10, 5.0F, 0.14}, Case{30, 0.0F, 0.1}, Case{50, 30.0F, 0.17}}) {
        SCOPED_TRACE(c.frames);
        make(kCount);
        const std::uint32_t frames = exact() ? 3 : c.frames;
        const std::uint32_t measured = (4 * frames - 1) / 3 - (2 * frames - 1) / 3;
        Disorder sorted;
        Disorder unsorted;
        for (std::uint32_t frame = 0; frame < 4 * frames; ++frame) {
            const float time = static_cast<float>(frame) / 60.0F;
            Cloud cloud;
            Pcg32 random(23);
            for (std::uint32_t i = 0; i < kCount; ++i) {
                glm::vec4 flake(random.between(-1.5F, 1.5F), 0.0F, random.between(-1.5F, 1.5F), 0.0F);
                flake.y = 0.5F - std::fmod(0.8F * time + random.uniform(), 1.0F);
                if (c.life > 0.0F) {  // reborn at another place each time
                    const float lives = time / c.life + random.uniform();
                    flake.z = std::fmod(flake.z + 1.5F + 1.17F * std::floor(lives), 3.0F) - 1.5F;
                    flake.w = lives - std::floor(lives) > 0.95F ? -1.0F : 0.0F;
                }
                cloud.particles.push_back(flake);
            }
            cloud.upload();
            const glm::vec3 eye = 5.0F * glm::vec3(std::sin(0.2F * time), 0.3F, std::cos(0.2F * time));
            update(cloud, DepthSorter::passesPerFrame(kCount, frames), eye);
            if (frame < 2 * frames || frame % 3 != 0) {  // from the third sequence on
                continue;
            }
            const auto distance = [&](std::uint32_t i) {
                return glm::distance(glm::dvec3(cloud.particles[i]), glm::dvec3(eye));
            };
            std::vector<double> by_order;
            std::vector<double> by_index;
            for (const Element& element : readOrder(*sorter_)) {
                if (element.key != 0) {
                    by_order.push_back(distance(element.index));
                }
            }
            for (std::uint32_t i = 0; i < kCount; ++i) {
                if (cloud.particles[i].w >= 0.0F) {
                    by_index.push_back(distance(i));
                }
            }
            ASSERT_EQ(by_order.size(), by_index.size());
            sorted.add(by_order, measured);
            unsorted.add(by_index, measured);
        }
        EXPECT_NEAR(unsorted.adjacent, 0.5, 0.02);
        EXPECT_LT(sorted.adjacent, (exact() ? 0.01 : 0.95 * unsorted.adjacent));
        EXPECT_LT(sorted.depth_error, exact() ? 1e-6 : c.most * unsorted.depth_error);
    }
}

RELIEF_INSTANTIATE_STEP_TESTS(DepthSortGlTest);
INSTANTIATE_TEST_SUITE_P(Gles31, DepthSortGlTest,
                         testing::Values(StepCase{GlApi::kGles30, StepPath::kCompute}), stepTestName);
INSTANTIATE_TEST_SUITE_P(Fragments, DepthSortNetworkGlTest,
                         testing::Values(StepCase{GlApi::kGl33Core, StepPath::kFragment},
                                         StepCase{GlApi::kGles30, StepPath::kFragment}),
                         stepTestName);
RELIEF_INSTANTIATE_STEP_TESTS(DepthSortMotionGlTest);

}  // namespace
}  // namespace relief
