#include "runtime/c_api/relief.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/container.h"
#include "formats/nearest_surface.h"
#include "runtime/collider/collider_textures.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_object.h"
#include "runtime/particles/particle_system.h"
#include "runtime/picture/particle_renderer.h"

using namespace relief;  // NOLINT: what C sees has C's names

struct relief_collider {
    Collider collider;
};

struct relief_textures {
    ColliderTextures textures;
    std::string glsl;
};

struct relief_particles {
    ParticleSystem system;
    std::vector<Birth> births;  // of a call, kept for its memory
};

struct relief_picture {
    ParticleRenderer renderer;
    float diameter = 0.01F;
};

namespace {

thread_local std::string t_error;

/// What f returns, or `failed`; t_error says why. No exception passes.
template <class T, class F>
T guarded(T failed, const F& f) {
    try {
        auto result = f();
        if (result) {
            return std::move(*result);
        }
        t_error = std::move(result.error().message);
    } catch (const std::bad_alloc&) {
        t_error = "there is not enough memory";
    } catch (const std::exception& error) {
        t_error = error.what();
    } catch (...) {
        t_error = "an unknown error";
    }
    return failed;
}

/// As much of a caller's structure as it knows, the rest 0.
template <class T>
T known(const T* given) {
    T all{};
    if (given != nullptr) {
        std::memcpy(&all, given, std::min(given->size, sizeof(T)));
    }
    return all;
}

glm::vec3 vec(const float (&v)[3]) {
    return {v[0], v[1], v[2]};
}

void put(const glm::vec3& v, float (&out)[3]) {
    std::copy_n(&v.x, 3, out);
}

glm::vec3 pointAt(const float* points, std::size_t i) {
    return {points[3 * i], points[3 * i + 1], points[3 * i + 2]};
}

Result<void> apply(const relief_particles_options& options, ParticleSystem& system) {
    ParticleType type;
    type.radius = options.radius;
    type.restitution = options.restitution;
    type.friction = options.friction;
    RELIEF_TRY(system.setTypes(std::span(&type, 1)));
    RELIEF_TRY(system.setForces({vec(options.gravity), vec(options.wind), options.drag, 0.0F}));
    return system.setGround(options.has_ground != 0 ? std::optional(options.ground_height) : std::nullopt);
}

}  // namespace

int relief_api_version() {
    return RELIEF_API_VERSION;
}

const char* relief_version() {
    return RELIEF_VERSION;
}

const char* relief_error() {
    return t_error.c_str();
}

// --- colliders, on the CPU

relief_collider* relief_collider_load(const char* path) {
    return guarded<relief_collider*>(nullptr, [&]() -> Result<relief_collider*> {
        Collider collider = RELIEF_TRY(loadCollider(path));
        return new relief_collider{std::move(collider)};
    });
}

relief_collider* relief_collider_read(const void* bytes, size_t size) {
    return guarded<relief_collider*>(nullptr, [&]() -> Result<relief_collider*> {
        Collider collider = RELIEF_TRY(readContainer({static_cast<const std::byte*>(bytes), size}));
        return new relief_collider{std::move(collider)};
    });
}

void relief_collider_free(relief_collider* collider) {
    delete collider;
}

void relief_collider_bounds(const relief_collider* collider, float min[3], float max[3]) {
    std::copy_n(&collider->collider.bounds.min.x, 3, min);
    std::copy_n(&collider->collider.bounds.max.x, 3, max);
}

size_t relief_collider_map_count(const relief_collider* collider) {
    return collider->collider.maps.size();
}

const char* relief_collider_unit(const relief_collider* collider) {
    return collider->collider.unit.c_str();
}

void relief_collider_query(const relief_collider* collider, const float* points, size_t count,
                           relief_sample* samples) {
    for (std::size_t i = 0; i < count; ++i) {
        const FieldSample sample = evaluate(collider->collider, pointAt(points, i));
        samples[i].distance = sample.distance;
        put(sample.normal, samples[i].normal);
        samples[i].map = sample.map;
    }
}

void relief_collider_nearest(const relief_collider* collider, const float* points, size_t count,
                             relief_sample* samples) {
    for (std::size_t i = 0; i < count; ++i) {
        const SurfaceSample sample = nearestSurface(collider->collider, pointAt(points, i));
        samples[i].distance = sample.distance;
        put(sample.normal, samples[i].normal);
        samples[i].map = sample.map;
    }
}

// --- colliders, on the GPU

relief_textures* relief_textures_create(const relief_collider* collider) {
    return guarded<relief_textures*>(nullptr, [&]() -> Result<relief_textures*> {
        auto textures = RELIEF_TRY(ColliderTextures::create(collider->collider));
        std::string core = RELIEF_TRY(shaderText("collider.glsl"));
        std::string glsl = textures.defines() + core;
        return new relief_textures{std::move(textures), std::move(glsl)};
    });
}

void relief_textures_free(relief_textures* textures) {
    delete textures;
}

const char* relief_textures_glsl(const relief_textures* textures) {
    return textures->glsl.c_str();
}

void relief_textures_attach(const relief_textures* textures, uint32_t program, int first_unit,
                            int uniform_block) {
    textures->textures.attach(program, {first_unit, uniform_block});
}

void relief_textures_bind(const relief_textures* textures, int first_unit, int uniform_block) {
    textures->textures.bind({first_unit, uniform_block});
}

// --- particles

relief_particles* relief_particles_create(const relief_textures* textures,
                                          const relief_particles_options* options) {
    return guarded<relief_particles*>(nullptr, [&]() -> Result<relief_particles*> {
        const relief_particles_options all = known(options);
        auto system =
            RELIEF_TRY(ParticleSystem::create({.capacity = all.capacity == 0 ? 65536 : all.capacity}));
        RELIEF_TRY(system.setCollider(textures == nullptr ? nullptr : &textures->textures));
        RELIEF_TRY(apply(all, system));
        return new relief_particles{std::move(system), {}};
    });
}

void relief_particles_free(relief_particles* particles) {
    delete particles;
}

int relief_particles_set(relief_particles* particles, const relief_particles_options* options) {
    return guarded(-1, [&]() -> Result<int> {
        RELIEF_TRY(apply(known(options), particles->system));
        return 0;
    });
}

size_t relief_particles_spawn(relief_particles* particles, const relief_birth* births, size_t count) {
    return guarded<std::size_t>(0, [&]() -> Result<std::size_t> {
        particles->births.clear();
        for (const relief_birth& birth : std::span(births, count)) {
            particles->births.push_back(
                {vec(birth.position), vec(birth.velocity), birth.lifetime, birth.type});
        }
        return particles->system.spawn(particles->births);
    });
}

int relief_particles_step(relief_particles* particles, float seconds) {
    return guarded(-1, [&]() -> Result<int> {
        if (!(seconds > 0.0F && seconds < 1e9F)) {
            return fail(ErrorCode::kUsage, "a step takes more than 0 seconds");
        }
        RELIEF_TRY(particles->system.step(seconds));
        RELIEF_TRY(checkGpu("stepping particles"));
        return 0;
    });
}

relief_counts relief_particles_counts(const relief_particles* particles) {
    const ParticleCounts counts = particles->system.counts();
    return {counts.born, counts.died, counts.refused, counts.alive};
}

int64_t relief_particles_read(const relief_particles* particles, relief_particle* out, size_t room) {
    return guarded<int64_t>(-1, [&]() -> Result<int64_t> {
        const auto states = RELIEF_TRY(particles->system.readState());
        for (std::size_t i = 0; i < std::min(room, states.size()); ++i) {
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

// --- pictures

relief_picture* relief_picture_create(const relief_textures* textures, const relief_collider* collider) {
    return guarded<relief_picture*>(nullptr, [&]() -> Result<relief_picture*> {
        std::optional<ColliderView> view;
        float diameter = 0.01F;
        if (textures != nullptr && collider != nullptr) {
            const Collider& body = collider->collider;
            view = ColliderView{&textures->textures, body.bounds, finestTexel(body)};
            diameter = 0.01F * body.bounds.longestSide();
        }
        auto renderer = RELIEF_TRY(ParticleRenderer::create(view));
        return new relief_picture{std::move(renderer), diameter};
    });
}

void relief_picture_free(relief_picture* picture) {
    delete picture;
}

int relief_picture_draw(relief_picture* picture, const relief_particles* particles,
                        const relief_picture_options* options, const relief_view* view) {
    return guarded(-1, [&]() -> Result<int> {
        const relief_picture_options style = known(options);
        const relief_view from = known(view);
        glm::mat4 view_matrix;
        glm::mat4 projection;
        std::memcpy(&view_matrix, from.view, sizeof(view_matrix));
        std::memcpy(&projection, from.projection, sizeof(projection));
        const glm::vec3 color = vec(style.color);
        ParticleStyle drawn;
        drawn.diameter = style.diameter > 0.0F ? style.diameter : picture->diameter;
        drawn.color = color == glm::vec3(0.0F) ? glm::vec3(1.0F) : color;
        drawn.opacity = style.opacity > 0.0F ? style.opacity : 0.95F;
        RELIEF_TRY(picture->renderer.draw(particles->system, CameraMatrices(view_matrix, projection), drawn,
                                          {from.framebuffer, from.width, from.height, from.srgb != 0}));
        return 0;
    });
}
