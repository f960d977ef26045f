// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "formats/animation/mesh_parts.h"
#include "runtime/births/collider_surface.h"
#include "runtime/births/emitter_motion.h"
#include "runtime/births/emitter_surface.h"
#include "runtime/bodies/pose_keys.h"
#include "runtime/c_api/objects.h"

using namespace relief;  // NOLINT: the C functions are outside of it

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
        return call.reject(std::string("options->") +
                           (all.speed_min > all.speed_max ? "speed_min is above speed_max"
                                                          : "lifetime_min is above lifetime_max") +
                           "; swap them");
    }
    if (all.rate == 0.0F && all.burst == 0) {
        return call.reject("options->rate and options->burst are both 0; set one above 0");
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

/// Prefixes an error with the name of the argument.
template <class T>
Result<T> withArgument(const Call& call, const char* argument, Result<T> result) {
    return result ? std::move(result)
                  : Result<T>(call.reject(std::string(argument) + ": " + result.error().message));
}

Result<EmitterSurface> surfaceOf(const Call& call, const Collider& collider, const char* material) {
    const ColliderSurface surface = RELIEF_TRY(withArgument(call, "collider", colliderSurface(collider)));
    std::vector<glm::uvec3> triangles = surface.triangles;
    if (material != nullptr) {
        triangles = RELIEF_TRY(
            withArgument(call, "material", materialTriangles(surface, collider.materials, material)));
    }
    return withArgument(call, "collider", EmitterSurface::create(triangles, {}, surface.positions));
}

Result<EmitterSurface> surfaceOf(const Call& call, const AnimatedMesh& mesh, const char* group,
                                 const char* material) {
    std::vector<float> weights;
    if (group != nullptr) {
        weights = RELIEF_TRY(withArgument(call, "group", groupWeights(mesh, group)));
    }
    std::vector<glm::uvec3> triangles = mesh.triangles;
    if (material != nullptr) {
        triangles = RELIEF_TRY(withArgument(call, "material", materialTriangles(mesh, material)));
    }
    return withArgument(call, "animation",
                        EmitterSurface::create(triangles, std::move(weights), posed(mesh, firstPose(mesh))));
}

/// \param mesh     animated mesh; null for a collider.
/// \param surface  surface of the mesh at rest, or of the collider.
Result<EmitterObject> emitterOf(const Call& call, const relief_emitter_options& options,
                                std::shared_ptr<const AnimatedMesh> mesh, EmitterSurface surface) {
    EmitterSettings settings = RELIEF_TRY(settingsOf(call, options));
    settings.surface = BirthSurfaceValue(std::make_unique<EmitterSurface>(std::move(surface)));
    RELIEF_TRY(withArgument(call, "options", Emitter::check(settings)));
    return EmitterObject{std::move(mesh), Emitter(std::move(settings), options.seed), options.inherit};
}

/// Deforms the emitter's mesh by the motion of the body during the last dt seconds.
Result<void> deformSurface(const Call& call, EmitterObject& emitter, relief_textures* textures,
                           std::uint32_t body, double dt) {
    AnimatedBody& on = *RELIEF_TRY(animatedOf(call, textures, body));
    if (on.collider.shared() != emitter.mesh) {
        if (*on.collider.shared() != *emitter.mesh) {
            return call.reject("emitter has a different animation than body " + std::to_string(body) +
                               "; create it from the animation of the body");
        }
        emitter.mesh = on.collider.shared();  // equal; share it to skip the next comparison
    }
    if (emitter.emitter.isDue(dt)) {
        on.trail.bend(emitter.emitter, dt);
    }
    return {};
}

/// Returns the motion of a body during the last `seconds`, extrapolated so that its velocity at the end is defined.
std::vector<PoseKey> motionOf(const Pose& before, const Pose& now, double seconds) {
    const Pose next{now.position + (now.position - before.position),
                    glm::normalize(now.rotation * glm::conjugate(before.rotation) * now.rotation), now.scale};
    return {{0.0, before}, {seconds, now}, {2.0 * seconds, next}};
}

}  // namespace

relief_emitter* relief_emitter_create(const relief_animation* animation, const char* group,
                                      const char* material, const relief_emitter_options* options) {
    return create<relief_emitter>(__func__, [&](const Call& call) -> Result<EmitterObject> {
        const auto mesh = RELIEF_TRY(call.object(animation, "animation"))->mesh;
        RELIEF_TRY(call.notNull(options, "options"));
        const auto all = RELIEF_TRY(call.structure(options, "options", "relief_emitter_options"));
        return emitterOf(call, all, mesh, RELIEF_TRY(surfaceOf(call, *mesh, group, material)));
    });
}

relief_emitter* relief_emitter_create_on(const relief_collider* collider, const char* material,
                                         const relief_emitter_options* options) {
    return create<relief_emitter>(__func__, [&](const Call& call) -> Result<EmitterObject> {
        const Collider& on = *RELIEF_TRY(call.object(collider, "collider"));
        RELIEF_TRY(call.notNull(options, "options"));
        const auto all = RELIEF_TRY(call.structure(options, "options", "relief_emitter_options"));
        return emitterOf(call, all, nullptr, RELIEF_TRY(surfaceOf(call, on, material)));
    });
}

void relief_emitter_free(relief_emitter* emitter) {
    release(__func__, emitter, "emitter");
}

int64_t relief_particles_emit(relief_particles* particles, relief_emitter* emitter, relief_textures* textures,
                              uint32_t body, float seconds) {
    return answer(__func__, int64_t{-1}, [&](const Call& call) -> Result<int64_t> {
        ParticlesObject& to = *RELIEF_TRY(call.object(particles, "particles"));
        EmitterObject& from = *RELIEF_TRY(call.object(emitter, "emitter"));
        const TexturesObject& among = *RELIEF_TRY(call.object(textures, "textures"));
        RELIEF_TRY(call.number(seconds, kStep, {"seconds"}));
        const double dt{seconds};
        if (from.mesh) {
            RELIEF_TRY(deformSurface(call, from, textures, body, dt));
        } else {
            RELIEF_TRY(call.index(body, std::max<std::size_t>(among.poses.size(), 1), "body", "bodies"));
        }
        to.births.clear();
        from.emitter.emit(dt, to.system.room(), to.births);
        EmitterMotion motion{.keys = {}, .body = {}, .inherit = from.inherit};
        if (!among.poses.empty()) {
            motion.body = motionOf(among.before[body], among.poses[body], dt);
        }
        carry(motion, dt, to.births, from.emitter.birthSurfaceVelocities());
        return static_cast<int64_t>(RELIEF_TRY(to.system.spawn(to.births)));
    });
}
