// SPDX-License-Identifier: Apache-2.0
#include "runtime/events/event_list.h"

#include <algorithm>
#include <string>

#include "runtime/gl/buffer_read.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "shaders/events/constants.h"

namespace relief {
namespace {

constexpr int kVelocityUnit = 0;
constexpr int kSurfaceUnit = 1;
constexpr int kBeforeUnit = 2;
constexpr int kBirthUnit = 3;
constexpr int kCountUnit = 4;  // followed by the units of the other levels

constexpr std::size_t kFloats = 4;  // per texel
constexpr std::uint32_t kEventsPerStepMax = 1U << 24;
constexpr auto kWidth = static_cast<std::uint32_t>(kEventsWidth);

std::uint32_t reduced(std::uint32_t count) {
    return (count + kEventsPerCount - 1) / kEventsPerCount;
}

std::uint32_t rowsOf(std::uint32_t count) {
    return (count + kWidth - 1) / kWidth;
}

GlTexture makeTexture(std::uint32_t width, std::uint32_t height) {
    return makeTexture2D(GL_RGBA32F, static_cast<GLsizei>(width), static_cast<GLsizei>(height), GL_RGBA,
                         GL_FLOAT);
}

/// Draws over the texels of `count` entries.
void drawEntries(const GlProgram& program, const GlFramebuffer& target, std::uint32_t count) {
    program.drawScreen(target.name(), static_cast<GLsizei>(std::min(count, kWidth)),
                       static_cast<GLsizei>(rowsOf(count)));
}

}  // namespace

Result<EventList> EventList::create(std::span<const EventOptions> lists, std::uint32_t capacity) {
    if (lists.empty() || lists.size() > kEventLists) {
        return fail(ErrorCode::kUsage,
                    "there must be 1 to " + std::to_string(kEventLists) + " lists of events");
    }
    EventList made;
    for (EventOptions options : lists) {
        if (options.max_per_step == 0 || options.max_per_step > kEventsPerStepMax ||
            !(options.min_speed >= 0.0F)) {
            return fail(ErrorCode::kUsage, "a list of events must have room for 1 to " +
                                               std::to_string(kEventsPerStepMax) +
                                               " events, and a minimum speed of at least 0");
        }
        options.max_per_step = std::min(options.max_per_step, capacity);
        made.lists_.push_back(options);
    }
    std::array<std::uint32_t, kEventLists> first_row{};
    RELIEF_TRY(checkTextureSize(kWidth, std::max(made.layOut(capacity, first_row), rowsOf(reduced(capacity))),
                                "a list of " + std::to_string(made.longest()) + " events",
                                "choose a shorter one"));
    RELIEF_TRY(made.createTextures(capacity));
    RELIEF_TRY(made.createPrograms());
    return made;
}

std::uint32_t EventList::longest() const {
    std::uint32_t most = 0;
    for (const EventOptions& list : lists_) {
        most = std::max(most, list.max_per_step);
    }
    return most;
}

std::uint32_t EventList::listWidth() const {
    return std::min(longest(), kWidth);
}

std::uint32_t EventList::layOut(std::uint32_t particles,
                                std::array<std::uint32_t, kEventLists>& first_row) const {
    constexpr std::uint32_t kNever = 1U << 30;
    first_row.fill(kNever);
    std::uint32_t rows = 0;
    for (std::size_t i = 0; i < lists_.size(); ++i) {
        first_row[i] = rows;
        rows += rowsOf(std::min(lists_[i].max_per_step, particles));
    }
    return rows;
}

Result<void> EventList::createTextures(std::uint32_t capacity) {
    clearGlErrors();
    std::uint32_t count = capacity;
    for (Level& level : counts_) {
        count = reduced(count);
        level.texture = makeTexture(std::min(count, kWidth), rowsOf(count));
    }
    std::array<std::uint32_t, kEventLists> first_row{};
    const std::uint32_t rows = layOut(capacity, first_row);
    std::array<GLuint, 4> names{};
    for (std::size_t i = 0; i < list_.size(); ++i) {
        list_[i] = makeTexture(listWidth(), rows);
        names[i] = list_[i].name();
    }
    RELIEF_TRY(checkAllocated("a list of " + std::to_string(longest()) + " events", "choose a shorter one"));
    for (Level& level : counts_) {
        level.target = RELIEF_TRY(makeFramebuffer({level.texture.name()}));
    }
    list_target_ = RELIEF_TRY(makeFramebuffer(names));
    return {};
}

/// Sets the filter uniforms; makes the program current.
void EventList::useFilter(const GlProgram& program) const {
    std::array<float, kEventLists> min_speed{};
    std::array<GLint, kEventLists> kinds{};  // missing lists select no events
    std::array<GLint, kEventLists> type{};
    std::array<GLint, kEventLists> material{};
    for (std::size_t i = 0; i < lists_.size(); ++i) {
        const EventOptions& list = lists_[i];
        min_speed[i] = list.min_speed;
        kinds[i] = (list.hits ? 1 : 0) + (list.lasting ? 2 : 0) + (list.deaths ? 4 : 0);
        type[i] = list.type ? static_cast<GLint>(*list.type) : -1;
        material[i] = list.material ? *list.material + 1 : -1;
    }
    program.use();
    program.set("u_min_speed", min_speed);
    program.set("u_event_kinds", kinds);
    program.set("u_event_type", type);
    program.set("u_event_material", material);
}

Result<void> EventList::createPrograms() {
    const std::string defines = "#define RELIEF_TYPES " + std::to_string(kParticleTypesMax) + "\n";
    count_program_ = RELIEF_TRY(makeScreenProgram("events/event_count.frag"));
    sum_program_ = RELIEF_TRY(makeScreenProgram("events/event_count.frag", "#define RELIEF_EVENT_SUMS\n"));
    list_program_ = RELIEF_TRY(makeScreenProgram("events/event_list.frag", defines));
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
    Request& request = requests_[(oldest_ + static_cast<std::size_t>(in_flight_++)) % kInFlightMax];
    request.tag = step.tag;
    request.number = step.number;
    request.begin = step.begin;
    request.end = step.end;
    const std::uint32_t rows = layOut(step.extent, request.first_row);
    request.floats = rows == 0 ? 0 : kFloats * (list_.size() * listWidth() * rows + 1);
    if (rows == 0) {  // also clears the list on the GPU
        const std::array<float, 4> zero{};
        glBindFramebuffer(GL_FRAMEBUFFER, counts_.back().target.name());
        glClearBufferfv(GL_COLOR, 0, zero.data());
        return true;
    }
    bindPackBuffer(request.buffer, static_cast<GLsizeiptr>(request.floats * sizeof(float)));
    count(step);
    makeLists(step, request, rows);
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

void EventList::makeLists(const Step& step, const Request& request, std::uint32_t rows) const {
    list_program_.use();
    std::array<GLint, kEventLists> first_row{};
    std::copy(request.first_row.begin(), request.first_row.end(), first_row.begin());
    list_program_.set("u_first_row", first_row);
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
    constexpr GLuint64 kWaitTimeout = 10'000'000'000;  // nanoseconds
    static constexpr const char* kReading = "reading the list of events";
    const Request& oldest = requests_[oldest_];
    if (oldest.floats > 0 && !waitToRead(oldest.fence, kWaitTimeout)) {
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
    Collected collected;
    collected.number = request.number;
    collected.events.tag = request.tag;
    collected.events.time = request.end;
    // Copy only the events, not the whole capacity of the lists, which would take milliseconds.
    const std::size_t plane = request.floats / kFloats / list_.size() * kFloats;
    for (std::size_t i = 0; i < lists_.size(); ++i) {
        const auto count = static_cast<std::uint32_t>(total[i]);
        const std::size_t listed = std::min(count, lists_[i].max_per_step);
        const std::size_t first = listed == 0 ? 0 : kFloats * listWidth() * request.first_row[i];
        std::vector<float> values(kFloats * list_.size() * listed);
        for (std::size_t p = 0; p < list_.size() && listed > 0; ++p) {
            if (!readFloats(request, p * plane + first,
                            std::span(values).subspan(p * kFloats * listed, kFloats * listed))) {
                return std::nullopt;
            }
        }
        const std::uint32_t dropped = count - static_cast<std::uint32_t>(listed);
        collected.events.lists.push_back({listed, dropped});
        collected.events.dropped += dropped;
        decode(request, values, collected.events);
    }
    return collected;
}

bool EventList::readFloats(const Request& request, std::size_t first, std::span<float> out) {
    return readBuffer(request.buffer, first * sizeof(float), std::as_writable_bytes(out));
}

void EventList::decode(const Request& request, std::span<const float> values, StepEvents& to) const {
    const std::size_t plane = values.size() / list_.size();
    const std::size_t listed = plane / kFloats;
    to.events.reserve(to.events.size() + listed);
    for (std::size_t i = 0; i < listed; ++i) {
        const float* position = &values[kFloats * i];
        const float* surface = position + plane;
        const float* velocity = surface + plane;
        const float* identity = velocity + plane;
        const int flags = static_cast<int>(identity[3]);
        ParticleEvent& event = to.events.emplace_back();
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
}

}  // namespace relief
