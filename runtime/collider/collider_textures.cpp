// SPDX-License-Identifier: Apache-2.0
#include "runtime/collider/collider_textures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/base/finite.h"
#include "runtime/collider/material_table.h"
#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "runtime/layout/gpu_image.h"

namespace relief {
namespace {

GLint integer(GLenum what) {
    GLint value = 0;
    glGetIntegerv(what, &value);
    return value;
}

/// Of the block; a world has a texture.
Result<void> checkMapCount(std::size_t maps, bool world) {
    if (maps == 0) {
        return fail(ErrorCode::kUnsupported, "a collider without maps has nothing to collide with");
    }
    const std::size_t map_max = mapsInBlock(static_cast<std::size_t>(integer(GL_MAX_UNIFORM_BLOCK_SIZE)));
    if (!world && maps > map_max) {
        return fail(ErrorCode::kLimit, "the collider has " + std::to_string(maps) + " maps, this GL takes " +
                                           std::to_string(map_max) + "; bake it with fewer");
    }
    return {};
}

/// Each body has one map of patches, which BodyTable places in the world.
bool arePlaced(std::span<const PlacedMap> maps, std::span<const TableBody> bodies) {
    return std::all_of(bodies.begin(), bodies.end(), [&](const TableBody& body) {
        return body.maps == 1 && maps[body.first_map].map->format == MapFormat::kPatches;
    });
}

}  // namespace

Result<ColliderTextures> ColliderTextures::create(const Collider& collider) {
    std::vector<PlacedMap> maps;
    for (const DepthMap& map : collider.maps) {
        maps.push_back({&map, false});
    }
    const Materials* const materials = &collider.materials;
    return upload(maps, {}, std::span(&materials, 1));
}

Result<ColliderTextures> ColliderTextures::create(std::span<const ColliderBody> bodies,
                                                  std::size_t room_texels) {
    if (bodies.size() > kBodiesMax) {
        return fail(ErrorCode::kLimit, std::to_string(bodies.size()) + " bodies are more than " +
                                           std::to_string(kBodiesMax) + "; bake some of them into one");
    }
    const auto share = [](float value) { return value >= 0.0F && value <= 1.0F; };
    std::vector<PlacedMap> maps;
    std::vector<TableBody> placed;
    std::vector<const Materials*> materials;
    std::map<const Collider*, std::size_t> known;  // their first bodies
    for (const ColliderBody& body : bodies) {
        if (!(body.pose.scale > 0.0F)) {
            return fail(ErrorCode::kUsage, "the scale of a collider must be above 0");
        }
        if (!isFinite(body.pose.position) ||
            !std::isfinite(glm::dot(body.pose.rotation, body.pose.rotation)) ||
            !std::isfinite(body.pose.scale) || !share(body.restitution) || !share(body.friction)) {
            return fail(ErrorCode::kUsage,
                        "the pose of a collider must be finite, its restitution and friction from 0 to 1");
        }
        const std::uint32_t number = static_cast<std::uint32_t>(placed.size());
        const std::uint32_t group = body.group.value_or(std::min(number, kGroups - 1));
        if (group >= kGroups) {
            return fail(ErrorCode::kUsage,
                        "the group of a body must be from 0 to " + std::to_string(kGroups - 1));
        }
        TableBody& added = placed.emplace_back();
        added.pose = body.pose;
        added.restitution = body.restitution;
        added.friction = body.friction;
        added.live = body.live;
        added.group = group;
        materials.push_back(body.live ? nullptr : &body.collider->materials);
        // A live one has texels of its own.
        const auto same = body.live ? known.end() : known.find(body.collider);
        if (same == known.end()) {
            added.box = insideBox(*body.collider);
            added.first_map = static_cast<std::uint32_t>(maps.size());
            added.maps = static_cast<std::uint32_t>(body.collider->maps.size());
            for (const DepthMap& map : body.collider->maps) {
                maps.push_back({&map, body.live});
            }
        } else {
            added.box = placed[same->second].box;
            added.first_map = placed[same->second].first_map;
            added.maps = placed[same->second].maps;
        }
        if (!body.live) {
            known.try_emplace(body.collider, number);
        }
    }
    return upload(maps, std::move(placed), materials, room_texels);
}

void ColliderTextures::setPoses(std::span<const Pose> poses) {
    if (world_) {
        revision_ += world_->bodies.setPoses(poses) ? 1 : 0;
        updateWorld();
    }
}

std::size_t ColliderTextures::texelsMost() {
    const auto side = static_cast<std::size_t>(integer(GL_MAX_TEXTURE_SIZE));
    return side * side;
}

void ColliderTextures::upload(std::size_t first, std::span<const std::byte> texels) {
    const std::size_t texel_size = texelFormat(kFrontBackTexels).texel_size;
    const std::size_t width = rowTexels();
    const std::size_t end = first + texels.size() / texel_size;
    const PassState state;  // row lengths and skips among it: texels are tightly packed
    useTexture(0, textures_[kFrontBackTexels]);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, world_->upload.name());
    glBufferData(GL_PIXEL_UNPACK_BUFFER, static_cast<GLsizeiptr>(texels.size()), texels.data(),
                 GL_STREAM_DRAW);
    // The end of a row, whole rows, and the beginning of one.
    for (std::size_t at = first; at < end;) {
        const std::size_t x = at % width;
        const std::size_t rows = x == 0 ? std::max<std::size_t>((end - at) / width, 1) : 1;
        const std::size_t columns = std::min(width - x, end - at);
        glTexSubImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(x), static_cast<GLint>(at / width),
                        static_cast<GLsizei>(columns), static_cast<GLsizei>(rows), GL_RGBA_INTEGER,
                        GL_UNSIGNED_SHORT, reinterpret_cast<const void*>((at - first) * texel_size));
        at += rows * columns;
    }
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

Result<void> ColliderTextures::exchange(std::size_t body, const Collider& collider,
                                        std::optional<std::size_t> first) {
    const TableBody& of = world_->bodies[body];
    const bool patches = collider.maps.size() == 1 && collider.maps[0].format == MapFormat::kPatches;
    const PlacedMap map{patches ? collider.maps.data() : nullptr, false};
    MapPlace place = places_[of.first_map];
    place.first = first.value_or(place.first);
    if (!patches || of.maps != 1 ||
        !world_->bodies.setMap(of.first_map, blockMap(map, place), insideBox(collider))) {
        return fail(ErrorCode::kUnsupported,
                    "only maps of patches come and go while they are used; bake them anew, without --map, "
                    "--paper and --holes keep");
    }
    ++revision_;
    updateWorld();
    return {};
}

void ColliderTextures::reach(float radius) const {
    if (world_) {
        world_->bodies.setReach(radius);
        updateWorld();
    }
}

void ColliderTextures::updateWorld() const {
    BodyTable& bodies = world_->bodies;
    const bool is_new = bodies.isNew();
    const std::vector<BodyTable::Rows> changes = bodies.takeChanges();
    if (changes.empty()) {
        return;
    }
    const PassState state;  // row lengths and skips among it: texels are tightly packed
    const std::span<const glm::uvec4> words = bodies.words();
    const std::size_t width = std::size_t{1} << bodies.log2Width();
    if (is_new) {
        world_->texture = makeTexture2D(GL_RGBA32UI, static_cast<GLsizei>(width),
                                        static_cast<GLsizei>(words.size() / width), GL_RGBA_INTEGER,
                                        GL_UNSIGNED_INT, words.data());
    } else {
        useTexture(0, world_->texture);
        glBindBuffer(GL_PIXEL_UNPACK_BUFFER, world_->upload.name());
        for (const auto& [first, end] : changes) {
            // By way of a new buffer: the step before may still read the texture, and this must not wait for it.
            const std::span<const glm::uvec4> rows = words.subspan(first * width, (end - first) * width);
            glBufferData(GL_PIXEL_UNPACK_BUFFER, static_cast<GLsizeiptr>(rows.size_bytes()), rows.data(),
                         GL_STREAM_DRAW);
            glTexSubImage2D(GL_TEXTURE_2D, 0, 0, static_cast<GLint>(first), static_cast<GLsizei>(width),
                            static_cast<GLsizei>(end - first), GL_RGBA_INTEGER, GL_UNSIGNED_INT, nullptr);
        }
        glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    }
    std::vector<glm::ivec4> block = bodies.block();
    block.insert(block.begin(), world_->head);
    glBindBuffer(GL_UNIFORM_BUFFER, block_.name());
    glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(block.size() * sizeof(glm::ivec4)), block.data(),
                 GL_DYNAMIC_DRAW);
}

Result<ColliderTextures> ColliderTextures::upload(std::span<const PlacedMap> maps,
                                                  std::vector<TableBody> bodies,
                                                  std::span<const Materials* const> materials,
                                                  std::size_t room_texels) {
    RELIEF_TRY(checkContext());
    const bool world = !bodies.empty();
    RELIEF_TRY(checkMapCount(maps.size(), world));
    const MapLayout layout = RELIEF_TRY(MapLayout::create(maps, integer(GL_MAX_TEXTURE_SIZE), room_texels));
    ColliderTextures result;
    result.places_ = layout.places;
    result.room_ = layout.room;
    result.room_log2_width_ = layout.textures[kFrontBackTexels].log2Width();
    result.map_count_ = static_cast<int>(maps.size());
    const bool placed = arePlaced(maps, bodies);
    result.defines_ = world ? "#define RELIEF_BODIES 1\n#define RELIEF_PLACED " +
                                  std::to_string(placed ? 1 : 0) + "\n" + mapDefines(maps, layout)
                            : colliderDefines(maps, layout);

    const PassState state;  // row lengths and skips among it: texels are tightly packed
    forgetGlErrors();
    const auto textures = mapTextures(maps, layout);
    for (std::size_t kind = 0; kind < kTexelKinds; ++kind) {
        const TexelFormat& format = texelFormat(static_cast<TexelKind>(kind));
        const GpuTexture& texture = textures[kind];
        result.textures_[kind] = makeTexture2D(format.internal_format, static_cast<GLsizei>(texture.width),
                                               static_cast<GLsizei>(texture.height), format.format,
                                               format.type, texture.texels.data());
        // One texel stands for a texture that no map uses.
        result.bytes_ += layout.textures[kind].height() == 0 ? 0 : texture.texels.size();
    }
    RELIEF_TRY(result.uploadMaterials(materials));
    result.block_ = makeBuffer();
    if (world) {
        result.world_ =
            std::make_unique<World>(World{BodyTable(blockMaps(maps, layout), std::move(bodies), placed),
                                          blockHead(maps, layout),
                                          {},
                                          makeBuffer()});
        const std::uint64_t width = std::uint64_t{1} << result.world_->bodies.log2Width();
        RELIEF_TRY(checkTextureSize(width, result.world_->bodies.words().size() / width,
                                    "the bodies of this world", "place fewer"));
        result.updateWorld();
    } else {
        const std::vector<std::byte> block = colliderBlock(maps, layout);
        glBindBuffer(GL_UNIFORM_BUFFER, result.block_.name());
        glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(block.size()), block.data(), GL_STATIC_DRAW);
    }
    RELIEF_TRY(checkAllocated("the collider's " + std::to_string(result.bytes_) + " bytes of maps",
                              "bake it with fewer"));
    return result;
}

Result<void> ColliderTextures::uploadMaterials(std::span<const Materials* const> bodies) {
    MaterialTable table = makeMaterialTable(bodies);
    if (table.names.empty()) {
        return {};
    }
    const std::size_t width = std::size_t{1} << table.log2_width;
    const std::size_t height = table.texels.size() / width;
    RELIEF_TRY(checkTextureSize(width, height, "the materials of these colliders",
                                "bake some with --materials none"));
    materials_ = makeTexture2D(GL_RGBA32UI, static_cast<GLsizei>(width), static_cast<GLsizei>(height),
                               GL_RGBA_INTEGER, GL_UNSIGNED_INT, table.texels.data());
    bytes_ += table.texels.size() * sizeof(glm::uvec4);
    materials_respond_ = table.responds;
    material_head_ = table.head;
    material_defines_ = "#define RELIEF_MATERIALS " + std::to_string(table.names.size()) +
                        "\n#define RELIEF_MATERIALS_LOG2_WIDTH " + std::to_string(table.log2_width) +
                        "\n#define RELIEF_MATERIAL_BRICKS " + std::to_string(table.bricks) + "\n" +
                        (table.loses ? "#define RELIEF_MATERIAL_LOSS\n" : "");
    material_names_ = std::move(table.names);
    return {};
}

std::vector<LiveSlot> ColliderTextures::liveSlots(std::size_t body) const {
    std::vector<LiveSlot> slots;
    if (body >= bodyCount() || !world_->bodies[body].live) {
        return slots;
    }
    const std::size_t first = world_->bodies[body].first_map;
    for (std::size_t m = first; m < first + world_->bodies[body].maps; ++m) {
        const MapPlace& place = places_[m];
        slots.push_back({&textures_[place.kind], place.texels.x, place.texels.y, &textures_[kFloatTexels],
                         place.motion.x, place.motion.y});
    }
    return slots;
}

void ColliderTextures::attach(GLuint program, const Binding& binding) const {
    glUseProgram(program);
    for (std::size_t kind = 0; kind < kTexelKinds; ++kind) {
        glUniform1i(glGetUniformLocation(program, texelFormat(static_cast<TexelKind>(kind)).sampler),
                    binding.first_unit + static_cast<GLint>(kind));
    }
    if (world_) {
        glUniform1i(glGetUniformLocation(program, "u_relief_world"), binding.world_unit);
    }
    if (materials_) {
        glUniform1i(glGetUniformLocation(program, "u_relief_materials"), binding.material_unit);
        glUniform4fv(glGetUniformLocation(program, "u_relief_material_cube"), 1, &material_head_.cube.x);
        glUniform4iv(glGetUniformLocation(program, "u_relief_material_grids"), 1, &material_head_.grids.x);
    }
    const GLuint index = glGetUniformBlockIndex(program, "ReliefCollider");
    if (index != GL_INVALID_INDEX) {
        glUniformBlockBinding(program, index, static_cast<GLuint>(binding.uniform_block));
    }
}

void ColliderTextures::bind(const Binding& binding) const {
    for (std::size_t kind = 0; kind < kTexelKinds; ++kind) {
        useTexture(binding.first_unit + static_cast<int>(kind), textures_[kind]);
    }
    if (world_) {
        useTexture(binding.world_unit, world_->texture);
    }
    glBindBufferBase(GL_UNIFORM_BUFFER, static_cast<GLuint>(binding.uniform_block), block_.name());
}

void ColliderTextures::bindMaterials(const Binding& binding) const {
    if (materials_) {
        useTexture(binding.material_unit, materials_);
    }
}

void ColliderTextures::bindStorage(int binding) const {
    StorageUnits::bind(static_cast<GLuint>(binding), block_);
}

}  // namespace relief
