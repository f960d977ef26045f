#include "runtime/scene/scene_emitter.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "formats/base/error_context.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "runtime/scene/scene_table.h"

namespace relief {
namespace {

/// Seconds in which an emitter gives birth.
double activeSeconds(const SceneEmitter& emitter, double run) {
    const double left = std::max(run - emitter.start, 0.0);
    return std::min(left, emitter.duration.value_or(left));
}

double burstBirths(const SceneEmitter& emitter, double seconds) {
    const double again = emitter.burst_every > 0.0 ? std::floor(seconds / emitter.burst_every) : 0.0;
    return emitter.burst * (1.0 + again);
}

/// Emitters without a rate share the rest of the capacity: it is used up at the end of the run, never before.
Result<void> shareRates(std::span<SceneEmitter> emitters, double run, std::uint32_t capacity) {
    double room = capacity;
    double sharing = 0.0;
    for (const SceneEmitter& emitter : emitters) {
        const double seconds = activeSeconds(emitter, run);
        room -= burstBirths(emitter, seconds) + emitter.rate.value_or(0.0) * seconds;
        sharing += emitter.rate ? 0.0 : 1.0;
    }
    const double share = std::max(room, 0.0) / std::max(sharing, 1.0);
    for (SceneEmitter& emitter : emitters) {
        if (emitter.rate) {
            continue;
        }
        const double seconds = activeSeconds(emitter, run);
        emitter.rate = seconds > 0.0 ? std::min(share / seconds, kRateMax) : 0.0;
        if (seconds > 0.0 && *emitter.rate == 0.0 && emitter.burst == 0) {
            return fail(ErrorCode::kInvalidInput,
                        "an emitter without a rate finds the capacity used up by the others; give it "
                        "emitter.rate, or raise particles.capacity");
        }
    }
    return {};
}

Result<EmitterSettings> settingsOf(const SceneEmitter& from) {
    EmitterSettings to;
    to.shape = from.shape;
    to.box_min = from.box_min.value_or(to.box_min);
    to.box_max = from.box_max.value_or(to.box_max);
    to.center = from.center;
    to.radius = from.radius;
    to.normal = from.normal;
    to.start = from.start;
    to.rate = from.rate.value_or(0.0);
    to.duration = from.duration.value_or(to.duration);
    to.burst = from.burst;
    to.burst_every = from.burst_every;
    to.velocity = from.velocity.value_or(to.velocity);
    to.velocity_spread = from.velocity_spread.value_or(to.velocity_spread);
    to.lifetime_min = from.lifetime_min;
    to.lifetime_max = from.lifetime_max;
    to.type = from.type;
    to.spread = from.spread;
    if (from.aimed) {
        to.aim = EmitterAim{from.direction, from.cone, from.speed_min.value_or(0.0F),
                            from.speed_max.value_or(0.0F), from.speed_deviation};
    }
    if (from.shape == EmitterShape::kPoints) {
        to.points = RELIEF_TRY(inFront(from.points_origin + ": emitter.points", loadPointList(from.points)));
        if (from.aimed && !from.direction && to.points.normals.empty()) {
            return fail(ErrorCode::kInvalidInput,
                        from.points_origin + ": emitter.points: " + quotedPath(from.points) +
                            " has no normals to aim along; give emitter.direction, or nx, ny and nz");
        }
    }
    return to;
}

}  // namespace

Result<std::uint32_t> resolvedType(const std::string& key, const std::string& name, const std::string& origin,
                                   std::uint32_t type, std::span<const std::string> names) {
    if (name.empty()) {
        if (!names.empty() && type >= names.size()) {
            return fail(ErrorCode::kInvalidInput, origin + ": " + key + " = " + std::to_string(type) +
                                                      " is none of the " + std::to_string(names.size()) +
                                                      " types; the first is 0");
        }
        return type;
    }
    const std::vector<std::string_view> known(names.begin(), names.end());
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
        const std::string hint = didYouMean(name, known);
        return fail(ErrorCode::kInvalidInput, origin + ": " + key + " = " +
                                                  quotedPath(std::filesystem::path(name)) + " is unknown" +
                                                  (hint.empty() ? "; name a type of this scene" : hint));
    }
    return static_cast<std::uint32_t>(found - known.begin());
}

Result<void> resolveEmitterTypes(std::span<SceneEmitter> emitters, std::span<const std::string> names) {
    for (SceneEmitter& emitter : emitters) {
        emitter.type = RELIEF_TRY(
            resolvedType("emitter.type", emitter.type_name, emitter.type_origin, emitter.type, names));
    }
    return {};
}

Result<void> completeEmitters(std::span<SceneEmitter> emitters, const Bounds& bounds, float scale,
                              double seconds, std::uint32_t capacity) {
    const glm::vec3 center = bounds.center();
    const float aside = 1.45F * scale;
    for (SceneEmitter& emitter : emitters) {
        if (emitter.shape == EmitterShape::kBox && !emitter.box_min) {
            emitter.box_min = glm::vec3(center.x - aside, bounds.max.y + 0.15F * scale, center.z - aside);
            emitter.box_max = glm::vec3(center.x + aside, bounds.max.y + 0.75F * scale, center.z + aside);
        }
        if (emitter.aimed && !emitter.speed_min) {
            emitter.speed_min = 0.8F * scale;
            emitter.speed_max = emitter.speed_min;
        }
        if (!emitter.velocity) {
            emitter.velocity = emitter.aimed ? glm::vec3(0.0F) : glm::vec3(0.0F, -0.8F * scale, 0.0F);
        }
        if (!emitter.velocity_spread) {
            emitter.velocity_spread =
                emitter.aimed ? glm::vec3(0.0F) : glm::vec3(0.12F * scale, 0.1F * scale, 0.12F * scale);
        }
    }
    return shareRates(emitters, seconds, capacity);
}

Result<std::vector<Emitter>> makeEmitters(std::span<const SceneEmitter> emitters) {
    std::vector<Emitter> made;
    for (const SceneEmitter& emitter : emitters) {
        auto settings = RELIEF_TRY(settingsOf(emitter));
        RELIEF_TRY(Emitter::check(settings));
        made.emplace_back(std::move(settings), emitter.seed, made.size());
    }
    return made;
}

std::vector<EmitterMotion> emitterMotions(std::span<const SceneEmitter> emitters,
                                          std::span<const SceneCollider> colliders) {
    std::vector<EmitterMotion> motions;
    for (const SceneEmitter& emitter : emitters) {
        EmitterMotion& motion = motions.emplace_back();
        motion.keys = emitter.keys;
        motion.inherit = emitter.inherit;
        if (emitter.attach) {
            const SceneCollider& body = colliders[*emitter.attach];
            motion.body = body.keys.empty() ? std::vector<PoseKey>{{0.0, body.pose}} : body.keys;
        }
    }
    return motions;
}

}  // namespace relief
