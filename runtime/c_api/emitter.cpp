#include <array>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/animation/mesh_parts.h"
#include "runtime/c_api/objects.h"
#include "runtime/collider/pose_keys.h"

using namespace relief;  // NOLINT: what C sees has C's names

namespace {

constexpr FieldRange kRate{0.0, 1e9};
constexpr FieldRange kBurst{0.0, 16777216.0};
constexpr FieldRange kCone{0.0, 180.0};
constexpr FieldRange kInherit{0.0, 1000.0};
constexpr FieldRange kSeed{0.0, 9007199254740992.0};

Result<EmitterSettings> settingsOf(const Call& call, const relief_emitter_options& all) {
    const auto name = [](const char* field) { return NumberName{.argument = "options", .field = field}; };
    RELIEF_TRY(call.number(all.rate, kRate, name("rate")));
    RELIEF_TRY(call.number(all.burst, kBurst, name("burst")));
    RELIEF_TRY(call.number(all.direction, kAny, name("direction")));
    RELIEF_TRY(call.number(all.cone, kCone, name("cone")));
    RELIEF_TRY(call.number(all.speed_min, kNotNegative, name("speed_min")));
    RELIEF_TRY(call.number(all.speed_max, kNotNegative, name("speed_max")));
    RELIEF_TRY(call.number(all.inherit, kInherit, name("inherit")));
    RELIEF_TRY(call.number(all.lifetime_min, kLifetime, name("lifetime_min")));
    RELIEF_TRY(call.number(all.lifetime_max, kLifetime, name("lifetime_max")));
    RELIEF_TRY(call.number(all.type, {0.0, kBirthTypeMax}, name("type")));
    RELIEF_TRY(call.number(all.seed, kSeed, name("seed")));
    if (all.speed_min > all.speed_max || all.lifetime_min > all.lifetime_max) {
        return call.refuse(std::string("options->") +
                           (all.speed_min > all.speed_max ? "speed_min is above speed_max"
                                                          : "lifetime_min is above lifetime_max") +
                           "; swap them");
    }
    if (all.rate == 0.0F && all.burst == 0) {
        return call.refuse("options->rate and options->burst are 0, so that nothing is born; raise one");
    }
    EmitterSettings settings;
    settings.shape = EmitterShape::kSurface;
    settings.rate = double{all.rate};
    settings.burst = all.burst;
    EmitterAim& aim = settings.aim.emplace();
    if (vec(all.direction) != glm::vec3(0.0F)) {
        aim.direction = vec(all.direction);
    }
    aim.cone_degrees = all.cone;
    aim.speed_min = all.speed_min;
    aim.speed_max = all.speed_max;
    settings.lifetime_min = all.lifetime_min;
    settings.lifetime_max = all.lifetime_max;
    settings.type = all.type;
    return settings;
}

/// The error of an argument.
template <class T>
Result<T> ofArgument(const Call& call, const char* argument, Result<T> result) {
    return result ? std::move(result)
                  : Result<T>(call.refuse(std::string(argument) + ": " + result.error().message));
}

Result<EmitterSurface> surfaceOf(const Call& call, const AnimatedMesh& mesh, const char* group,
                                 const char* material) {
    std::vector<float> weights;
    if (group != nullptr) {
        weights = RELIEF_TRY(ofArgument(call, "group", groupWeights(mesh, group)));
    }
    std::vector<glm::uvec3> triangles = mesh.triangles;
    if (material != nullptr) {
        triangles = RELIEF_TRY(ofArgument(call, "material", materialTriangles(mesh, material)));
    }
    return ofArgument(call, "animation",
                      EmitterSurface::create(triangles, std::move(weights), posed(mesh, firstPose(mesh))));
}

/// The way of a body within the last `seconds`, and on at the same speed, so that it moves at their end, too.
std::vector<PoseKey> wayOf(const Pose& before, const Pose& now, double seconds) {
    const Pose next{now.position + (now.position - before.position),
                    glm::normalize(now.rotation * glm::conjugate(before.rotation) * now.rotation), now.scale};
    return {{0.0, before}, {seconds, now}, {2.0 * seconds, next}};
}

}  // namespace

relief_emitter* relief_emitter_create(const relief_animation* animation, const char* group,
                                      const char* material, const relief_emitter_options* options) {
    return create<relief_emitter>(__func__, [&](const Call& call) -> Result<std::shared_ptr<EmitterObject>> {
        const auto mesh = RELIEF_TRY(call.object(animation, "animation"))->mesh;
        RELIEF_TRY(call.notNull(options, "options"));
        const auto all = RELIEF_TRY(call.structure(options, "options", "relief_emitter_options"));
        EmitterSettings settings = RELIEF_TRY(settingsOf(call, all));
        settings.surface = RELIEF_TRY(surfaceOf(call, *mesh, group, material));
        RELIEF_TRY(ofArgument(call, "options", Emitter::check(settings)));
        return std::make_shared<EmitterObject>(
            EmitterObject{mesh, Emitter(std::move(settings), all.seed), all.inherit});
    });
}

void relief_emitter_free(relief_emitter* emitter) {
    release(__func__, emitter, "emitter");
}

int64_t relief_particles_emit(relief_particles* particles, relief_emitter* emitter,
                              relief_textures* animated_textures, uint32_t body, float seconds) {
    return answer(__func__, int64_t{-1}, [&](const Call& call) -> Result<int64_t> {
        ParticlesObject& to = *RELIEF_TRY(call.object(particles, "particles"));
        EmitterObject& from = *RELIEF_TRY(call.object(emitter, "emitter"));
        AnimatedBody& on = *RELIEF_TRY(animatedOf(call, animated_textures, body));
        const TexturesObject& among = *RELIEF_TRY(call.object(animated_textures, "animated_textures"));
        RELIEF_TRY(call.number(seconds, kStep, {"seconds"}));
        if (on.collider.shared() != from.mesh) {
            if (*on.collider.shared() != *from.mesh) {
                return call.refuse("emitter is of another animation than body " + std::to_string(body) +
                                   "; make one of the animation that the body was added with");
            }
            from.mesh = on.collider.shared();  // alike, and known to be from now on
        }
        const double dt{seconds};
        if (from.emitter.isDue(dt)) {
            on.trail.bend(from.emitter, dt);
        }
        to.births.clear();
        from.emitter.emit(dt, to.system.room(), to.births);
        const EmitterMotion motion{
            .keys = {}, .body = wayOf(among.before[body], among.poses[body], dt), .inherit = from.inherit};
        carry(motion, dt, to.births, from.emitter.placeVelocities());
        return static_cast<int64_t>(RELIEF_TRY(to.system.spawn(to.births)));
    });
}
