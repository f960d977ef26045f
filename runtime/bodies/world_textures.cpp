// SPDX-License-Identifier: Apache-2.0
#include "runtime/bodies/world_textures.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "formats/base/finite.h"
#include "runtime/collider/collider_textures.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "runtime/layout/gpu_image.h"

namespace relief {
namespace {

/// Returns whether each body has exactly one map of patches, which BodyTable can place in world space.
bool arePlaced(std::span<const PlacedMap> maps, std::span<const TableBody> bodies) {
    return std::all_of(bodies.begin(), bodies.end(), [&](const TableBody& body) {
        return body.maps == 1 && maps[body.first_map].map->format == MapFormat::kPatches;
    });
}

}  // namespace

Result<WorldTextures> WorldTextures::create(const Collider& collider) {
    auto bare = RELIEF_TRY(ColliderTextures::create(collider));
    WorldTextures result;
    result.defines_ = bare.defines();
    result.maps_ = std::move(bare).takeMaps();
    const PassState state;
    clearGlErrors();
    const Materials* const materials = &collider.materials;
    RELIEF_TRY(result.uploadMaterials(std::span(&materials, 1)));
    RELIEF_TRY(
        checkAllocated("the collider's " + std::to_string(result.material_bytes_) + " bytes of materials",
                       "bake it with --materials drop"));
    return result;
}

Result<WorldTextures> WorldTextures::create(std::span<const ColliderBody> bodies, std::size_t room_texels) {
    if (bodies.size() > kBodiesMax) {
        return fail(ErrorCode::kLimit, std::to_string(bodies.size()) + " bodies exceed the limit of " +
                                           std::to_string(kBodiesMax) + "; merge some of them in one bake");
    }
    std::vector<PlacedMap> maps;
    std::vector<TableBody> placed;
    std::vector<const Materials*> materials;
    std::map<const Collider*, std::size_t> known;  // the first body with each collider
    for (const ColliderBody& body : bodies) {
        if (!(body.pose.scale > 0.0F)) {
            return fail(ErrorCode::kUsage, "the scale of a collider must be above 0");
        }
        if (!isFinite(body.pose.position) ||
            !std::isfinite(glm::dot(body.pose.rotation, body.pose.rotation)) ||
            !std::isfinite(body.pose.scale) || !isFraction(body.restitution) || !isFraction(body.friction)) {
            return fail(ErrorCode::kUsage,
                        "the pose of a collider must be finite, and its restitution and friction must be "
                        "from 0 to 1");
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
        // Live bodies do not share texels.
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

void WorldTextures::setPoses(std::span<const Pose> poses) {
    if (world_) {
        revision_ += world_->bodies.setPoses(poses) ? 1 : 0;
        updateWorld();
    }
}

std::size_t WorldTextures::maxTexels() {
    const auto side = static_cast<std::size_t>(MapTextures::sideMax());
    return side * side;
}

void WorldTextures::upload(std::size_t first, std::span<const std::byte> texels) {
    const std::size_t texel_size = texelFormat(kFrontBackTexels).texel_size;
    const std::size_t width = rowTexels();
    const std::size_t end = first + texels.size() / texel_size;
    const PassState state;  // resets row lengths and skips, so that texels are tightly packed
    useTexture(0, maps_[kFrontBackTexels]);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, world_->upload.name());
    glBufferData(GL_PIXEL_UNPACK_BUFFER, static_cast<GLsizeiptr>(texels.size()), texels.data(),
                 GL_STREAM_DRAW);
    // Copy the end of a row, whole rows, and the start of a row.
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

Result<void> WorldTextures::exchange(std::size_t body, const Collider& collider,
                                     std::optional<std::size_t> first) {
    const TableBody& of = world_->bodies[body];
    const bool patches = collider.maps.size() == 1 && collider.maps[0].format == MapFormat::kPatches;
    if (!patches || of.maps != 1) {
        return fail(ErrorCode::kUnsupported,
                    "only colliders with a single map of patches can be streamed; bake again without "
                    "--holes keep, --map and --paper");
    }
    MapPlace place = places_[of.first_map];
    place.first = first.value_or(place.first);
    if (!world_->bodies.setMap(of.first_map, blockMap({collider.maps.data(), false}, place),
                               insideBox(collider))) {
        return fail(ErrorCode::kUnsupported,
                    "its map differs in format, encloses or empty_is_outside from the map that it replaces; "
                    "bake the world again");
    }
    ++revision_;
    updateWorld();
    return {};
}

void WorldTextures::reach(float radius) const {
    if (world_) {
        world_->bodies.setReach(radius);
        updateWorld();
    }
}

void WorldTextures::updateWorld() const {
    BodyTable& bodies = world_->bodies;
    const bool is_new = bodies.isNew();
    const std::vector<BodyTable::Rows> changes = bodies.takeChanges();
    if (changes.empty()) {
        return;
    }
    const PassState state;  // resets row lengths and skips, so that texels are tightly packed
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
            // Upload through a new buffer, so that the upload does not wait for a step that still reads the texture.
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
    maps_.setBlock(std::as_bytes(std::span(block)));
}

Result<WorldTextures> WorldTextures::upload(std::span<const PlacedMap> maps, std::vector<TableBody> bodies,
                                            std::span<const Materials* const> materials,
                                            std::size_t room_texels) {
    RELIEF_TRY(checkContext());
    const MapLayout layout = RELIEF_TRY(MapLayout::create(maps, MapTextures::sideMax(), room_texels));
    WorldTextures result;
    result.places_ = layout.places;
    result.room_ = layout.room;
    result.room_log2_width_ = layout.textures[kFrontBackTexels].log2Width();
    const bool placed = arePlaced(maps, bodies);
    result.defines_ = "#define RELIEF_BODIES 1\n#define RELIEF_PLACED " + std::to_string(placed ? 1 : 0) +
                      "\n" + mapDefines(maps, layout);

    const PassState state;  // resets row lengths and skips, so that texels are tightly packed
    clearGlErrors();
    result.maps_ = MapTextures(maps, layout);
    RELIEF_TRY(result.uploadMaterials(materials));
    result.world_ =
        std::make_unique<World>(World{BodyTable(blockMaps(maps, layout), std::move(bodies), placed),
                                      blockHead(maps, layout),
                                      {},
                                      makeBuffer()});
    const std::uint64_t width = std::uint64_t{1} << result.world_->bodies.log2Width();
    RELIEF_TRY(checkTextureSize(width, result.world_->bodies.words().size() / width,
                                "the bodies of this world", "place fewer bodies"));
    result.updateWorld();
    RELIEF_TRY(checkAllocated("the collider's " + std::to_string(result.bytes()) + " bytes of maps",
                              "bake it with fewer maps"));
    return result;
}

Result<void> WorldTextures::uploadMaterials(std::span<const Materials* const> bodies) {
    materials_ = makeMaterialTable(bodies);
    if (materials_.names.empty()) {
        return {};
    }
    const std::size_t width = std::size_t{1} << materials_.log2_width;
    const std::size_t height = materials_.texels.size() / width;
    RELIEF_TRY(checkTextureSize(width, height, "the materials of these colliders",
                                "bake some with --materials drop"));
    material_texture_ = makeTexture2D(GL_RGBA32UI, static_cast<GLsizei>(width), static_cast<GLsizei>(height),
                                      GL_RGBA_INTEGER, GL_UNSIGNED_INT, materials_.texels.data());
    material_bytes_ = materials_.texels.size() * sizeof(glm::uvec4);
    materials_.texels = {};
    return {};
}

std::string WorldTextures::materialDefines() const {
    if (materials_.names.empty()) {
        return {};
    }
    return "#define RELIEF_MATERIALS " + std::to_string(materials_.names.size()) +
           "\n#define RELIEF_MATERIALS_LOG2_WIDTH " + std::to_string(materials_.log2_width) +
           "\n#define RELIEF_MATERIAL_BRICKS " + std::to_string(materials_.bricks) + "\n" +
           (materials_.loses ? "#define RELIEF_MATERIAL_LOSS\n" : "");
}

std::vector<LiveSlot> WorldTextures::liveSlots(std::size_t body) const {
    std::vector<LiveSlot> slots;
    if (body >= bodyCount() || !world_->bodies[body].live) {
        return slots;
    }
    const std::size_t first = world_->bodies[body].first_map;
    for (std::size_t m = first; m < first + world_->bodies[body].maps; ++m) {
        const MapPlace& place = places_[m];
        slots.push_back({&maps_[place.kind], place.texels.x, place.texels.y, &maps_[kFloatTexels],
                         place.motion.x, place.motion.y});
    }
    return slots;
}

void WorldTextures::attach(GLuint program, const Binding& binding) const {
    maps_.attach(program, binding);
    if (world_) {
        glUniform1i(glGetUniformLocation(program, "u_relief_world"), binding.world_unit);
    }
    if (material_texture_) {
        glUniform1i(glGetUniformLocation(program, "u_relief_materials"), binding.material_unit);
        glUniform4fv(glGetUniformLocation(program, "u_relief_material_cube"), 1, &materials_.head.cube.x);
        glUniform4iv(glGetUniformLocation(program, "u_relief_material_grids"), 1, &materials_.head.grids.x);
    }
}

void WorldTextures::bind(const Binding& binding) const {
    maps_.bind(binding);
    if (world_) {
        useTexture(binding.world_unit, world_->texture);
    }
}

void WorldTextures::bindMaterials(const Binding& binding) const {
    if (material_texture_) {
        useTexture(binding.material_unit, material_texture_);
    }
}

}  // namespace relief
