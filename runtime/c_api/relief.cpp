#include "runtime/c_api/relief.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/base/finite.h"
#include "formats/container.h"
#include "formats/nearest_surface.h"
#include "runtime/c_api/call.h"
#include "runtime/collider/collider_textures.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/gl_object.h"
#include "runtime/particles/particle_system.h"
#include "runtime/picture/particle_renderer.h"

namespace relief {
namespace {

struct TexturesObject {
    ColliderTextures textures;
    std::string glsl;
    GLint units = 0;   // texture units of the context
    GLint blocks = 0;  // uniform block bindings
};

struct ParticlesObject {
    std::shared_ptr<const TexturesObject> textures;  // outlives the system, which points to it; may be null
    ParticleSystem system;
    std::vector<Birth> births;  // of a call, kept for its memory
};

struct PictureObject {
    std::shared_ptr<const TexturesObject> textures;  // as above
    ParticleRenderer renderer;
    float diameter = 0.01F;
};

}  // namespace

template <>
struct HandleType<relief_textures> {
    using Object = TexturesObject;
    static constexpr HandleKind kKind = HandleKind::kTextures;
    static constexpr const char* kName = "relief_textures";
};
template <>
struct HandleType<relief_particles> {
    using Object = ParticlesObject;
    static constexpr HandleKind kKind = HandleKind::kParticles;
    static constexpr const char* kName = "relief_particles";
};
template <>
struct HandleType<relief_picture> {
    using Object = PictureObject;
    static constexpr HandleKind kKind = HandleKind::kPicture;
    static constexpr const char* kName = "relief_picture";
};

}  // namespace relief

using namespace relief;  // NOLINT: what C sees has C's names

namespace {

// As relief.h has them. Speeds beyond 10^15 are those of particles that are lost (isLost()).
constexpr FieldRange kAny{-1e15, 1e15};
constexpr FieldRange kNotNegative{0.0, 1e15};
constexpr FieldRange kShare{0.0, 1.0};
constexpr FieldRange kLifetime{0.0, 1e15, false};
constexpr FieldRange kStep{0.0, 1e9, false};
constexpr FieldRange kPixels{0.0, 65536.0};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

glm::vec3 vec(const float (&v)[3]) {
    return {v[0], v[1], v[2]};
}

void put(const glm::vec3& v, float (&out)[3]) {
    std::copy_n(&v.x, 3, out);
}

glm::vec3 pointAt(const float* points, std::size_t i) {
    return {points[3 * i], points[3 * i + 1], points[3 * i + 2]};
}

/// Frees an object. The context must be current if GL names go with it: all but colliders have some.
template <class H>
void release(const char* function, H* handle, const char* argument) noexcept {
    answer(function, false, [&](const Call& call) -> Result<bool> {
        if (handle != nullptr) {
            [[maybe_unused]] const auto* object = RELIEF_TRY(call.object(handle, argument));
            if (HandleType<H>::kKind != HandleKind::kCollider) {
                RELIEF_TRY(call.context());
            }
            [[maybe_unused]] const auto last =
                handleTable().remove(HandleType<H>::kKind, reinterpret_cast<std::uintptr_t>(handle));
        }
        return true;
    });
}

/// Answers each point by answer(collider, point); where that cannot be, by NaN.
template <class F>
void query(const char* function, const relief_collider* collider, const float* points, std::size_t count,
           relief_sample* samples, const F& sampleAt) {
    const auto unknown = [&](std::size_t i) { samples[i] = {kNan, {0.0F, 0.0F, 0.0F}, -1}; };
    answer(function, false, [&](const Call& call) -> Result<bool> {
        RELIEF_TRY(call.array(samples, "samples", count, "count"));
        for (std::size_t i = 0; i < count; ++i) {
            unknown(i);
        }
        RELIEF_TRY(call.array(points, "points", count, "count"));
        const Collider& field = *RELIEF_TRY(call.object(collider, "collider"));
        std::size_t wrong = count;
        for (std::size_t i = 0; i < count; ++i) {
            const glm::vec3 point = pointAt(points, i);
            if (!isFinite(point)) {
                wrong = std::min(wrong, i);
                continue;
            }
            const auto sample = sampleAt(field, point);
            samples[i].distance = sample.distance;
            put(sample.normal, samples[i].normal);
            samples[i].map = sample.map;
        }
        if (wrong < count) {
            return call.refuse("points[" + std::to_string(wrong) + "] is not finite");
        }
        return true;
    });
}

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
    RELIEF_TRY(call.number(all.restitution, kShare, name("restitution")));
    RELIEF_TRY(call.number(all.friction, kShare, name("friction")));
    RELIEF_TRY(call.number(all.radius, kNotNegative, name("radius")));
    RELIEF_TRY(call.number(all.has_ground, kShare, name("has_ground")));
    RELIEF_TRY(call.number(all.ground_height, kAny, name("ground_height")));
    return all;
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

Result<Birth> birthOf(const Call& call, const relief_birth& birth, std::size_t i) {
    const auto name = [i](const char* field) { return NumberName{"births", i, field}; };
    RELIEF_TRY(call.number(birth.position, kAny, name("position")));
    RELIEF_TRY(call.number(birth.velocity, kAny, name("velocity")));
    RELIEF_TRY(call.number(birth.lifetime, kLifetime, name("lifetime")));
    RELIEF_TRY(call.number(birth.type, {0.0, kBirthTypeMax}, name("type")));
    return Birth{vec(birth.position), vec(birth.velocity), birth.lifetime, birth.type};
}

/// The binding of the collider in a program's own shader.
Result<ColliderTextures::Binding> bindingOf(const Call& call, const TexturesObject& textures, int first_unit,
                                            int uniform_block) {
    RELIEF_TRY(call.number(first_unit, {0.0, static_cast<double>(textures.units - 3)}, {"first_unit"}));
    RELIEF_TRY(
        call.number(uniform_block, {0.0, static_cast<double>(textures.blocks - 1)}, {"uniform_block"}));
    return ColliderTextures::Binding{first_unit, uniform_block};
}

Result<ParticleStyle> styleOf(const Call& call, const relief_picture_options* given,
                              const PictureObject& picture) {
    relief_picture_options all{};
    if (given != nullptr) {
        all = RELIEF_TRY(call.structure(given, "options", "relief_picture_options"));
    }
    const auto name = [](const char* field) { return NumberName{.argument = "options", .field = field}; };
    RELIEF_TRY(call.number(all.diameter, kNotNegative, name("diameter")));
    RELIEF_TRY(call.number(all.color, kShare, name("color")));
    RELIEF_TRY(call.number(all.opacity, kShare, name("opacity")));
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
    RELIEF_TRY(call.number(all.srgb, kShare, name("srgb")));
    if (all.projection[5] == 0.0F) {
        return call.refuse("view->projection is no perspective: its number 5 is 0");
    }
    if (all.framebuffer != 0 && glIsFramebuffer(all.framebuffer) == GL_FALSE) {
        return call.refuse("view->framebuffer is " + std::to_string(all.framebuffer) +
                           ", which is no framebuffer of the context");
    }
    return all;
}

}  // namespace

int relief_api_version() {
    return RELIEF_API_VERSION;
}

const char* relief_version() {
    return RELIEF_VERSION;
}

const char* relief_error() {
    callErrors().read();
    return callErrors().last();
}

uint64_t relief_error_count() {
    return callErrors().count();
}

// --- colliders, on the CPU

relief_collider* relief_collider_load(const char* path) {
    return create<relief_collider>(__func__, [&](const Call& call) -> Result<std::shared_ptr<Collider>> {
        RELIEF_TRY(call.notNull(path, "path"));
        return std::make_shared<Collider>(RELIEF_TRY(loadCollider(path)));
    });
}

relief_collider* relief_collider_read(const void* bytes, size_t size) {
    return create<relief_collider>(__func__, [&](const Call& call) -> Result<std::shared_ptr<Collider>> {
        const auto* first = static_cast<const std::byte*>(bytes);
        RELIEF_TRY(call.array(first, "bytes", size, "size"));
        return std::make_shared<Collider>(RELIEF_TRY(readContainer({first, size})));
    });
}

void relief_collider_free(relief_collider* collider) {
    release(__func__, collider, "collider");
}

void relief_collider_bounds(const relief_collider* collider, float min[3], float max[3]) {
    answer(__func__, false, [&](const Call& call) -> Result<bool> {
        for (float* out : {min, max}) {
            if (out != nullptr) {
                std::fill_n(out, 3, kNan);
            }
        }
        const Bounds& bounds = RELIEF_TRY(call.object(collider, "collider"))->bounds;
        RELIEF_TRY(call.notNull(min, "min"));
        RELIEF_TRY(call.notNull(max, "max"));
        std::copy_n(&bounds.min.x, 3, min);
        std::copy_n(&bounds.max.x, 3, max);
        return true;
    });
}

size_t relief_collider_map_count(const relief_collider* collider) {
    return answer(__func__, std::size_t{0}, [&](const Call& call) -> Result<std::size_t> {
        return RELIEF_TRY(call.object(collider, "collider"))->maps.size();
    });
}

const char* relief_collider_unit(const relief_collider* collider) {
    return answer(__func__, "", [&](const Call& call) -> Result<const char*> {
        return RELIEF_TRY(call.object(collider, "collider"))->unit.c_str();
    });
}

void relief_collider_query(const relief_collider* collider, const float* points, size_t count,
                           relief_sample* samples) {
    query(__func__, collider, points, count, samples,
          [](const Collider& field, const glm::vec3& point) { return evaluate(field, point); });
}

void relief_collider_nearest(const relief_collider* collider, const float* points, size_t count,
                             relief_sample* samples) {
    query(__func__, collider, points, count, samples,
          [](const Collider& field, const glm::vec3& point) { return nearestSurface(field, point); });
}

// --- colliders, on the GPU

relief_textures* relief_textures_create(const relief_collider* collider) {
    return create<relief_textures>(__func__,
                                   [&](const Call& call) -> Result<std::shared_ptr<TexturesObject>> {
                                       const Collider& field = *RELIEF_TRY(call.object(collider, "collider"));
                                       RELIEF_TRY(call.context());
                                       auto textures = RELIEF_TRY(ColliderTextures::create(field));
                                       std::string core = RELIEF_TRY(shaderText("collider/collider.glsl"));
                                       std::string glsl = textures.defines() + core;
                                       TexturesObject made{std::move(textures), std::move(glsl)};
                                       glGetIntegerv(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS, &made.units);
                                       glGetIntegerv(GL_MAX_UNIFORM_BUFFER_BINDINGS, &made.blocks);
                                       return std::make_shared<TexturesObject>(std::move(made));
                                   });
}

void relief_textures_free(relief_textures* textures) {
    release(__func__, textures, "textures");
}

const char* relief_textures_glsl(const relief_textures* textures) {
    return answer(__func__, "", [&](const Call& call) -> Result<const char*> {
        return RELIEF_TRY(call.object(textures, "textures"))->glsl.c_str();
    });
}

void relief_textures_attach(const relief_textures* textures, uint32_t program, int first_unit,
                            int uniform_block) {
    answer(__func__, false, [&](const Call& call) -> Result<bool> {
        const TexturesObject& from = *RELIEF_TRY(call.object(textures, "textures"));
        RELIEF_TRY(call.context());
        const auto binding = RELIEF_TRY(bindingOf(call, from, first_unit, uniform_block));
        GLint linked = GL_FALSE;
        if (glIsProgram(program) == GL_TRUE) {
            glGetProgramiv(program, GL_LINK_STATUS, &linked);
        }
        if (linked != GL_TRUE) {
            return call.refuse("program is " + std::to_string(program) +
                               ", which is no program of the context that is linked");
        }
        from.textures.attach(program, binding);
        return true;
    });
}

void relief_textures_bind(const relief_textures* textures, int first_unit, int uniform_block) {
    answer(__func__, false, [&](const Call& call) -> Result<bool> {
        const TexturesObject& from = *RELIEF_TRY(call.object(textures, "textures"));
        RELIEF_TRY(call.context());
        from.textures.bind(RELIEF_TRY(bindingOf(call, from, first_unit, uniform_block)));
        return true;
    });
}

// --- particles

relief_particles* relief_particles_create(const relief_textures* textures,
                                          const relief_particles_options* options) {
    return create<relief_particles>(
        __func__, [&](const Call& call) -> Result<std::shared_ptr<ParticlesObject>> {
            const auto among = RELIEF_TRY(call.optional(textures, "textures"));
            const relief_particles_options all = RELIEF_TRY(optionsOf(call, options));
            RELIEF_TRY(call.context());
            auto system =
                RELIEF_TRY(ParticleSystem::create({.capacity = all.capacity == 0 ? 65536 : all.capacity}));
            RELIEF_TRY(system.setCollider(among ? &among->textures : nullptr));
            RELIEF_TRY(apply(all, system));
            return std::make_shared<ParticlesObject>(ParticlesObject{among, std::move(system), {}});
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
        return relief_counts{counts.born, counts.died, counts.refused, counts.alive};
    });
}

int64_t relief_particles_read(const relief_particles* particles, relief_particle* out, size_t room) {
    return answer(__func__, int64_t{-1}, [&](const Call& call) -> Result<int64_t> {
        const ParticlesObject& of = *RELIEF_TRY(call.object(particles, "particles"));
        RELIEF_TRY(call.array(out, "out", room, "room"));
        RELIEF_TRY(call.context());
        const auto states = RELIEF_TRY(of.system.readState());
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
    return create<relief_picture>(__func__, [&](const Call& call) -> Result<std::shared_ptr<PictureObject>> {
        const auto among = RELIEF_TRY(call.optional(textures, "textures"));
        const auto field = RELIEF_TRY(call.optional(collider, "collider"));
        if ((among == nullptr) != (field == nullptr)) {
            return call.refuse(std::string(among ? "collider" : "textures") +
                               " is NULL; give the textures and the collider that they are of, or neither");
        }
        RELIEF_TRY(call.context());
        std::optional<ColliderView> view;
        float diameter = 0.01F;
        if (among) {
            view = ColliderView{&among->textures, field->bounds, finestTexel(*field)};
            diameter = 0.01F * field->bounds.longestSide();
        }
        auto renderer = RELIEF_TRY(ParticleRenderer::create(view));
        return std::make_shared<PictureObject>(PictureObject{among, std::move(renderer), diameter});
    });
}

void relief_picture_free(relief_picture* picture) {
    release(__func__, picture, "picture");
}

int relief_picture_draw(relief_picture* picture, const relief_particles* particles,
                        const relief_picture_options* options, const relief_view* view) {
    return answer(__func__, -1, [&](const Call& call) -> Result<int> {
        PictureObject& by = *RELIEF_TRY(call.object(picture, "picture"));
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
