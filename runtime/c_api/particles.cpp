// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "runtime/c_api/objects.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/particles/particle_system.h"
#include "runtime/picture/particle_renderer.h"

using namespace relief;  // NOLINT: the C functions are outside of it

namespace {

Result<relief_particles_options> optionsOf(const Call& call, const relief_particles_options* given) {
    if (given == nullptr) {
        return relief_particles_options{};
    }
    const auto all = RELIEF_TRY(call.structure(given, "options", "relief_particles_options"));
    const auto name = [](const char* field) { return NumberName{.argument = "options", .field = field}; };
    RELIEF_TRY(call.number(all.capacity, {0.0, ParticleSystem::kCapacityMax}, name("capacity")));
    RELIEF_TRY(call.number(all.gravity, kAny, name("gravity")));
    RELIEF_TRY(call.number(all.wind, kAny, name("wind")));
    RELIEF_TRY(call.number(all.drag, kNotNegative, name("drag")));
    RELIEF_TRY(call.number(all.restitution, kFraction, name("restitution")));
    RELIEF_TRY(call.number(all.friction, kFraction, name("friction")));
    RELIEF_TRY(call.number(all.radius, kNotNegative, name("radius")));
    RELIEF_TRY(call.number(all.has_ground, kFraction, name("has_ground")));
    RELIEF_TRY(call.number(all.ground_height, kAny, name("ground_height")));
    return all;
}

Result<void> apply(const relief_particles_options& options, ParticleSystem& system) {
    ParticleType type;
    type.radius = options.radius;
    type.restitution = options.restitution;
    type.friction = options.friction;
    RELIEF_TRY(system.setType(type));
    RELIEF_TRY(system.setForces({vec(options.gravity), vec(options.wind), options.drag, 0.0F}));
    return system.setGround(options.has_ground != 0 ? std::optional(options.ground_height) : std::nullopt);
}

Result<Birth> birthOf(const Call& call, const relief_birth& birth, std::size_t i) {
    const auto name = [i](const char* field) { return NumberName{"births", i, field}; };
    RELIEF_TRY(call.number(birth.position, kAny, name("position")));
    RELIEF_TRY(call.number(birth.velocity, kAny, name("velocity")));
    RELIEF_TRY(call.number(birth.lifetime, kLifetime, name("lifetime")));
    RELIEF_TRY(call.number(birth.type, {0.0, kBirthTypeMax}, name("type")));
    return Birth{vec(birth.position), vec(birth.velocity), birth.lifetime, birth.type};
}

Result<ParticleStyle> styleOf(const Call& call, const relief_renderer_options* given,
                              const RendererObject& picture) {
    relief_renderer_options all{};
    if (given != nullptr) {
        all = RELIEF_TRY(call.structure(given, "options", "relief_renderer_options"));
    }
    const auto name = [](const char* field) { return NumberName{.argument = "options", .field = field}; };
    RELIEF_TRY(call.number(all.diameter, kNotNegative, name("diameter")));
    RELIEF_TRY(call.number(all.color, kFraction, name("color")));
    RELIEF_TRY(call.number(all.opacity, kFraction, name("opacity")));
    const glm::vec3 color = vec(all.color);
    ParticleStyle style;
    style.diameter = all.diameter > 0.0F ? all.diameter : picture.diameter;
    style.color = color == glm::vec3(0.0F) ? glm::vec3(1.0F) : color;
    style.opacity = all.opacity > 0.0F ? all.opacity : 0.95F;
    return style;
}

Result<relief_view> viewOf(const Call& call, const relief_view* given) {
    RELIEF_TRY(call.notNull(given, "view"));
    const auto all = RELIEF_TRY(call.structure(given, "view", "relief_view"));
    const auto name = [](const char* field) { return NumberName{.argument = "view", .field = field}; };
    RELIEF_TRY(call.number(all.view, kAny, name("view")));
    RELIEF_TRY(call.number(all.projection, kAny, name("projection")));
    RELIEF_TRY(call.number(all.width, kPixels, name("width")));
    RELIEF_TRY(call.number(all.height, kPixels, name("height")));
    RELIEF_TRY(call.number(all.srgb, kFraction, name("srgb")));
    if (all.projection[5] == 0.0F) {
        return call.reject("view->projection is not a perspective projection: element 5 is 0; set it");
    }
    if (all.framebuffer != 0 && glIsFramebuffer(all.framebuffer) == GL_FALSE) {
        return call.reject("view->framebuffer is " + std::to_string(all.framebuffer) +
                           "; name a framebuffer of the current context");
    }
    return all;
}

}  // namespace

relief_particles* relief_particles_create(const relief_textures* textures,
                                          const relief_particles_options* options) {
    return create<relief_particles>(__func__, [&](const Call& call) -> Result<ParticlesObject> {
        const auto among = RELIEF_TRY(call.optional(textures, "textures"));
        const relief_particles_options all = RELIEF_TRY(optionsOf(call, options));
        RELIEF_TRY(call.context());
        auto system =
            RELIEF_TRY(ParticleSystem::create({.capacity = all.capacity == 0 ? 65536 : all.capacity}));
        RELIEF_TRY(system.setCollider(among ? &among->textures() : nullptr));
        RELIEF_TRY(apply(all, system));
        return ParticlesObject{among, std::move(system), {}};
    });
}

void relief_particles_free(relief_particles* particles) {
    release(__func__, particles, "particles");
}

int relief_particles_set(relief_particles* particles, const relief_particles_options* options) {
    return answer(__func__, -1, [&](const Call& call) -> Result<int> {
        ParticlesObject& to = *RELIEF_TRY(call.object(particles, "particles"));
        RELIEF_TRY(call.notNull(options, "options"));
        const relief_particles_options all = RELIEF_TRY(optionsOf(call, options));
        RELIEF_TRY(call.context());
        RELIEF_TRY(apply(all, to.system));
        return 0;
    });
}

size_t relief_particles_spawn(relief_particles* particles, const relief_birth* births, size_t count) {
    return answer(__func__, std::size_t{0}, [&](const Call& call) -> Result<std::size_t> {
        ParticlesObject& to = *RELIEF_TRY(call.object(particles, "particles"));
        RELIEF_TRY(call.array(births, "births", count, "count"));
        to.births.clear();
        for (std::size_t i = 0; i < count; ++i) {
            to.births.push_back(RELIEF_TRY(birthOf(call, births[i], i)));
        }
        return to.system.spawn(to.births);
    });
}

int relief_particles_step(relief_particles* particles, float seconds) {
    return answer(__func__, -1, [&](const Call& call) -> Result<int> {
        ParticlesObject& of = *RELIEF_TRY(call.object(particles, "particles"));
        RELIEF_TRY(call.number(seconds, kStep, {"seconds"}));
        RELIEF_TRY(call.context());
        RELIEF_TRY(of.system.step(seconds));
        RELIEF_TRY(checkGpu("stepping particles"));
        return 0;
    });
}

relief_counts relief_particles_counts(const relief_particles* particles) {
    return answer(__func__, relief_counts{}, [&](const Call& call) -> Result<relief_counts> {
        const ParticleCounts counts = RELIEF_TRY(call.object(particles, "particles"))->system.counts();
        return relief_counts{counts.born, counts.died, counts.rejected, counts.alive};
    });
}

int64_t relief_particles_read(const relief_particles* particles, relief_particle* out, size_t capacity) {
    return answer(__func__, int64_t{-1}, [&](const Call& call) -> Result<int64_t> {
        const ParticlesObject& of = *RELIEF_TRY(call.object(particles, "particles"));
        RELIEF_TRY(call.array(out, "out", capacity, "capacity"));
        RELIEF_TRY(call.context());
        const auto states = RELIEF_TRY(of.system.readState());
        for (std::size_t i = 0; i < std::min(capacity, states.size()); ++i) {
            const ParticleState& from = states[i];
            out[i].id = from.id;
            put(from.position, out[i].position);
            put(from.velocity, out[i].velocity);
            out[i].age = from.age;
            out[i].lifetime = from.lifetime;
            out[i].type = from.type;
            out[i].collisions = from.collisions;
        }
        return static_cast<int64_t>(states.size());
    });
}

// --- renderers

relief_renderer* relief_renderer_create(const relief_textures* textures, const relief_collider* collider) {
    return create<relief_renderer>(__func__, [&](const Call& call) -> Result<RendererObject> {
        const auto among = RELIEF_TRY(call.optional(textures, "textures"));
        const auto field = RELIEF_TRY(call.optional(collider, "collider"));
        const bool world = among && among->world;
        if (world && field) {
            return call.reject("collider must be NULL for textures of a world");
        }
        if (!world && (among == nullptr) != (field == nullptr)) {
            return call.reject(std::string(among ? "collider" : "textures") +
                               " is NULL; pass the textures and their collider, or NULL for both");
        }
        RELIEF_TRY(call.context());
        std::optional<ColliderView> view;
        float diameter = 0.01F;
        if (among) {
            view = world ? ColliderView{&among->textures(), *among->world, among->texel}
                         : ColliderView{&among->textures(), field->bounds, finestTexel(*field)};
            diameter = 0.01F * view->bounds.longestSide();
        }
        auto renderer = RELIEF_TRY(ParticleRenderer::create(view));
        return RendererObject{among, std::move(renderer), diameter};
    });
}

void relief_renderer_free(relief_renderer* renderer) {
    release(__func__, renderer, "renderer");
}

int relief_renderer_draw(relief_renderer* renderer, const relief_particles* particles,
                         const relief_renderer_options* options, const relief_view* view) {
    return answer(__func__, -1, [&](const Call& call) -> Result<int> {
        RendererObject& by = *RELIEF_TRY(call.object(renderer, "renderer"));
        const ParticlesObject& shown = *RELIEF_TRY(call.object(particles, "particles"));
        RELIEF_TRY(call.context());
        const ParticleStyle style = RELIEF_TRY(styleOf(call, options, by));
        const relief_view from = RELIEF_TRY(viewOf(call, view));
        glm::mat4 view_matrix;
        glm::mat4 projection;
        std::memcpy(&view_matrix, from.view, sizeof(view_matrix));
        std::memcpy(&projection, from.projection, sizeof(projection));
        RELIEF_TRY(by.renderer.draw(shown.system, CameraMatrices(view_matrix, projection), style,
                                    {from.framebuffer, from.width, from.height, from.srgb != 0}));
        return 0;
    });
}
