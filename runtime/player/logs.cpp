#include "runtime/player/logs.h"

#include <cerrno>
#include <system_error>
#include <utility>

#include "formats/base/file_io.h"
#include "formats/fields/json.h"

namespace relief {

void LineLog::Close::operator()(std::FILE* file) const {
    if (file != stdout) {
        std::fclose(file);
    }
}

Result<void> LineLog::writeError() const {
    return fail(ErrorCode::kIo,
                "cannot write " + (path_ == "-" ? std::string("standard output") : quotedPath(path_)) + ": " +
                    std::system_category().message(errno) + "; choose another place with " + option_);
}

Result<LineLog> LineLog::create(const std::filesystem::path& path, std::string option) {
    LineLog log;
    log.path_ = path;
    log.option_ = std::move(option);
    log.file_.reset(path == "-" ? stdout : std::fopen(path.c_str(), "we"));
    if (!log.file_) {
        return forward(log.writeError());
    }
    return log;
}

Result<void> LineLog::write(const std::string& line) {
    return std::fputs(line.c_str(), file_.get()) >= 0 ? Result<void>{} : writeError();
}

Result<void> LineLog::flush() {
    return std::fflush(file_.get()) == 0 ? Result<void>{} : writeError();
}

// --- hits ---

Result<EventsLog> EventsLog::create(const std::filesystem::path& path, float min_speed) {
    EventsLog log;
    log.log_ = RELIEF_TRY(LineLog::create(path, "--events"));
    log.min_speed_ = min_speed;
    return log;
}

Result<void> EventsLog::write(const StepEvents& step) {
    dropped_ += step.dropped;
    for (const ParticleEvent& event : step.events) {
        if (event.hit && !event.lasts && event.speed >= min_speed_) {
            RELIEF_TRY(log_.write(jsonLine(jsonOf(HitLine{event, step.tag}))));
        }
    }
    return {};
}

// --- statistics ---

Result<StatisticsLog> StatisticsLog::create(const std::filesystem::path& path, std::uint32_t capacity,
                                            GpuTimer& timer) {
    auto statistics = RELIEF_TRY(Statistics::create(capacity));
    auto log = RELIEF_TRY(LineLog::create(path, "--stats"));
    return StatisticsLog(std::move(log), std::move(statistics), timer);
}

Result<void> StatisticsLog::request(const ParticleSystem& particles, std::uint64_t step,
                                    std::uint64_t refused) {
    while (statistics_.inFlight() == Statistics::kInFlightMax) {
        RELIEF_TRY(waitForOne());
    }
    Entry entry{step, particles.time(), particles.counts(), timer_->times()};
    entry.counts.refused += refused;
    const StageScope scope(timer_, Stage::kStatistics);
    if (!statistics_.request(particles, step)) {
        return fail(ErrorCode::kFailure, "the statistics are made for fewer particles than the system holds");
    }
    entries_.push_back(entry);
    return {};
}

Result<void> StatisticsLog::poll() {
    while (const auto sample = statistics_.poll()) {
        RELIEF_TRY(write(*sample));
    }
    return {};
}

Result<void> StatisticsLog::finish() {
    while (statistics_.inFlight() > 0) {
        RELIEF_TRY(waitForOne());
    }
    return {};
}

Result<void> StatisticsLog::waitForOne() {
    const auto sample = RELIEF_TRY(statistics_.wait());
    return sample ? write(*sample) : Result<void>{};
}

Result<void> StatisticsLog::write(const StatisticsSample& sample) {
    while (entries_.front().step != sample.tag) {  // the GPU has lost a sample
        entries_.pop_front();
    }
    const Entry entry = entries_.front();
    entries_.pop_front();
    RELIEF_TRY(log_.write(
        jsonLine(jsonOf(StatisticsLine{sample, entry.time, entry.counts, {entry.times, last_times_}}))));
    last_times_ = entry.times;
    return log_.flush();
}

}  // namespace relief
