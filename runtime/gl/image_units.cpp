#include "runtime/gl/image_units.h"

#include "runtime/gl/gl_functions.h"

namespace relief {

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

}  // namespace relief
