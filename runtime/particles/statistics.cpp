#include "runtime/particles/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <string>

#include "runtime/gl/buffer_read.h"
#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

constexpr int kCountsUnit = 0;  // positions in the first pass
constexpr int kSumsUnit = 1;    // velocities
constexpr int kBirthUnit = 2;

constexpr GLsizeiptr kTexelBytes = 4 * sizeof(float);
constexpr GLsizeiptr kBytes = 2 * kTexelBytes;  // of a sample: shaders/particles/reduce.glsl has its parts
constexpr GLuint64 kPatience = 10'000'000'000;  // nanoseconds

// Storage units of reduce.glsl, and texels a side that a work group sums.
constexpr GLuint kReducedUnit = 0;
constexpr GLuint kReducingUnit = 1;
constexpr std::uint32_t kGroupSide = kReducedSide * kReducedGroup;

/// Texels after a pass that sums squares of `square` a side over so many.
std::uint32_t reduced(std::uint32_t side, std::uint32_t square) {
    return (side + square - 1) / square;
}

}  // namespace

Result<Statistics> Statistics::create(std::uint32_t capacity, StepPath path) {
    RELIEF_TRY(checkContext());
    if (capacity == 0 || capacity > ParticleSystem::kCapacityMax) {
        return fail(ErrorCode::kUsage, "statistics of " + std::to_string(capacity) +
                                           " particles are not possible; choose 1 to " +
                                           std::to_string(ParticleSystem::kCapacityMax));
    }
    Statistics statistics;
    statistics.path_ = RELIEF_TRY(chosenPath(path));
    const PassState state;
    forgetGlErrors();
    statistics.capacity_ = capacity;
    for (Slot& slot : statistics.slots_) {
        slot.buffer = makeBuffer();
        glBindBuffer(GL_PIXEL_PACK_BUFFER, slot.buffer.name());
        glBufferData(GL_PIXEL_PACK_BUFFER, kBytes, nullptr, GL_STREAM_READ);
    }
    RELIEF_TRY(checkAllocated("the statistics' buffers", "choose a smaller capacity"));
    RELIEF_TRY(statistics.path_ == StepPath::kCompute ? statistics.createParts() : statistics.createLadder());
    RELIEF_TRY(statistics.createPrograms());
    return statistics;
}

Result<void> Statistics::createPrograms() {
    const auto make = path_ == StepPath::kCompute ? makeComputeProgram : makeScreenProgram;
    state_program_ = RELIEF_TRY(make("particles/reduce_state.frag", {}));
    sum_program_ = RELIEF_TRY(make("particles/reduce_sum.frag", {}));
    state_program_.use();
    state_program_.set("u_position", kCountsUnit);
    state_program_.set("u_velocity", kSumsUnit);
    state_program_.set("u_birth", kBirthUnit);
    sum_program_.use();
    sum_program_.set("u_counts", kCountsUnit);
    sum_program_.set("u_sums", kSumsUnit);
    return {};
}

Result<void> Statistics::createParts() {
    const StorageUnits storage;
    const std::uint32_t width = std::min(capacity_, ParticleSystem::kStateWidth);
    const std::uint32_t parts =
        reduced(width, kGroupSide) * reduced((capacity_ + width - 1) / width, kGroupSide);
    for (GlBuffer& buffer : parts_) {
        buffer = StorageUnits::make(static_cast<GLsizeiptr>(parts) * kBytes);
        RELIEF_TRY(checkAllocated("the statistics of " + std::to_string(capacity_) + " particles",
                                  "choose a smaller capacity"));
    }
    return {};
}

Result<void> Statistics::createLadder() {
    std::uint32_t width = std::min(capacity_, ParticleSystem::kStateWidth);
    std::uint32_t height = (capacity_ + width - 1) / width;
    do {
        width = reduced(width, kReducedSide);
        height = reduced(height, kReducedSide);
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
    const std::uint32_t width = particles.textureWidth();
    const std::uint32_t height = (particles.extent() + width - 1) / width;
    state_program_.use();
    state_program_.set("u_extent", static_cast<GLint>(particles.extent()));
    state_program_.set("u_size", glm::ivec2(width, height));
    state_program_.set("u_rate_before", particles.rateBefore());
    useTexture(kCountsUnit, particles.positions());
    useTexture(kSumsUnit, particles.secondState());
    useTexture(kBirthUnit, particles.births());
    if (path_ == StepPath::kCompute) {
        sumByGroups(width, height, slot.buffer);
    } else {
        sumByLadder(width, height, slot.buffer);
    }
    slot.fence.insert();
    return true;
}

void Statistics::sumByGroups(std::uint32_t width, std::uint32_t height, const GlBuffer& result) const {
    const StorageUnits storage;
    for (int pass = 0;; ++pass) {
        width = reduced(width, kGroupSide);
        height = reduced(height, kGroupSide);
        const bool last = width == 1 && height == 1;
        StorageUnits::bind(kReducingUnit, parts_[pass % 2]);
        StorageUnits::bind(kReducedUnit, last ? result : parts_[1 - pass % 2]);
        StorageUnits::order();
        glDispatchCompute(width, height, 1);
        if (last) {
            break;
        }
        sum_program_.use();
        sum_program_.set("u_size", glm::ivec2(width, height));
    }
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);  // that the buffer may be mapped
}

void Statistics::sumByLadder(std::uint32_t width, std::uint32_t height, const GlBuffer& result) const {
    // Only the rows that hold particles: with few of them the single texel is reached early.
    for (std::size_t i = 0;; ++i) {
        width = reduced(width, kReducedSide);
        height = reduced(height, kReducedSide);
        (i == 0 ? state_program_ : sum_program_)
            .drawScreen(levels_[i].target.name(), static_cast<GLsizei>(width), static_cast<GLsizei>(height));
        if (width == 1 && height == 1) {
            break;
        }
        sum_program_.use();
        sum_program_.set("u_size", glm::ivec2(width, height));
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
    static_assert(sizeof(values) == kBytes);
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
