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
            std::fputs(jsonLine(jsonOf(HitLine{event, step.tag, materials})).c_str(), file_.get()) < 0) {
            return writeError();
        }
    }
    return {};
}

Result<void> EventsLog::finish() {
    return std::fflush(file_.get()) == 0 ? Result<void>{} : writeError();
}

}  // namespace relief
