// What the tests of the depth sort share: clouds of particles, orders read back.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "runtime/particles/emitter.h"
#include "runtime/picture/depth_sort.h"
#include "tests/runtime/particles/step_gl_test.h"

namespace relief {

struct Element {
    std::uint32_t index = 0;
    std::uint32_t key = 0;
    friend bool operator==(const Element&, const Element&) = default;
};

/// What the shaders say, written down once more.
inline bool before(const Element& a, const Element& b) {
    return a.key != b.key ? a.key > b.key : a.index < b.index;
}

inline std::vector<Element> readOrder(const DepthSorter& sorter) {
    const PassState state;
    const std::array<GLuint, 1> textures{sorter.order().name()};
    const auto target = makeFramebuffer(textures);
    EXPECT_TRUE(target);
    const std::uint32_t width = std::min(sorter.count(), DepthSorter::kWidth);
    const std::uint32_t rows = (sorter.count() + DepthSorter::kWidth - 1) / DepthSorter::kWidth;
    std::vector<std::uint32_t> words(std::size_t{4} * width * rows);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target->name());
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, static_cast<GLsizei>(width), static_cast<GLsizei>(rows), GL_RGBA_INTEGER,
                 GL_UNSIGNED_INT, words.data());
    std::vector<Element> order(sorter.count());
    for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = {words[4 * i], words[4 * i + 1]};
    }
    return order;
}

/// Every index below count() once.
inline void expectPermutation(const std::vector<Element>& order) {
    std::vector<bool> seen(order.size());
    for (const Element& element : order) {
        ASSERT_LT(element.index, order.size());
        ASSERT_FALSE(seen[element.index]) << "index " << element.index << " twice";
        seen[element.index] = true;
    }
}

/// Particles of the test's own, as a particle system stores them.
struct Cloud {
    std::vector<glm::vec4> particles;  // w < 0: dead
    std::uint32_t width = 0;
    GlTexture texture;

    void upload() {
        const PassState state;
        width = std::min(static_cast<std::uint32_t>(particles.size()), 1024U);
        const std::size_t rows = (particles.size() + width - 1) / width;
        std::vector<glm::vec4> texels = particles;
        texels.resize(rows * width, glm::vec4(0.0F, 0.0F, 0.0F, 1.0F));  // leftovers that look alive
        texture = makeTexture2D(GL_RGBA32F, static_cast<GLsizei>(width), static_cast<GLsizei>(rows), GL_RGBA,
                                GL_FLOAT, texels.data());
    }
    [[nodiscard]] std::uint32_t extent() const { return static_cast<std::uint32_t>(particles.size()); }
};

/// Coordinates are multiples of 1/64 in [−8, 8): with an eye of the same kind every squared distance is a
/// multiple of 2^-12 below 2^11, exact in a float by any sequence of operations. One in nine is dead.
inline Cloud latticeCloud(std::uint32_t count, std::uint32_t levels, Pcg32& random) {
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

inline const glm::vec3 kEye{1.5F, -2.25F, 7.0F};

/// Index order with the keys of a lattice cloud. \param count  of the ranks.
inline std::vector<Element> latticeElements(const Cloud& cloud, std::uint32_t count) {
    std::vector<Element> elements(count);
    for (std::uint32_t i = 0; i < elements.size(); ++i) {
        elements[i].index = i;
        if (i < cloud.extent() && cloud.particles[i].w >= 0.0F) {
            const glm::vec3 away = glm::vec3(cloud.particles[i]) - kEye;
            elements[i].key = std::max(std::bit_cast<std::uint32_t>(glm::dot(away, away)), 1U);
        }
    }
    return elements;
}

inline std::vector<Element> stablySorted(const Cloud& cloud, std::uint32_t ranks) {
    std::vector<Element> sorted = latticeElements(cloud, ranks);
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const Element& a, const Element& b) { return a.key > b.key; });
    return sorted;
}

/// One sorter, of the case's path.
class DepthSorterTest : public StepGlTest {
  protected:
    static bool exact() { return GetParam().path == StepPath::kCompute; }
    /// The ranks that so many particles need.
    static std::uint32_t ranksFor(std::uint32_t extent) {
        return exact() || extent == 0 ? extent : std::bit_ceil(extent);
    }
    void make(std::uint32_t capacity) {
        auto sorter = DepthSorter::create(capacity, GetParam().path);
        ASSERT_TRUE(sorter) << sorter.error().message;
        sorter_ = std::make_unique<DepthSorter>(std::move(*sorter));
    }
    void update(const Cloud& cloud, std::uint32_t passes, const glm::vec3& eye = kEye) {
        sorter_->update(cloud.texture, cloud.width, cloud.extent(), eye, passes);
    }
    std::unique_ptr<DepthSorter> sorter_;
};

}  // namespace relief
