// SPDX-License-Identifier: Apache-2.0
#include "runtime/collider/map_textures.h"

#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/layout/gpu_image.h"

namespace relief {

GLint MapTextures::sideMax() {
    GLint side = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side);
    return side;
}

MapTextures::MapTextures(std::span<const PlacedMap> maps, const MapLayout& layout)
    : block_(makeBuffer()), count_(static_cast<int>(maps.size())) {
    const auto textures = mapTextures(maps, layout);
    for (std::size_t kind = 0; kind < kTexelKinds; ++kind) {
        const TexelFormat& format = texelFormat(static_cast<TexelKind>(kind));
        const GpuTexture& texture = textures[kind];
        textures_[kind] = makeTexture2D(format.internal_format, static_cast<GLsizei>(texture.width),
                                        static_cast<GLsizei>(texture.height), format.format, format.type,
                                        texture.texels.data());
        // Textures that no map uses have one texel, which is not counted.
        bytes_ += layout.textures[kind].height() == 0 ? 0 : texture.texels.size();
    }
}

void MapTextures::setBlock(std::span<const std::byte> block) const {
    glBindBuffer(GL_UNIFORM_BUFFER, block_.name());
    glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(block.size()), block.data(), GL_DYNAMIC_DRAW);
}

void MapTextures::attach(GLuint program, const ShaderCollider::Binding& binding) const {
    glUseProgram(program);
    for (std::size_t kind = 0; kind < kTexelKinds; ++kind) {
        glUniform1i(glGetUniformLocation(program, texelFormat(static_cast<TexelKind>(kind)).sampler),
                    binding.first_unit + static_cast<GLint>(kind));
    }
    const GLuint index = glGetUniformBlockIndex(program, "ReliefMaps");
    if (index != GL_INVALID_INDEX) {
        glUniformBlockBinding(program, index, static_cast<GLuint>(binding.uniform_block));
    }
}

void MapTextures::bind(const ShaderCollider::Binding& binding) const {
    for (std::size_t kind = 0; kind < kTexelKinds; ++kind) {
        useTexture(binding.first_unit + static_cast<int>(kind), textures_[kind]);
    }
    glBindBufferBase(GL_UNIFORM_BUFFER, static_cast<GLuint>(binding.uniform_block), block_.name());
}

void MapTextures::bindStorage(int binding) const {
    StorageUnits::bind(static_cast<GLuint>(binding), block_);
}

}  // namespace relief
