// SPDX-License-Identifier: Apache-2.0
#include "runtime/player/events_log.h"

#include <cerrno>
#include <system_error>

#include "formats/base/file_io.h"
#include "formats/fields/json.h"

namespace relief {

void EventsLog::Close::operator()(std::FILE* file) const {
    if (file != stdout) {
        std::fclose(file);
    }
}

Result<void> EventsLog::writeError() const {
    return fail(ErrorCode::kIo,
                "cannot write " + (path_ == "-" ? std::string("standard output") : quotedPath(path_)) + ": " +
                    std::system_category().message(errno) + "; choose another place with --events");
}

Result<EventsLog> EventsLog::create(const std::filesystem::path& path, float min_speed) {
    EventsLog log;
    log.path_ = path;
    log.min_speed_ = min_speed;
    log.file_.reset(path == "-" ? stdout : std::fopen(path.c_str(), "we"));
    if (!log.file_) {
        return forward(log.writeError());
    }
    return log;
}

Result<void> EventsLog::write(const StepEvents& step, std::span<const std::string> materials) {
    dropped_ += step.dropped;
    for (const ParticleEvent& event : step.events) {
        if (event.hit && !event.lasts && event.speed >= min_speed_ &&
            std::fputs(jsonLineOf(HitLine{event, step.tag, materials}).c_str(), file_.get()) < 0) {
            return writeError();
        }
    }
    return {};
}

Result<void> EventsLog::finish() {
    return std::fflush(file_.get()) == 0 ? Result<void>{} : writeError();
}

void fields(FieldVisitor& visit, const HitLine& line) {
    const auto& [hit, step, materials] = line;
    const auto known = static_cast<std::size_t>(hit.material);
    visit("step", step, {"Number of the step, from 1", {}, kFromOne});
    visit("time", hit.time, {"Time of the scene", "s", kFromZero});
    visit("id", hit.id, {"Particle, as in dumps"});
    visit("type", hit.type, {"Type of the particle, as in dumps"});
    visit("body", onlyIf(hit.body >= 0, hit.body),
          {"Collider of the scene, from 0; null: the ground", {}, kFromZero});
    visit("material", known < materials.size() ? std::optional(materials[known]) : std::nullopt,
          {"Name of the material; null: the ground, or a collider without materials"});
    visit("position", hit.position, {"Point where the particle touched the surface", "world units"});
    visit("normal", hit.normal, {"Outward unit normal of the surface"});
    visit("velocity", hit.velocity, {"Velocity of the particle before the hit", "world units per second"});
    visit(
        "speed", hit.speed,
        {"Speed of approach along the normal, relative to the surface", "world units per second", kFromZero});
}

}  // namespace relief
