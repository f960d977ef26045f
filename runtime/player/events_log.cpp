#include "runtime/player/events_log.h"

#include <cerrno>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>

#include "formats/base/file_io.h"
#include "runtime/tool/json_text.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

std::string lineOf(const ParticleEvent& hit, std::uint64_t step) {
    Json json;
    json["step"] = step;
    json["time"] = hit.time;
    json["id"] = hit.id;
    json["type"] = hit.type;
    json["body"] = hit.body < 0 ? Json() : Json(hit.body);
    json["position"] = jsonVector(hit.position);
    json["normal"] = jsonVector(hit.normal);
    json["velocity"] = jsonVector(hit.velocity);
    json["speed"] = jsonNumber(hit.speed);
    return json.dump() + "\n";
}

}  // namespace

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

Result<void> EventsLog::write(const StepEvents& step) {
    dropped_ += step.dropped;
    for (const ParticleEvent& event : step.events) {
        if (!event.hit || event.lasts || event.speed < min_speed_) {
            continue;  // for somebody else
        }
        if (std::fputs(lineOf(event, step.tag).c_str(), file_.get()) < 0) {
            return writeError();
        }
    }
    return {};
}

Result<void> EventsLog::finish() {
    return std::fflush(file_.get()) == 0 ? Result<void>{} : writeError();
}

}  // namespace relief
