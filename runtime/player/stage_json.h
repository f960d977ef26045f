// Stages' times as JSON, for the report and the statistics.
#pragma once

#include <nlohmann/json.hpp>

#include "runtime/gl/gpu_timer.h"

namespace relief {

/// {"step": {"cpu": ms, "gpu": ms}, …}: the mean run of each stage between two readings; stages that have not
/// run are left out, and "gpu" is null where the GPU has not answered, or cannot.
[[nodiscard]] inline nlohmann::ordered_json stageJson(const StageTimes& now, const StageTimes& before = {}) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for (std::size_t i = 0; i < kStageCount; ++i) {
        const std::uint64_t runs = now[i].runs - before[i].runs;
        const std::uint64_t gpu_runs = now[i].gpu_runs - before[i].gpu_runs;
        if (runs == 0) {
            continue;
        }
        auto& stage = json[kStageNames[i]];
        stage["cpu"] = (now[i].cpu_ms - before[i].cpu_ms) / static_cast<double>(runs);
        stage["gpu"] = nullptr;
        if (gpu_runs > 0) {
            stage["gpu"] = (now[i].gpu_ms - before[i].gpu_ms) / static_cast<double>(gpu_runs);
        }
    }
    return json;
}

}  // namespace relief
