#include "runtime/player/state_check.h"

#include <algorithm>
#include <string>
#include <utility>

#include "formats/base/file_io.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// From look to look: a look takes less than a tenth of a step.
constexpr std::uint32_t kStateCheckSteps = 64;

/// "scene.toml:12:1: particles of the type 'rain'"
std::string typeText(const std::filesystem::path& input, const Scene& scene, std::uint32_t type) {
    if (scene.types.empty()) {
        return quotedPath(input) + ": particles";
    }
    const std::size_t index = std::min<std::size_t>(type, scene.types.size() - 1);
    const std::string& name = scene.types[index].name;
    return scene.types[index].place + ": particles of " +
           (name.empty() ? "type " + std::to_string(index) : "the type '" + cleanUtf8(name) + "'");
}

}  // namespace

Result<StateCheck> StateCheck::create(const std::filesystem::path& input, const Scene& scene) {
    Statistics statistics = RELIEF_TRY(Statistics::create(scene.particles.capacity));
    return StateCheck(input, scene, std::move(statistics));
}

Result<void> StateCheck::look(const ParticleSystem& particles, std::uint32_t step) {
    while (const auto sample = statistics_.poll()) {
        RELIEF_TRY(judge(*sample));
    }
    if (step - looked_ >= kStateCheckSteps || step == scene_->time.steps) {
        looked_ = step;
        if (!statistics_.request(particles, step)) {
            RELIEF_TRY(finish());
            static_cast<void>(statistics_.request(particles, step));
        }
    }
    return {};
}

Result<void> StateCheck::finish() {
    while (statistics_.inFlight() > 0) {
        if (const auto sample = RELIEF_TRY(statistics_.wait())) {
            RELIEF_TRY(judge(*sample));
        }
    }
    return {};
}

Result<void> StateCheck::judge(const StatisticsSample& sample) const {
    if (!sample.lost_type) {
        return {};
    }
    return fail(ErrorCode::kFailure,
                typeText(*input_, *scene_, *sample.lost_type) + " are lost: by step " +
                    std::to_string(sample.tag) +
                    " their place or speed is no number that a float holds; lower speeds, "
                    "strengths, or radius and viscosity over mass, or time.dt");
}

}  // namespace relief
