#include "runtime/particles/event_list.h"

#include <algorithm>
#include <glm/glm.hpp>
#include <string>

#include "runtime/gl/buffer_read.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "shaders/particles/constants.h"

namespace relief {
namespace {

// Texture units.
constexpr int kVelocityUnit = 0;
constexpr int kSurfaceUnit = 1;
constexpr int kBeforeUnit = 2;
constexpr int kBirthUnit = 3;
constexpr int kCountUnit = 4;  // and those of the further levels

constexpr std::size_t kFloats = 4;  // of a texel
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

/// Over the texels of `count` entries.
void drawEntries(const GlProgram& program, const GlFramebuffer& target, std::uint32_t count) {
    program.drawScreen(target.name(), static_cast<GLsizei>(std::min(count, kWidth)),
                       static_cast<GLsizei>(rowsOf(count)));
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
    RELIEF_TRY(
        checkAllocated("a list of " + std::to_string(options_.most) + " events", "choose a shorter one"));
    for (Level& level : counts_) {
        level.target = RELIEF_TRY(makeFramebuffer({level.texture.name()}));
    }
    list_target_ = RELIEF_TRY(makeFramebuffer(names));
    return {};
}

/// Makes the program current.
void EventList::useFilter(const GlProgram& program) const {
    program.use();
    program.set("u_min_speed", options_.min_speed);
    program.set("u_event_kinds", glm::ivec3(options_.hits, options_.lasting, options_.deaths));
    program.set("u_event_type", options_.type ? static_cast<GLint>(*options_.type) : -1);
    program.set("u_event_material", options_.material ? *options_.material + 1 : -1);
}

Result<void> EventList::createPrograms() {
    const std::string defines = "#define RELIEF_TYPES " + std::to_string(kParticleTypesMax) + "\n";
    count_program_ = RELIEF_TRY(makeScreenProgram("particles/event_count.frag"));
    sum_program_ = RELIEF_TRY(makeScreenProgram("particles/event_count.frag", "#define RELIEF_EVENT_SUMS\n"));
    list_program_ = RELIEF_TRY(makeScreenProgram("particles/event_list.frag", defines));
    sum_program_.use();
    sum_program_.set("u_counts", kCountUnit);
    sum_program_.set("u_width", kEventsWidth);
    for (const GlProgram* program : {&count_program_, &list_program_}) {
        useFilter(*program);
        program->set("u_event_surface", kSurfaceUnit);
        program->set("u_birth", kBirthUnit);
    }
    list_program_.set("u_event_velocity", kVelocityUnit);
    list_program_.set("u_position_before", kBeforeUnit);
    for (int level = 0; level < kEventLevels; ++level) {
        list_program_.set(("u_count_" + std::to_string(level + 1)).c_str(), kCountUnit + level);
    }
    return {};
}

bool EventList::request(const Step& step) {
    if (in_flight_ == kInFlightMax) {
        return false;
    }
    const std::uint32_t rows = rowsOf(std::min(options_.most, step.extent));
    Request& request = requests_[(oldest_ + static_cast<std::size_t>(in_flight_++)) % kInFlightMax];
    request.tag = step.tag;
    request.number = step.number;
    request.begin = step.begin;
    request.end = step.end;
    request.floats = rows == 0 ? 0 : kFloats * (list_.size() * listWidth() * rows + 1);
    if (rows == 0) {  // the list on the GPU becomes empty, too
        const std::array<float, 4> zero{};
        glBindFramebuffer(GL_FRAMEBUFFER, counts_.back().target.name());
        glClearBufferfv(GL_COLOR, 0, zero.data());
        return true;
    }
    bindPackBuffer(request.buffer, static_cast<GLsizeiptr>(request.floats * sizeof(float)));
    count(step);
    makeList(step, rows);
    read(rows);
    request.fence.insert();
    return true;
}

void EventList::count(const Step& step) const {
    count_program_.use();
    count_program_.set("u_width", static_cast<GLint>(step.width));
    count_program_.set("u_count", static_cast<GLint>(step.extent));
    count_program_.set("u_materials", static_cast<GLint>(step.materials + 1));
    useTexture(kSurfaceUnit, step.surface);
    useTexture(kBirthUnit, step.birth);
    std::uint32_t count = reduced(step.extent);
    drawEntries(count_program_, counts_.front().target, count);
    sum_program_.use();
    for (std::size_t i = 1; i < counts_.size(); ++i) {
        sum_program_.set("u_count", static_cast<GLint>(count));
        useTexture(kCountUnit, counts_[i - 1].texture);
        count = reduced(count);
        drawEntries(sum_program_, counts_[i].target, count);
    }
}

void EventList::makeList(const Step& step, std::uint32_t rows) const {
    list_program_.use();
    list_program_.set("u_width", static_cast<GLint>(step.width));
    list_program_.set("u_materials", static_cast<GLint>(step.materials + 1));
    std::array<float, kParticleTypesMax> radius{};
    for (std::size_t i = 0; i < radius.size(); ++i) {
        radius[i] = step.types[std::min(i, step.types.size() - 1)].radius;
    }
    list_program_.set("u_radius", radius);
    useTexture(kVelocityUnit, step.velocity);
    useTexture(kSurfaceUnit, step.surface);
    useTexture(kBeforeUnit, step.position_before);
    useTexture(kBirthUnit, step.birth);
    for (std::size_t i = 0; i < counts_.size(); ++i) {
        useTexture(kCountUnit + static_cast<int>(i), counts_[i].texture);
    }
    list_program_.drawScreen(list_target_.name(), static_cast<GLsizei>(listWidth()),
                             static_cast<GLsizei>(rows));
}

void EventList::read(std::uint32_t rows) const {
    const std::size_t plane = kFloats * sizeof(float) * listWidth() * rows;
    for (std::size_t i = 0; i < list_.size(); ++i) {
        glReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(i));
        glReadPixels(0, 0, static_cast<GLsizei>(listWidth()), static_cast<GLsizei>(rows), GL_RGBA, GL_FLOAT,
                     reinterpret_cast<void*>(i * plane));
    }
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glBindFramebuffer(GL_FRAMEBUFFER, counts_.back().target.name());
    glReadPixels(0, 0, 1, 1, GL_RGBA, GL_FLOAT, reinterpret_cast<void*>(list_.size() * plane));
}

std::optional<EventList::Collected> EventList::poll() {
    const Request& oldest = requests_[oldest_];
    return in_flight_ == 0 || (oldest.floats > 0 && !oldest.fence.passed()) ? std::nullopt : collect();
}

Result<std::optional<EventList::Collected>> EventList::wait() {
    if (in_flight_ == 0) {
        return std::optional<Collected>();
    }
    constexpr GLuint64 kPatience = 10'000'000'000;  // nanoseconds
    static constexpr const char* kReading = "reading the list of events";
    const Request& oldest = requests_[oldest_];
    if (oldest.floats > 0 && !waitToRead(oldest.fence, kPatience)) {
        RELIEF_TRY(checkGpu(kReading));
        return fail(ErrorCode::kFailure, "the GPU has not finished the list of events within ten seconds");
    }
    auto collected = collect();
    RELIEF_TRY(checkGpu(kReading));
    if (!collected) {
        return fail(ErrorCode::kFailure,
                    "the list of events cannot be read from the GPU; choose a smaller capacity");
    }
    return collected;
}

std::optional<EventList::Collected> EventList::collect() {
    Request& request = requests_[oldest_];
    oldest_ = (oldest_ + 1) % kInFlightMax;
    --in_flight_;
    std::array<float, kFloats> total{};
    if (request.floats > 0) {
        request.fence.remove();
        if (!readFloats(request, request.floats - kFloats, total)) {
            return std::nullopt;
        }
    }
    // Of the list, which is as long as it may ever be, the events alone: the rest would take milliseconds.
    const auto count = static_cast<std::uint32_t>(total[0]);
    const std::size_t listed = std::min(count, options_.most);
    const std::size_t plane = request.floats / kFloats / list_.size() * kFloats;
    std::vector<float> values(kFloats * list_.size() * listed);
    for (std::size_t i = 0; i < list_.size() && listed > 0; ++i) {
        if (!readFloats(request, i * plane,
                        std::span(values).subspan(i * kFloats * listed, kFloats * listed))) {
            return std::nullopt;
        }
    }
    return decoded(request, count, values);
}

bool EventList::readFloats(const Request& request, std::size_t first, std::span<float> out) {
    return readBuffer(request.buffer, first * sizeof(float), std::as_writable_bytes(out));
}

EventList::Collected EventList::decoded(const Request& request, std::uint32_t count,
                                        std::span<const float> values) const {
    Collected collected;
    collected.number = request.number;
    collected.events.tag = request.tag;
    collected.events.time = request.end;
    const std::size_t plane = values.size() / list_.size();
    const std::size_t listed = plane / kFloats;
    collected.events.dropped = count - static_cast<std::uint32_t>(listed);
    collected.events.events.reserve(listed);
    for (std::size_t i = 0; i < listed; ++i) {
        const float* position = &values[kFloats * i];
        const float* surface = position + plane;
        const float* velocity = surface + plane;
        const float* identity = velocity + plane;
        const int flags = static_cast<int>(identity[3]);
        ParticleEvent& event = collected.events.events.emplace_back();
        event.index = static_cast<std::uint32_t>(identity[0]);
        event.id = static_cast<std::uint32_t>(identity[1]);
        event.type = static_cast<std::uint32_t>(identity[2]);
        event.time = request.begin + static_cast<double>(position[3]);
        event.position = {position[0], position[1], position[2]};
        event.velocity = {velocity[0], velocity[1], velocity[2]};
        event.hit = (flags & kEventCollision) != 0;
        event.lasts = (flags & kEventLasts) != 0;
        event.death = (flags & kEventDeath) != 0;
        event.normal = {surface[0], surface[1], surface[2]};
        event.speed = surface[3];
        event.body = static_cast<int>(velocity[3]);
        event.material = flags / kEventFlags - 1;
    }
    return collected;
}

}  // namespace relief
