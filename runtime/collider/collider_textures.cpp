#include "runtime/collider/collider_textures.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "formats/base/finite.h"
#include "runtime/collider/gpu_image.h"
#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

GLint integer(GLenum what) {
    GLint value = 0;
    glGetIntegerv(what, &value);
    return value;
}

Result<void> checkMapCount(std::size_t maps, std::size_t bodies) {
    if (maps == 0) {
        return fail(ErrorCode::kUnsupported, "a collider without maps has nothing to collide with");
    }
    const auto block_max = static_cast<std::size_t>(integer(GL_MAX_UNIFORM_BLOCK_SIZE));
    const std::size_t map_max = mapsInBlock(block_max, bodies);
    if (maps > map_max) {
        return fail(ErrorCode::kLimit, "the collider has " + std::to_string(maps) + " maps, this GL takes " +
                                           std::to_string(map_max) + "; bake it with fewer");
    }
    return {};
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
    const auto share = [](float value) { return value >= 0.0F && value <= 1.0F; };
    std::vector<PlacedMap> maps;
    std::vector<BlockBody> blocks;
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
    RELIEF_TRY(checkContext());
    RELIEF_TRY(checkMapCount(maps.size(), bodies.size()));
    const MapLayout layout = RELIEF_TRY(MapLayout::create(maps, integer(GL_MAX_TEXTURE_SIZE)));
    ColliderTextures result;
    result.places_ = layout.places;
    result.bodies_ = std::move(bodies);
    result.map_count_ = static_cast<int>(maps.size());
    result.defines_ = colliderDefines(result.bodies_.size(), maps, layout);

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
    result.makeBlock(colliderBlock(result.bodies_, maps, layout));
    RELIEF_TRY(checkAllocated("the collider's " + std::to_string(result.bytes_) + " bytes of maps",
                              "bake it with fewer"));
    return result;
}

void ColliderTextures::makeBlock(std::span<const std::byte> bytes) {
    block_ = makeBuffer();
    glBindBuffer(GL_UNIFORM_BUFFER, block_.name());
    glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(bytes.size()), bytes.data(),
                 bodies_.empty() ? GL_STATIC_DRAW : GL_DYNAMIC_DRAW);
}

std::vector<LiveSlot> ColliderTextures::liveSlots(std::size_t body) const {
    std::vector<LiveSlot> slots;
    if (body >= bodies_.size() || bodies_[body].maps[2] == 0) {
        return slots;
    }
    const auto first = static_cast<std::size_t>(bodies_[body].maps[0]);
    for (std::size_t m = first; m < first + static_cast<std::size_t>(bodies_[body].maps[1]); ++m) {
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
    const GLuint index = glGetUniformBlockIndex(program, "ReliefCollider");
    if (index != GL_INVALID_INDEX) {
        glUniformBlockBinding(program, index, static_cast<GLuint>(binding.uniform_block));
    }
}

void ColliderTextures::bind(const Binding& binding) const {
    for (std::size_t kind = 0; kind < kTexelKinds; ++kind) {
        useTexture(binding.first_unit + static_cast<int>(kind), textures_[kind]);
    }
    glBindBufferBase(GL_UNIFORM_BUFFER, static_cast<GLuint>(binding.uniform_block), block_.name());
}

void ColliderTextures::bindStorage(int binding) const {
    StorageUnits::bind(static_cast<GLuint>(binding), block_);
}

}  // namespace relief
