#include "runtime/particles/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>

#include "runtime/gl/buffer_read.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

constexpr int kCountsUnit = 0;  // positions in the first pass
constexpr int kSumsUnit = 1;    // velocities
constexpr int kBirthUnit = 2;

constexpr GLsizeiptr kTexelBytes = 4 * sizeof(float);
constexpr GLuint64 kPatience = 10'000'000'000;  // nanoseconds

/// Texels after a pass over so many.
std::uint32_t reduced(std::uint32_t side) {
    return (side + kReducedSide - 1) / kReducedSide;
}

}  // namespace

Result<Statistics> Statistics::create(std::uint32_t capacity, StepPath path) {
    RELIEF_TRY(checkContext());
    if (capacity == 0 || capacity > ParticleSystem::kCapacityMax) {
        return fail(ErrorCode::kUsage, "statistics of " + std::to_string(capacity) +
                                           " particles are not possible; choose 1 to " +
                                           std::to_string(ParticleSystem::kCapacityMax));
    }
    const StepPath chosen = RELIEF_TRY(chosenPath(path));
    const PassState state;
    forgetGlErrors();
    Statistics statistics;
    statistics.capacity_ = capacity;
    for (Slot& slot : statistics.slots_) {
        slot.buffer = makeBuffer();
        glBindBuffer(GL_PIXEL_PACK_BUFFER, slot.buffer.name());
        glBufferData(GL_PIXEL_PACK_BUFFER, StateSums::kBytes, nullptr, GL_STREAM_READ);
    }
    RELIEF_TRY(checkAllocated("the statistics' buffers", "choose a smaller capacity"));
    if (chosen == StepPath::kCompute) {
        statistics.compute_ = RELIEF_TRY(StateSums::create(capacity));
    } else {
        RELIEF_TRY(statistics.createLadder());
    }
    return statistics;
}

Result<void> Statistics::createLadder() {
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
        const std::array<GLuint, 2> textures{level.counts.name(), level.sums.name()};
        level.target = RELIEF_TRY(makeFramebuffer(textures));
        levels_.push_back(std::move(level));
    } while (width > 1 || height > 1);
    no_attributes_ = makeVertexArray();

    state_program_ = RELIEF_TRY(makeProgram("quad.vert", "reduce_state.frag"));
    sum_program_ = RELIEF_TRY(makeProgram("quad.vert", "reduce_sum.frag"));
    glUseProgram(state_program_.name());
    glUniform1i(uniformLocation(state_program_, "u_position"), kCountsUnit);
    glUniform1i(uniformLocation(state_program_, "u_velocity"), kSumsUnit);
    glUniform1i(uniformLocation(state_program_, "u_birth"), kBirthUnit);
    state_size_ = uniformLocation(state_program_, "u_size");
    state_rate_ = uniformLocation(state_program_, "u_rate_before");
    state_extent_ = uniformLocation(state_program_, "u_extent");
    glUseProgram(sum_program_.name());
    glUniform1i(uniformLocation(sum_program_, "u_counts"), kCountsUnit);
    glUniform1i(uniformLocation(sum_program_, "u_sums"), kSumsUnit);
    sum_size_ = uniformLocation(sum_program_, "u_size");
    return {};
}

bool Statistics::request(const ParticleSystem& particles, std::uint64_t tag) {
    if (in_flight_ == kInFlightMax || particles.capacity() > capacity_) {
        return false;
    }
    Slot& slot = slots_[static_cast<std::size_t>((oldest_ + in_flight_) % kInFlightMax)];
    ++in_flight_;
    slot.tag = tag;
    slot.empty = particles.extent() == 0;
    if (slot.empty) {
        return true;
    }
    const PassState state;
    if (compute_) {
        compute_->sum(particles, slot.buffer);
    } else {
        sumByLadder(particles, slot.buffer);
    }
    slot.fence.insert();
    return true;
}

void Statistics::sumByLadder(const ParticleSystem& particles, const GlBuffer& result) const {
    std::uint32_t width = particles.textureWidth();
    std::uint32_t height = (particles.extent() + width - 1) / width;
    glUseProgram(state_program_.name());
    glUniform1i(state_extent_, static_cast<GLint>(particles.extent()));
    glUniform2i(state_size_, static_cast<GLint>(width), static_cast<GLint>(height));
    useTexture(kCountsUnit, particles.positions());
    useTexture(kSumsUnit, particles.secondState());
    useTexture(kBirthUnit, particles.births());
    glUniform1f(state_rate_, particles.rateBefore());
    glBindVertexArray(no_attributes_.name());
    // Only the rows that hold particles: with few of them the single texel is reached early.
    for (std::size_t i = 0;; ++i) {
        width = reduced(width);
        height = reduced(height);
        glBindFramebuffer(GL_FRAMEBUFFER, levels_[i].target.name());
        glViewport(0, 0, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
        glDrawArrays(GL_TRIANGLES, 0, 3);
        if (width == 1 && height == 1) {
            break;
        }
        glUseProgram(sum_program_.name());
        glUniform2i(sum_size_, static_cast<GLint>(width), static_cast<GLint>(height));
        useTexture(kCountsUnit, levels_[i].counts);
        useTexture(kSumsUnit, levels_[i].sums);
    }
    glBindBuffer(GL_PIXEL_PACK_BUFFER, result.name());
    for (GLenum i = 0; i < 2; ++i) {
        glReadBuffer(GL_COLOR_ATTACHMENT0 + i);
        glReadPixels(0, 0, 1, 1, GL_RGBA, GL_FLOAT, reinterpret_cast<void*>(i * kTexelBytes));
    }
}

std::optional<StatisticsSample> Statistics::poll() {
    if (in_flight_ == 0) {
        return std::nullopt;
    }
    const Slot& slot = slots_[static_cast<std::size_t>(oldest_)];
    return slot.empty || slot.fence.passed() ? collect() : std::nullopt;
}

Result<std::optional<StatisticsSample>> Statistics::wait() {
    if (in_flight_ == 0) {
        return std::optional<StatisticsSample>();
    }
    const Slot& slot = slots_[static_cast<std::size_t>(oldest_)];
    if (!slot.empty && !slot.fence.passed(kPatience)) {
        RELIEF_TRY(checkGpu("making statistics"));
        return fail(ErrorCode::kFailure, "the GPU has not finished its statistics within ten seconds");
    }
    auto sample = collect();
    RELIEF_TRY(checkGpu("making statistics"));
    if (!sample) {
        return fail(ErrorCode::kFailure, "the GPU's statistics cannot be read");
    }
    return sample;
}

std::optional<StatisticsSample> Statistics::collect() {
    Slot& slot = slots_[static_cast<std::size_t>(oldest_)];
    oldest_ = (oldest_ + 1) % kInFlightMax;
    --in_flight_;
    StatisticsSample sample;
    sample.tag = slot.tag;
    if (slot.empty) {
        return sample;
    }
    slot.fence.remove();
    std::array<float, 8> values{};
    static_assert(sizeof(values) == StateSums::kBytes);
    if (!readBuffer(slot.buffer, std::as_writable_bytes(std::span(values)))) {
        return std::nullopt;
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

}  // namespace relief
