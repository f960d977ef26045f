#include "runtime/player/statistics_log.h"

#include <cerrno>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/base/file_io.h"
#include "runtime/player/stage_json.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

tl::unexpected<Error> writeError(const std::filesystem::path& path) {
    return fail(ErrorCode::kIo,
                "cannot write " + (path == "-" ? std::string("standard output") : quotedPath(path)) + ": " +
                    std::system_category().message(errno) + "; choose another place with --stats");
}

}  // namespace

void StatisticsLog::Close::operator()(std::FILE* file) const {
    if (file != stdout) {
        std::fclose(file);
    }
}

Result<StatisticsLog> StatisticsLog::create(const std::filesystem::path& path, std::uint32_t capacity,
                                            StepPath steps, GpuTimer& timer) {
    auto statistics = RELIEF_TRY(Statistics::create(capacity, steps));
    StatisticsLog log(std::move(statistics), timer);
    log.path_ = path;
    log.file_.reset(path == "-" ? stdout : std::fopen(path.c_str(), "we"));
    if (!log.file_) {
        return writeError(path);
    }
    return log;
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
    Json json;
    json["step"] = sample.tag;
    json["time"] = entry.time;
    json["alive"] = sample.alive;
    json["born"] = entry.counts.born;
    json["died"] = entry.counts.died;
    json["refused"] = entry.counts.refused;
    json["in_contact"] = sample.in_contact;
    json["caught"] = sample.caught;
    json["collisions"] = sample.collisions;
    json["energy"] = sample.energy;
    json["max_speed"] = static_cast<double>(sample.max_speed);
    json["ms"] = stageJson(entry.times, last_times_);
    last_times_ = entry.times;
    const std::string line = json.dump() + "\n";
    if (std::fputs(line.c_str(), file_.get()) < 0 || std::fflush(file_.get()) != 0) {
        return writeError(path_);
    }
    return {};
}

}  // namespace relief
