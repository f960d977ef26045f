#include "runtime/particles/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <string>

#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

constexpr int kCountsUnit = 0;  // positions in the first pass
constexpr int kSumsUnit = 1;    // velocities
constexpr int kBirthUnit = 2;

/// Texels of a side after a pass.
std::uint32_t reduced(std::uint32_t side) {
    return (side + kReducedSide - 1) / kReducedSide;
}

StatisticsSample sampleOf(std::uint64_t tag, const std::vector<float>& values) {
    StatisticsSample sample;
    sample.tag = tag;
    if (values.empty()) {
        return sample;
    }
    sample.alive = static_cast<std::uint32_t>(values[0]);
    sample.in_contact = static_cast<std::uint32_t>(values[1] + values[2]);
    sample.caught = static_cast<std::uint32_t>(values[2]);
    sample.energy = static_cast<double>(values[3]);
    sample.collisions =
        static_cast<std::uint64_t>(values[4]) + kCollisionsHigh * static_cast<std::uint64_t>(values[5]);
    sample.max_speed = std::sqrt(values[6]);
    if (values[7] > 0.0F) {
        sample.lost_type = static_cast<std::uint32_t>(kTypeCodes - values[7]);
    }
    return sample;
}

}  // namespace

Result<Statistics> Statistics::create(std::uint32_t capacity) {
    RELIEF_TRY(checkContext());
    if (capacity == 0 || capacity > ParticleSystem::kCapacityMax) {
        return fail(ErrorCode::kUsage, "statistics of " + std::to_string(capacity) +
                                           " particles are not possible; choose 1 to " +
                                           std::to_string(ParticleSystem::kCapacityMax));
    }
    const PassState state;
    forgetGlErrors();
    Statistics statistics;
    statistics.capacity_ = capacity;
    RELIEF_TRY(statistics.createLevels());
    RELIEF_TRY(statistics.createPrograms());
    return statistics;
}

Result<void> Statistics::createPrograms() {
    state_program_ = RELIEF_TRY(makeScreenProgram("particles/reduce_state.frag"));
    sum_program_ = RELIEF_TRY(makeScreenProgram("particles/reduce_sum.frag"));
    state_program_.use();
    state_program_.set("u_position", kCountsUnit);
    state_program_.set("u_velocity", kSumsUnit);
    state_program_.set("u_birth", kBirthUnit);
    sum_program_.use();
    sum_program_.set("u_counts", kCountsUnit);
    sum_program_.set("u_sums", kSumsUnit);
    return {};
}

Result<void> Statistics::createLevels() {
    std::uint32_t width = std::min(capacity_, ParticleSystem::kStateWidth);
    std::uint32_t height = (capacity_ + width - 1) / width;
    do {
        width = reduced(width);
        height = reduced(height);
        const auto make = [&] {
            return makeTexture2D(GL_RGBA32F, static_cast<GLsizei>(width), static_cast<GLsizei>(height),
                                 GL_RGBA, GL_FLOAT);
        };
        Level level{make(), make(), {}};
        RELIEF_TRY(checkAllocated("the statistics of " + std::to_string(capacity_) + " particles",
                                  "choose a smaller capacity"));
        level.target = RELIEF_TRY(makeFramebuffer({level.counts.name(), level.sums.name()}));
        levels_.push_back(std::move(level));
    } while (width > 1 || height > 1);
    return {};
}

bool Statistics::request(const ParticleSystem& particles, std::uint64_t tag) {
    if (readbacks_.full() || particles.capacity() > capacity_) {
        return false;
    }
    const PassState state;
    readbacks_.request(tag, particles.extent() == 0 ? 0 : 8, [&] {
        const std::uint32_t width = particles.textureWidth();
        const std::uint32_t height = (particles.extent() + width - 1) / width;
        state_program_.use();
        state_program_.set("u_extent", static_cast<GLint>(particles.extent()));
        state_program_.set("u_size", glm::ivec2(width, height));
        useTexture(kCountsUnit, particles.positions());
        useTexture(kSumsUnit, particles.velocities());
        useTexture(kBirthUnit, particles.births());
        sum(width, height);
        for (GLenum i = 0; i < 2; ++i) {
            glReadBuffer(GL_COLOR_ATTACHMENT0 + i);
            glReadPixels(0, 0, 1, 1, GL_RGBA, GL_FLOAT, reinterpret_cast<void*>(i * 4 * sizeof(float)));
        }
    });
    return true;
}

/// Leaves the target of the single texel bound.
void Statistics::sum(std::uint32_t width, std::uint32_t height) const {
    // Only the rows that hold particles: with few of them the single texel is reached early.
    for (std::size_t i = 0;; ++i) {
        width = reduced(width);
        height = reduced(height);
        (i == 0 ? state_program_ : sum_program_)
            .drawScreen(levels_[i].target.name(), static_cast<GLsizei>(width), static_cast<GLsizei>(height));
        if (width == 1 && height == 1) {
            return;
        }
        sum_program_.use();
        sum_program_.set("u_size", glm::ivec2(width, height));
        useTexture(kCountsUnit, levels_[i].counts);
        useTexture(kSumsUnit, levels_[i].sums);
    }
}

std::optional<StatisticsSample> Statistics::poll() {
    const auto done = readbacks_.poll();
    return done ? std::optional(sampleOf(done->tag, done->values)) : std::nullopt;
}

Result<std::optional<StatisticsSample>> Statistics::wait() {
    const auto done = RELIEF_TRY(readbacks_.wait("the statistics"));
    return done ? std::optional(sampleOf(done->tag, done->values)) : std::nullopt;
}

}  // namespace relief
