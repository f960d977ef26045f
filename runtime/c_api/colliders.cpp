// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "formats/container.h"
#include "formats/nearest_surface.h"
#include "runtime/c_api/objects.h"
#include "runtime/gl/gl_functions.h"

using namespace relief;  // NOLINT: the C functions are outside of it

namespace {

/// Converts a FieldSample or a SurfaceSample.
template <class Sample>
relief_sample sampleOf(const Sample& from) {
    relief_sample sample{from.distance, {}, from.map};
    put(from.normal, sample.normal);
    return sample;
}

/// Validates texture units and the uniform block binding.
Result<WorldTextures::Binding> bindingOf(const Call& call, const TexturesObject& textures, int first_unit,
                                         int uniform_block) {
    const int units = textures.world ? 4 : 3;
    RELIEF_TRY(call.number(first_unit, {0.0, static_cast<double>(textures.units - units)}, {"first_unit"}));
    RELIEF_TRY(
        call.number(uniform_block, {0.0, static_cast<double>(textures.blocks - 1)}, {"uniform_block"}));
    return WorldTextures::Binding{first_unit, uniform_block, first_unit + 3};
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
    return create<relief_collider>(__func__, [&](const Call& call) -> Result<Collider> {
        RELIEF_TRY(call.notNull(path, "path"));
        return loadCollider(path);
    });
}

relief_collider* relief_collider_read(const void* bytes, size_t size) {
    return create<relief_collider>(__func__, [&](const Call& call) -> Result<Collider> {
        const auto* first = static_cast<const std::byte*>(bytes);
        RELIEF_TRY(call.array(first, "bytes", size, "size"));
        return readContainer({first, size});
    });
}

void relief_collider_free(relief_collider* collider) {
    release(__func__, collider, "collider");
}

void relief_collider_bounds(const relief_collider* collider, float min[3], float max[3]) {
    writeBounds(__func__, min, max, [&](const Call& call) -> Result<Bounds> {
        return RELIEF_TRY(call.object(collider, "collider"))->bounds;
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

size_t relief_collider_material_count(const relief_collider* collider) {
    return answer(__func__, std::size_t{0}, [&](const Call& call) -> Result<std::size_t> {
        return RELIEF_TRY(call.object(collider, "collider"))->materials.list.size();
    });
}

const char* relief_collider_material_name(const relief_collider* collider, size_t material) {
    return answer(__func__, "", [&](const Call& call) -> Result<const char*> {
        const std::vector<Material>& list = RELIEF_TRY(call.object(collider, "collider"))->materials.list;
        RELIEF_TRY(call.index(material, list.size(), "material", "materials"));
        return list[material].name.c_str();
    });
}

int64_t relief_collider_material_at(const relief_collider* collider, const float point[3],
                                    const float normal[3]) {
    return answer(__func__, int64_t{-1}, [&](const Call& call) -> Result<int64_t> {
        const Materials& materials = RELIEF_TRY(call.object(collider, "collider"))->materials;
        RELIEF_TRY(call.notNull(point, "point"));
        RELIEF_TRY(call.notNull(normal, "normal"));
        const glm::vec3 p = RELIEF_TRY(vectorOf(call, point, kAny, "point"));
        const glm::vec3 n = RELIEF_TRY(vectorOf(call, normal, kAny, "normal"));
        return materials.empty() ? int64_t{-1} : static_cast<int64_t>(materialAt(materials, p, n));
    });
}

void relief_collider_query(const relief_collider* collider, const float* points, size_t count,
                           relief_sample* samples) {
    query(__func__, collider, "collider", points, count, samples,
          [](const Collider& field, const glm::vec3& point) { return sampleOf(evaluate(field, point)); });
}

void relief_collider_nearest(const relief_collider* collider, const float* points, size_t count,
                             relief_sample* samples) {
    query(
        __func__, collider, "collider", points, count, samples,
        [](const Collider& field, const glm::vec3& point) { return sampleOf(nearestSurface(field, point)); });
}

// --- colliders, on the GPU

relief_textures* relief_textures_create(const relief_collider* collider) {
    return create<relief_textures>(__func__, [&](const Call& call) -> Result<TexturesObject> {
        const Collider& field = *RELIEF_TRY(call.object(collider, "collider"));
        RELIEF_TRY(call.context());
        auto textures = RELIEF_TRY(WorldTextures::create(field));
        return texturesObject(std::move(textures));
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
            return call.reject("program is " + std::to_string(program) +
                               "; pass a linked program of the current context");
        }
        from.textures().attach(program, binding);
        return true;
    });
}

void relief_textures_bind(const relief_textures* textures, int first_unit, int uniform_block) {
    answer(__func__, false, [&](const Call& call) -> Result<bool> {
        const TexturesObject& from = *RELIEF_TRY(call.object(textures, "textures"));
        RELIEF_TRY(call.context());
        from.textures().bind(RELIEF_TRY(bindingOf(call, from, first_unit, uniform_block)));
        return true;
    });
}
