#include "runtime/particles/event_list.h"

#include <algorithm>
#include <string>

#include "runtime/gl/buffer_read.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "shaders/shader_constants.h"

namespace relief {
namespace {

// Texture units.
constexpr int kWayUnit = 0;
constexpr int kSurfaceUnit = 1;
constexpr int kBeforeUnit = 2;
constexpr int kBirthUnit = 3;
constexpr int kCountUnit = 4;  // and those of the further levels

constexpr std::size_t kFloats = 4;              // of a texel
constexpr GLuint64 kPatience = 10'000'000'000;  // nanoseconds
constexpr std::uint32_t kMostMax = 1U << 24;
constexpr auto kWidth = static_cast<std::uint32_t>(kEventsWidth);

std::uint32_t reduced(std::uint32_t count) {
    return (count + kEventsCounted - 1) / kEventsCounted;
}

std::uint32_t rowsOf(std::uint32_t count) {
    return (count + kWidth - 1) / kWidth;
}

GlTexture makeTexture(GLenum format, std::uint32_t width, std::uint32_t height) {
    return makeTexture2D(format, static_cast<GLsizei>(width), static_cast<GLsizei>(height),
                         format == GL_R32F ? GL_RED : GL_RGBA, GL_FLOAT);
}

void draw(const GlFramebuffer& target, std::uint32_t width, std::uint32_t height) {
    glBindFramebuffer(GL_FRAMEBUFFER, target.name());
    glViewport(0, 0, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

/// Over the texels of `count` entries.
void drawEntries(const GlFramebuffer& target, std::uint32_t count) {
    draw(target, std::min(count, kWidth), rowsOf(count));
}

}  // namespace

Result<EventList> EventList::create(const EventOptions& options, std::uint32_t capacity) {
    if (options.most == 0 || options.most > kMostMax || !(options.min_speed >= 0.0F)) {
        return fail(ErrorCode::kUsage, "a list of events needs room for 1 to " + std::to_string(kMostMax) +
                                           " of them, and a least speed of at least 0");
    }
    static_assert(kLevels == kEventLevels);
    EventList list;
    list.options_ = options;
    list.options_.most = std::min(options.most, capacity);
    RELIEF_TRY(checkTextureSize(kWidth, rowsOf(std::max(list.options_.most, reduced(capacity))),
                                "a list of " + std::to_string(list.options_.most) + " events",
                                "choose a shorter one"));
    RELIEF_TRY(list.createTextures(capacity));
    RELIEF_TRY(list.createPrograms());
    return list;
}

std::uint32_t EventList::listWidth() const {
    return std::min(options_.most, kWidth);
}

Result<void> EventList::createTextures(std::uint32_t capacity) {
    forgetGlErrors();
    no_attributes_ = makeVertexArray();
    std::uint32_t count = capacity;
    for (Level& level : counts_) {
        count = reduced(count);
        level.texture = makeTexture(GL_R32F, std::min(count, kWidth), rowsOf(count));
    }
    std::array<GLuint, 4> names{};
    for (std::size_t i = 0; i < list_.size(); ++i) {
        list_[i] = makeTexture(GL_RGBA32F, listWidth(), rowsOf(options_.most));
        names[i] = list_[i].name();
    }
    for (Slot& slot : slots_) {
        slot.buffer = makeBuffer();
    }
    RELIEF_TRY(
        checkAllocated("a list of " + std::to_string(options_.most) + " events", "choose a shorter one"));
    for (Level& level : counts_) {
        const GLuint name = level.texture.name();
        level.target = RELIEF_TRY(makeFramebuffer(std::span(&name, 1)));
    }
    list_target_ = RELIEF_TRY(makeFramebuffer(names));
    return {};
}

/// Makes the program current.
void EventList::useFilter(const GlProgram& program) const {
    glUseProgram(program.name());
    glUniform1f(uniformLocation(program, "u_min_speed"), options_.min_speed);
    glUniform3i(uniformLocation(program, "u_event_kinds"), options_.hits ? 1 : 0, options_.lasting ? 1 : 0,
                options_.deaths ? 1 : 0);
}

Result<void> EventList::createPrograms() {
    const std::string defines = "#define RELIEF_TYPES " + std::to_string(kParticleTypesMax) + "\n";
    count_program_ = RELIEF_TRY(makeProgram("quad.vert", "event_count.frag"));
    sum_program_ = RELIEF_TRY(makeProgram("quad.vert", "event_sum.frag"));
    list_program_ = RELIEF_TRY(makeProgram("quad.vert", "event_list.frag", defines));
    count_particles_ = uniformLocation(count_program_, "u_particles");
    sum_count_ = uniformLocation(sum_program_, "u_count");
    list_width_ = uniformLocation(list_program_, "u_width");
    list_radius_ = uniformLocation(list_program_, "u_radius");
    const auto sampler = [](const GlProgram& program, const char* name, int unit) {
        glUniform1i(uniformLocation(program, name), unit);
    };
    glUseProgram(sum_program_.name());
    sampler(sum_program_, "u_counts", kCountUnit);
    useFilter(count_program_);
    sampler(count_program_, "u_event_surface", kSurfaceUnit);
    useFilter(list_program_);
    sampler(list_program_, "u_event_surface", kSurfaceUnit);
    sampler(list_program_, "u_event_way", kWayUnit);
    sampler(list_program_, "u_position_before", kBeforeUnit);
    sampler(list_program_, "u_birth", kBirthUnit);
    sampler(list_program_, "u_count_1", kCountUnit);
    sampler(list_program_, "u_count_2", kCountUnit + 1);
    sampler(list_program_, "u_count_3", kCountUnit + 2);
    sampler(list_program_, "u_count_4", kCountUnit + 3);
    return {};
}

bool EventList::request(const Step& step) {
    if (in_flight_ == kInFlightMax) {
        return false;
    }
    Slot& slot = slots_[static_cast<std::size_t>((oldest_ + in_flight_) % kInFlightMax)];
    ++in_flight_;
    slot.tag = step.tag;
    slot.number = step.number;
    slot.begin = step.begin;
    slot.end = step.end;
    slot.rows = rowsOf(std::min(options_.most, step.extent));
    glBindVertexArray(no_attributes_.name());
    if (slot.rows == 0) {  // what is on the GPU says so, too
        const std::array<float, 4> zero{};
        glBindFramebuffer(GL_FRAMEBUFFER, counts_.back().target.name());
        glClearBufferfv(GL_COLOR, 0, zero.data());
        return true;
    }
    count(step);
    makeList(step, slot.rows);
    readInto(slot);
    slot.fence.insert();
    return true;
}

void EventList::count(const Step& step) const {
    glUseProgram(count_program_.name());
    glUniform2i(count_particles_, static_cast<GLint>(step.width), static_cast<GLint>(step.extent));
    useTexture(kSurfaceUnit, step.surface);
    std::uint32_t count = reduced(step.extent);
    drawEntries(counts_.front().target, count);
    glUseProgram(sum_program_.name());
    for (std::size_t i = 1; i < counts_.size(); ++i) {
        glUniform1i(sum_count_, static_cast<GLint>(count));
        useTexture(kCountUnit, counts_[i - 1].texture);
        count = reduced(count);
        drawEntries(counts_[i].target, count);
    }
}

void EventList::makeList(const Step& step, std::uint32_t rows) const {
    glUseProgram(list_program_.name());
    glUniform1i(list_width_, static_cast<GLint>(step.width));
    std::array<float, kParticleTypesMax> radius{};
    for (std::size_t i = 0; i < radius.size(); ++i) {
        radius[i] = step.types[std::min(i, step.types.size() - 1)].radius;
    }
    glUniform1fv(list_radius_, static_cast<GLsizei>(radius.size()), radius.data());
    useTexture(kWayUnit, step.way);
    useTexture(kSurfaceUnit, step.surface);
    useTexture(kBeforeUnit, step.position_before);
    useTexture(kBirthUnit, step.birth);
    for (std::size_t i = 0; i < counts_.size(); ++i) {
        useTexture(kCountUnit + static_cast<int>(i), counts_[i].texture);
    }
    draw(list_target_, listWidth(), rows);
}

void EventList::readInto(Slot& slot) const {
    const auto width = static_cast<GLsizei>(listWidth());
    const auto rows = static_cast<GLsizei>(slot.rows);
    const std::size_t plane = kFloats * sizeof(float) * listWidth() * slot.rows;
    glBindBuffer(GL_PIXEL_PACK_BUFFER, slot.buffer.name());
    glBufferData(GL_PIXEL_PACK_BUFFER,
                 static_cast<GLsizeiptr>(list_.size() * plane + kFloats * sizeof(float)), nullptr,
                 GL_STREAM_READ);
    for (std::size_t i = 0; i < list_.size(); ++i) {
        glReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
        glReadPixels(0, 0, width, rows, GL_RGBA, GL_FLOAT, reinterpret_cast<void*>(i * plane));
    }
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glBindFramebuffer(GL_FRAMEBUFFER, counts_.back().target.name());
    glReadPixels(0, 0, 1, 1, GL_RGBA, GL_FLOAT, reinterpret_cast<void*>(list_.size() * plane));
}

std::optional<std::uint64_t> EventList::oldestNumber() const {
    return in_flight_ == 0 ? std::nullopt : std::optional(slots_[static_cast<std::size_t>(oldest_)].number);
}

std::optional<EventList::Collected> EventList::poll() {
    if (in_flight_ == 0) {
        return std::nullopt;
    }
    const Slot& slot = slots_[static_cast<std::size_t>(oldest_)];
    return slot.rows == 0 || slot.fence.passed() ? collect() : std::nullopt;
}

Result<std::optional<EventList::Collected>> EventList::wait() {
    if (in_flight_ == 0) {
        return std::optional<Collected>();
    }
    const Slot& slot = slots_[static_cast<std::size_t>(oldest_)];
    if (slot.rows > 0 && !waitToRead(slot.fence, kPatience)) {
        RELIEF_TRY(checkGpu("listing events"));
        return fail(ErrorCode::kFailure, "the GPU has not finished its list of events within ten seconds");
    }
    auto collected = collect();
    RELIEF_TRY(checkGpu("listing events"));
    if (!collected) {
        return fail(ErrorCode::kFailure,
                    "the GPU's list of events cannot be read; choose a smaller capacity");
    }
    return collected;
}

std::optional<EventList::Collected> EventList::collect() {
    Slot& slot = slots_[static_cast<std::size_t>(oldest_)];
    oldest_ = (oldest_ + 1) % kInFlightMax;
    --in_flight_;
    std::vector<float> values(slot.rows == 0 ? 0 : kFloats * (4 * std::size_t{listWidth()} * slot.rows + 1));
    if (slot.rows > 0) {
        slot.fence.remove();
        if (!readBuffer(slot.buffer, std::as_writable_bytes(std::span(values)))) {
            return std::nullopt;
        }
    }
    return decoded(slot, values);
}

EventList::Collected EventList::decoded(const Slot& slot, const std::vector<float>& values) const {
    Collected collected;
    collected.number = slot.number;
    collected.events.tag = slot.tag;
    collected.events.time = slot.end;
    if (slot.rows == 0) {
        return collected;
    }
    const std::size_t plane = kFloats * listWidth() * slot.rows;
    const auto total = static_cast<std::uint32_t>(values[4 * plane]);
    const std::uint32_t listed = std::min(total, options_.most);
    collected.events.dropped = total - listed;
    collected.events.events.reserve(listed);
    for (std::size_t i = 0; i < listed; ++i) {
        const float* place = &values[kFloats * i];
        const float* surface = place + plane;
        const float* way = surface + plane;
        const float* who = way + plane;
        const int flags = static_cast<int>(who[3]);
        ParticleEvent& event = collected.events.events.emplace_back();
        event.index = static_cast<std::uint32_t>(who[0]);
        event.id = static_cast<std::uint32_t>(who[1]);
        event.type = static_cast<std::uint32_t>(who[2]);
        event.time = slot.begin + static_cast<double>(place[3]);
        event.position = {place[0], place[1], place[2]};
        event.velocity = {way[0], way[1], way[2]};
        event.hit = (flags & kEventCollision) != 0;
        event.lasts = (flags & kEventLasts) != 0;
        event.death = (flags & kEventDeath) != 0;
        event.normal = {surface[0], surface[1], surface[2]};
        event.speed = surface[3];
        event.body = static_cast<int>(way[3]);
    }
    return collected;
}

}  // namespace relief
