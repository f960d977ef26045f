// SPDX-License-Identifier: Apache-2.0
#include "runtime/gl/compute_units.h"

#include "runtime/gl/gl_functions.h"

namespace relief {
namespace {

/// The GL queries for an indexed binding.
struct Queries {
    GLenum buffer, offset, size;
};

Queries queriesOf(GLenum target) {
    switch (target) {
        case GL_UNIFORM_BUFFER:
            return {GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE};
        case GL_TRANSFORM_FEEDBACK_BUFFER:
            return {GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, GL_TRANSFORM_FEEDBACK_BUFFER_START,
                    GL_TRANSFORM_FEEDBACK_BUFFER_SIZE};
        default:
            return {GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
                    GL_SHADER_STORAGE_BUFFER_SIZE};
    }
}

SavedRange storageRange(GLuint index) {
    return {GL_SHADER_STORAGE_BUFFER, index};
}

}  // namespace

SavedRange::SavedRange(GLenum target, GLuint index) : target_(target), index_(index) {
    const Queries queries = queriesOf(target);
    glGetIntegeri_v(queries.buffer, index, &buffer_);
    glGetInteger64i_v(queries.offset, index, &offset_);
    glGetInteger64i_v(queries.size, index, &size_);
}

void SavedRange::restore() const {
    if (size_ > 0) {
        glBindBufferRange(target_, index_, static_cast<GLuint>(buffer_), static_cast<GLintptr>(offset_),
                          static_cast<GLsizeiptr>(size_));
    } else {  // the whole buffer, or no buffer
        glBindBufferBase(target_, index_, static_cast<GLuint>(buffer_));
    }
}

ImageUnits::ImageUnits() {
    for (GLuint i = 0; i < kUnits; ++i) {
        Unit& unit = saved_[i];
        glGetIntegeri_v(GL_IMAGE_BINDING_NAME, i, &unit.texture);
        glGetIntegeri_v(GL_IMAGE_BINDING_LEVEL, i, &unit.level);
        glGetIntegeri_v(GL_IMAGE_BINDING_LAYERED, i, &unit.layered);
        glGetIntegeri_v(GL_IMAGE_BINDING_LAYER, i, &unit.layer);
        glGetIntegeri_v(GL_IMAGE_BINDING_ACCESS, i, &unit.access);
        glGetIntegeri_v(GL_IMAGE_BINDING_FORMAT, i, &unit.format);
    }
}

ImageUnits::~ImageUnits() {
    for (GLuint i = 0; i < kUnits; ++i) {
        const Unit& unit = saved_[i];
        glBindImageTexture(i, static_cast<GLuint>(unit.texture), unit.level,
                           unit.layered != 0 ? GL_TRUE : GL_FALSE, unit.layer,
                           static_cast<GLenum>(unit.access), static_cast<GLenum>(unit.format));
    }
}

void ImageUnits::write(GLuint unit, const GlTexture& texture) {
    write(unit, texture, GL_RGBA32F);
}

void ImageUnits::write(GLuint unit, const GlTexture& texture, GLenum format) {
    glBindImageTexture(unit, texture.name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, format);
}

void ImageUnits::finish() {
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                    GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_UPDATE_BARRIER_BIT | GL_PIXEL_BUFFER_BARRIER_BIT);
}

StorageUnits::StorageUnits() : saved_{storageRange(0), storageRange(1), storageRange(2), storageRange(3)} {
    glGetIntegerv(GL_SHADER_STORAGE_BUFFER_BINDING, &bound_);
}

StorageUnits::~StorageUnits() {
    for (const SavedRange& range : saved_) {
        range.restore();
    }
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(bound_));
}

GlBuffer StorageUnits::make(GLsizeiptr bytes) {
    GlBuffer buffer = makeBuffer();
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer.name());
    glBufferData(GL_SHADER_STORAGE_BUFFER, bytes, nullptr, GL_STREAM_COPY);
    return buffer;
}

void StorageUnits::bind(GLuint unit, const GlBuffer& buffer) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, unit, buffer.name());
}

void StorageUnits::order() {
    // The image bit also orders later stores after earlier loads; the storage bit does not.
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

}  // namespace relief
