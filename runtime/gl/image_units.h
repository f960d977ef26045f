// The image units that compute passes write through.
#pragma once

#include <array>

#include "runtime/gl/gl_object.h"

namespace relief {

/// On construction: saves image units 0 to 3. On destruction: puts them back. Needs hasCompute(). What PassState does
/// for all other state; few passes use images.
class ImageUnits {
  public:
    static constexpr GLuint kUnits = 4;
    ImageUnits();
    ~ImageUnits();
    ImageUnits(const ImageUnits&) = delete;
    ImageUnits& operator=(const ImageUnits&) = delete;

    /// Level 0 of a texture, to be written; of GL_RGBA32F, or in the format of the texture.
    static void write(GLuint unit, const GlTexture& texture);
    static void write(GLuint unit, const GlTexture& texture, GLenum format);
    /// Lets everything see what compute passes have written.
    static void finish();

  private:
    struct Unit {
        GLint texture = 0, level = 0, layered = 0, layer = 0, access = 0, format = 0;
    };
    std::array<Unit, kUnits> saved_;
};

}  // namespace relief
