#include "runtime/collider/collider_textures.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "runtime/collider/shader_texels.h"
#include "runtime/collider/texel_layout.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

/// The three texel layouts that the shader samples, each in a texture of its own.
struct Layout {
    const char* sampler;
    GLenum internal_format;
    GLenum format;
    GLenum type;
    std::size_t texel_size;
};
constexpr std::array<Layout, 3> kLayouts = {{
    {"u_relief_float", GL_RGBA32F, GL_RGBA, GL_FLOAT, 16},
    {"u_relief_fixed", GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4},
    {"u_relief_front_back", GL_RGBA16UI, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT, 8},
}};

constexpr std::size_t kFloatLayout = 0;

std::size_t layoutOf(MapFormat format) {
    switch (format) {
        case MapFormat::kFloat32:
            return 0;
        case MapFormat::kFrontBackHalf:
        case MapFormat::kFrontBackFixed:
            return 2;
        case MapFormat::kFixed8:
        case MapFormat::kCube8:
            return 1;
    }
    return 1;
}

/// One element of the shader's ReliefMap array, std140.
struct BlockMap {
    glm::vec4 row[3];
    glm::vec4 column[3];
    glm::vec4 object_per_map;
    std::int32_t place[4];
    std::int32_t info[4];
};
static_assert(sizeof(BlockMap) == 144);
constexpr std::size_t kBlockHead = 16;

/// RELIEF_KEEPS_FARTHEST and so on.
std::int32_t flagsOf(const DepthMap& map) {
    return (map.compare == Compare::kGreater ? 1 : 0) | (map.encloses ? 2 : 0) |
           (map.empty_is_outside ? 4 : 0) | (map.decode == Decode::kPlane ? 8 : 0);
}

/// \param pitch  texels from a row to the next: the map's width, or that of the texture it is a rectangle of.
BlockMap blockMap(const DepthMap& map, std::size_t first_texel, GLint pitch, std::size_t motion) {
    BlockMap block{};
    const bool cube = map.projection() == Projection::kCube;
    const glm::vec3 size = cube ? glm::vec3(1.0F) : glm::vec3(map.width, map.height, 1.0F);
    const float range = standingRange(map.projection(), map.object_per_map, map.width, map.height);
    const float last[3] = {range * (2.0F / (cube ? kCubeDepthMax : 1.0F)), static_cast<float>(map.width - 1),
                           static_cast<float>(map.height - 1)};
    for (int i = 0; i < 3; ++i) {
        // The rows are orthogonal and as long as the inverse of object_per_map.
        const glm::vec3 row(map.object_to_map.row[i]);
        block.row[i] = map.object_to_map.row[i] * size[i];
        block.column[i] = glm::vec4(row * map.object_per_map[i] * map.object_per_map[i] / size[i], last[i]);
    }
    block.object_per_map = glm::vec4(map.object_per_map, kStandingCosine * map.object_per_map.z);
    const auto width = static_cast<std::int32_t>(map.width);
    const auto height = static_cast<std::int32_t>(map.height);
    const std::int32_t place[4] = {static_cast<std::int32_t>(first_texel), pitch, pitch * height, width};
    const std::int32_t info[4] = {height, static_cast<std::int32_t>(map.format), flagsOf(map),
                                  static_cast<std::int32_t>(motion)};
    std::memcpy(block.place, place, sizeof(place));
    std::memcpy(block.info, info, sizeof(info));
    return block;
}

/// Uploads texels that follow each other, from index `first` on; the texture is bound.
void uploadTexels(const Layout& layout, const TexelLayout& wrapped, std::size_t first,
                  std::span<const std::byte> bytes) {
    const auto width = static_cast<std::size_t>(wrapped.width());
    std::size_t left = bytes.size() / layout.texel_size;
    const std::byte* from = bytes.data();
    while (left > 0) {
        const std::size_t x = first % width;
        // The rest of a row, or as many whole rows as there are.
        const std::size_t columns = std::min(left, width - x);
        const std::size_t rows = x == 0 && left >= width ? left / width : 1;
        glTexSubImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(x), static_cast<GLint>(first / width),
                        static_cast<GLsizei>(columns), static_cast<GLsizei>(rows), layout.format, layout.type,
                        from);
        first += columns * rows;
        left -= columns * rows;
        from += columns * rows * layout.texel_size;
    }
}

/// A live map before its first update: nothing on any ray. The texture is bound.
void uploadEmpty(const Layout& layout, const DepthMap& map, const TexelRectangle& at) {
    const auto texels = static_cast<std::size_t>(at.width) * static_cast<std::size_t>(at.height);
    std::vector<std::byte> bytes(texels * layout.texel_size);
    for (std::size_t i = 0; i < texels; ++i) {
        encodeTexel(map.format, {}, std::span(bytes).subspan(i * layout.texel_size, layout.texel_size));
    }
    glTexSubImage2D(GL_TEXTURE_2D, 0, at.x, at.y, at.width, at.height, layout.format, layout.type,
                    bytes.data());
}

/// World to object space.
void writeRows(const Pose& pose, glm::vec4 (&rows)[3]) {
    const glm::mat3 rotation = glm::mat3_cast(pose.rotation);
    for (int i = 0; i < 3; ++i) {
        // Column i of the rotation is the body's axis i in the world.
        const glm::vec3 row = rotation[i] / pose.scale;
        rows[i] = glm::vec4(row, -glm::dot(row, pose.position));
    }
}

GLint integer(GLenum what) {
    GLint value = 0;
    glGetIntegerv(what, &value);
    return value;
}

}  // namespace

Result<ColliderTextures> ColliderTextures::create(const Collider& collider) {
    std::vector<PlacedMap> maps;
    for (const DepthMap& map : collider.maps) {
        maps.push_back({&map, false});
    }
    return upload(maps, {});
}

Result<ColliderTextures> ColliderTextures::create(std::span<const ColliderBody> bodies) {
    if (bodies.size() > kBodiesMax) {
        return fail(ErrorCode::kLimit, std::to_string(bodies.size()) + " colliders are more than " +
                                           std::to_string(kBodiesMax) + "; bake some of them into one");
    }
    std::vector<PlacedMap> maps;
    std::vector<BlockBody> blocks;
    for (const ColliderBody& body : bodies) {
        if (!(body.pose.scale > 0.0F)) {
            return fail(ErrorCode::kUsage, "the scale of a collider must be above 0");
        }
        const auto first = static_cast<std::int32_t>(maps.size());
        for (const DepthMap& map : body.collider->maps) {
            maps.push_back({&map, body.live});
        }
        BlockBody block{};
        writeRows(body.pose, block.row);
        writeRows(body.pose, block.before);
        block.response = glm::vec4(body.pose.scale, body.restitution, 1.0F - body.friction, 0.0F);
        block.maps[0] = first;
        block.maps[1] = static_cast<std::int32_t>(maps.size()) - first;
        block.maps[2] = body.live ? 1 : 0;
        blocks.push_back(block);
    }
    return upload(maps, std::move(blocks));
}

void ColliderTextures::setPoses(std::span<const Pose> poses) {
    for (std::size_t i = 0; i < std::min(poses.size(), bodies_.size()); ++i) {
        BlockBody& body = bodies_[i];
        std::copy(std::begin(body.row), std::end(body.row), std::begin(body.before));
        writeRows(poses[i], body.row);
        revision_ += std::equal(std::begin(body.row), std::end(body.row), std::begin(body.before)) ? 0 : 1;
    }
    if (!bodies_.empty()) {
        // Before every step: the whole of PassState would cost more than what is done here.
        const GLint bound = integer(GL_UNIFORM_BUFFER_BINDING);
        glBindBuffer(GL_UNIFORM_BUFFER, block_.name());
        glBufferSubData(GL_UNIFORM_BUFFER, static_cast<GLintptr>(kBlockHead),
                        static_cast<GLsizeiptr>(bodies_.size() * sizeof(BlockBody)), bodies_.data());
        glBindBuffer(GL_UNIFORM_BUFFER, static_cast<GLuint>(bound));
    }
}

Result<ColliderTextures> ColliderTextures::upload(std::span<const PlacedMap> maps,
                                                  std::vector<BlockBody> bodies) {
    if (maps.empty()) {
        return fail(ErrorCode::kUnsupported, "a collider without maps has nothing to collide with");
    }
    const std::size_t head = kBlockHead + bodies.size() * sizeof(BlockBody);
    const auto block_max = static_cast<std::size_t>(integer(GL_MAX_UNIFORM_BLOCK_SIZE));
    const std::size_t map_max = (block_max - head) / sizeof(BlockMap);
    if (maps.size() > map_max) {
        return fail(ErrorCode::kLimit, "the collider has " + std::to_string(maps.size()) +
                                           " maps, this GL takes " + std::to_string(map_max) +
                                           "; bake it with fewer");
    }

    std::array<TexelLayout, 3> layouts;
    for (const auto& [map, live] : maps) {
        TexelLayout& layout = layouts[layoutOf(map->format)];
        if (live) {
            const auto width = static_cast<GLint>(map->width);
            const auto height = static_cast<GLint>(map->height);
            layout.addRectangle(width, height * static_cast<GLint>(map->faceCount()));
            // Of the front and of the back, or of the faces.
            layouts[kFloatLayout].addRectangle(
                width, height * static_cast<GLint>(isFrontBack(map->format) ? 2 : map->faceCount()));
        } else {
            layout.addPacked(std::size_t{map->width} * map->height * map->faceCount());
        }
    }
    const GLint size_max = integer(GL_MAX_TEXTURE_SIZE);
    for (TexelLayout& layout : layouts) {
        if (!layout.finish(size_max)) {
            return fail(ErrorCode::kLimit, "the collider's maps have " + std::to_string(layout.texels()) +
                                               " texels of one layout, this GL takes " +
                                               std::to_string(size_max) + "x" + std::to_string(size_max) +
                                               " in a texture; bake it with fewer bytes");
        }
    }

    ColliderTextures result;
    std::vector<BlockMap> blocks;
    std::vector<std::size_t> first_texel;  // of those with texels
    std::array<std::size_t, 3> packed{};
    std::array<std::size_t, 3> rectangle{};
    for (const auto& [map, live] : maps) {
        const std::size_t i = layoutOf(map->format);
        LivePlace place{.layout = i};
        if (live) {
            const TexelRectangle at = layouts[i].rectangle(rectangle[i]++);
            const TexelRectangle motion = layouts[kFloatLayout].rectangle(rectangle[kFloatLayout]++);
            place = {i, at.x, at.y, motion.x, motion.y};
            blocks.push_back(blockMap(*map, layouts[i].index(at), layouts[i].width(),
                                      layouts[kFloatLayout].index(motion)));
            first_texel.push_back(0);
        } else {
            first_texel.push_back(packed[i]);
            blocks.push_back(blockMap(*map, packed[i], static_cast<GLint>(map->width), 0));
            packed[i] += std::size_t{map->width} * map->height * map->faceCount();
        }
        result.live_places_.push_back(place);
    }

    const PassState state;  // row lengths and skips among it: texels are tightly packed
    forgetGlErrors();
    const std::array<GlTexture*, 3> textures = {&result.float_maps_, &result.fixed_maps_,
                                                &result.front_back_maps_};
    glActiveTexture(GL_TEXTURE0);
    for (std::size_t i = 0; i < textures.size(); ++i) {
        const Layout& layout = kLayouts[i];
        const GLsizei height = layouts[i].height();
        // A layout that no map uses still gets one texel, for a sampler must have something bound.
        *textures[i] = makeTexture2D(layout.internal_format, layouts[i].width(), std::max(height, 1),
                                     layout.format, layout.type, nullptr);
        result.bytes_ += layout.texel_size * static_cast<std::size_t>(layouts[i].width()) *
                         static_cast<std::size_t>(height);
    }
    for (std::size_t m = 0; m < maps.size(); ++m) {
        const DepthMap& map = *maps[m].map;
        const LivePlace& place = result.live_places_[m];
        const std::size_t i = place.layout;
        glBindTexture(GL_TEXTURE_2D, textures[i]->name());
        if (!maps[m].live) {
            if (map.format == MapFormat::kFloat32) {
                uploadTexels(kLayouts[i], layouts[i], first_texel[m], map.texels);
            } else {
                uploadTexels(kLayouts[i], layouts[i], first_texel[m], shaderTexels(map));
            }
            continue;
        }
        const auto width = static_cast<GLsizei>(map.width);
        const auto height = static_cast<GLsizei>(map.height * map.faceCount());
        uploadEmpty(kLayouts[i], map, {place.x, place.y, width, height});
        const GLsizei motion_height = isFrontBack(map.format) ? 2 * height : height;
        const std::vector<float> still(std::size_t{4} * map.width * static_cast<std::size_t>(motion_height));
        glBindTexture(GL_TEXTURE_2D, result.float_maps_.name());
        glTexSubImage2D(GL_TEXTURE_2D, 0, place.motion_x, place.motion_y, width, motion_height, GL_RGBA,
                        GL_FLOAT, still.data());
    }

    result.block_ = makeBuffer();
    std::vector<std::byte> bytes(head + blocks.size() * sizeof(BlockMap));
    const std::int32_t counts[4] = {static_cast<std::int32_t>(blocks.size()), layouts[0].log2Width(),
                                    layouts[1].log2Width(), layouts[2].log2Width()};
    static_assert(sizeof(counts) == kBlockHead);
    std::memcpy(bytes.data(), counts, sizeof(counts));
    if (!bodies.empty()) {
        std::memcpy(bytes.data() + kBlockHead, bodies.data(), bodies.size() * sizeof(BlockBody));
    }
    std::memcpy(bytes.data() + head, blocks.data(), blocks.size() * sizeof(BlockMap));
    glBindBuffer(GL_UNIFORM_BUFFER, result.block_.name());
    glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(bytes.size()), bytes.data(),
                 bodies.empty() ? GL_STATIC_DRAW : GL_DYNAMIC_DRAW);

    RELIEF_TRY(checkAllocated("the collider's " + std::to_string(result.bytes_) + " bytes of maps",
                              "bake it with fewer"));
    result.map_count_ = static_cast<int>(blocks.size());
    result.defines_ = "#define RELIEF_MAP_CAPACITY " + std::to_string(blocks.size()) + "\n";
    if (std::any_of(maps.begin(), maps.end(), [](const PlacedMap& map) { return map.live; })) {
        result.defines_ += "#define RELIEF_LIVE 1\n";
    }
    if (!bodies.empty()) {
        result.defines_ += "#define RELIEF_BODIES " + std::to_string(bodies.size()) + "\n";
    }
    std::int32_t all = ~0;
    for (const PlacedMap& one : maps) {
        all &= flagsOf(*one.map);
    }
    result.defines_ += "#define RELIEF_ALL " + std::to_string(all) + "\n";
    // What no map needs is left out of the shader: a GL may run every branch for every map.
    const auto defineIf = [&](const char* name, auto&& needed) {
        if (std::any_of(maps.begin(), maps.end(), [&](const PlacedMap& one) { return needed(*one.map); })) {
            result.defines_ += std::string("#define RELIEF_HAS_") + name + "\n";
        }
    };
    defineIf("FLOAT", [](const DepthMap& map) { return map.format == MapFormat::kFloat32; });
    defineIf("FIXED", [](const DepthMap& map) { return map.format == MapFormat::kFixed8; });
    defineIf("CUBE", [](const DepthMap& map) { return map.format == MapFormat::kCube8; });
    defineIf("FRONT_BACK", [](const DepthMap& map) { return isFrontBack(map.format); });
    defineIf("FRONT_BACK_HALF", [](const DepthMap& map) { return map.format == MapFormat::kFrontBackHalf; });
    defineIf("FRONT_BACK_FIXED",
             [](const DepthMap& map) { return map.format == MapFormat::kFrontBackFixed; });
    defineIf("PLANE", [](const DepthMap& map) { return map.decode == Decode::kPlane; });
    defineIf("PROJECTED", [](const DepthMap& map) { return map.decode == Decode::kProjected; });
    result.bodies_ = std::move(bodies);
    return result;
}

const GlTexture& ColliderTextures::textureOf(std::size_t layout) const {
    return layout == kFloatLayout ? float_maps_ : (layout == 1 ? fixed_maps_ : front_back_maps_);
}

std::vector<LiveSlot> ColliderTextures::liveSlots(std::size_t body) const {
    std::vector<LiveSlot> slots;
    if (body >= bodies_.size() || bodies_[body].maps[2] == 0) {
        return slots;
    }
    const auto first = static_cast<std::size_t>(bodies_[body].maps[0]);
    for (std::size_t m = first; m < first + static_cast<std::size_t>(bodies_[body].maps[1]); ++m) {
        const LivePlace& place = live_places_[m];
        slots.push_back(
            {&textureOf(place.layout), place.x, place.y, &float_maps_, place.motion_x, place.motion_y});
    }
    return slots;
}

void ColliderTextures::attach(const GlProgram& program, const Binding& binding) const {
    glUseProgram(program.name());
    for (std::size_t i = 0; i < kLayouts.size(); ++i) {
        glUniform1i(glGetUniformLocation(program.name(), kLayouts[i].sampler),
                    binding.first_unit + static_cast<GLint>(i));
    }
    const GLuint index = glGetUniformBlockIndex(program.name(), "ReliefCollider");
    if (index != GL_INVALID_INDEX) {
        glUniformBlockBinding(program.name(), index, static_cast<GLuint>(binding.uniform_block));
    }
}

void ColliderTextures::bind(const Binding& binding) const {
    const std::array<GLuint, 3> names = {float_maps_.name(), fixed_maps_.name(), front_back_maps_.name()};
    for (std::size_t i = 0; i < names.size(); ++i) {
        glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + binding.first_unit + static_cast<int>(i)));
        glBindTexture(GL_TEXTURE_2D, names[i]);
    }
    glBindBufferBase(GL_UNIFORM_BUFFER, static_cast<GLuint>(binding.uniform_block), block_.name());
}

}  // namespace relief
