// SPDX-License-Identifier: Apache-2.0
// The image units and shader storage blocks of compute passes. They save what PassState leaves out, since few passes use
// them; both need hasCompute().
#pragma once

#include <array>

#include "runtime/gl/gl_object.h"

namespace relief {

/// An indexed binding of a buffer, as it was on construction.
class SavedRange {
  public:
    /// \param target  GL_UNIFORM_BUFFER, GL_SHADER_STORAGE_BUFFER or GL_TRANSFORM_FEEDBACK_BUFFER.
    SavedRange(GLenum target, GLuint index);
    /// Binds the target itself, too.
    void restore() const;

  private:
    GLenum target_;
    GLuint index_;
    GLint buffer_ = 0;
    GLint64 offset_ = 0, size_ = 0;
};

/// Saves image units 0 to 3 on construction, and restores them on destruction.
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
    /// Makes the writes of compute passes visible to everything.
    static void finish();

  private:
    struct Unit {
        GLint texture = 0, level = 0, layered = 0, layer = 0, access = 0, format = 0;
    };
    std::array<Unit, kUnits> saved_;
};

/// Saves shader storage bindings 0 to 3 and the buffer bound to the target on construction, and restores them on destruction.
class StorageUnits {
  public:
    static constexpr GLuint kUnits = 4;  ///< as many as OpenGL ES 3.1 promises
    StorageUnits();
    ~StorageUnits();
    StorageUnits(const StorageUnits&) = delete;
    StorageUnits& operator=(const StorageUnits&) = delete;

    /// A buffer of so many bytes, contents undefined. Leaves it bound to the target.
    [[nodiscard]] static GlBuffer make(GLsizeiptr bytes);
    static void bind(GLuint unit, const GlBuffer& buffer);
    /// Between passes: the next one sees the stores of those before, and stores nothing that they still read.
    static void order();

  private:
    std::array<SavedRange, kUnits> saved_;
    GLint bound_ = 0;
};

}  // namespace relief
