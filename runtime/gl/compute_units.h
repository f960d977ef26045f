// SPDX-License-Identifier: Apache-2.0
// The image units and shader storage bindings of compute passes. ImageUnits and StorageUnits save state that PassState
// does not, because few passes use it; they require hasCompute().
#pragma once

#include <array>

#include "runtime/gl/gl_object.h"

namespace relief {

/// Saves an indexed buffer binding on construction.
class SavedRange {
  public:
    /// \param target  GL_UNIFORM_BUFFER, GL_SHADER_STORAGE_BUFFER or GL_TRANSFORM_FEEDBACK_BUFFER.
    SavedRange(GLenum target, GLuint index);
    /// Restores the indexed binding; also binds its buffer to the generic binding of `target`.
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

    /// Binds level 0 of a texture for writing, as GL_RGBA32F or in the given format.
    static void write(GLuint unit, const GlTexture& texture);
    static void write(GLuint unit, const GlTexture& texture, GLenum format);
    /// Makes the writes of compute passes visible to all later commands.
    static void finish();

  private:
    struct Unit {
        GLint texture = 0, level = 0, layered = 0, layer = 0, access = 0, format = 0;
    };
    std::array<Unit, kUnits> saved_;
};

/// Saves shader storage bindings 0 to 3 and the generic binding on construction, and restores them on destruction.
class StorageUnits {
  public:
    static constexpr GLuint kUnits = 4;  ///< minimum guaranteed by OpenGL ES 3.1
    StorageUnits();
    ~StorageUnits();
    StorageUnits(const StorageUnits&) = delete;
    StorageUnits& operator=(const StorageUnits&) = delete;

    /// Creates a buffer with undefined contents. Leaves it bound to GL_SHADER_STORAGE_BUFFER.
    [[nodiscard]] static GlBuffer make(GLsizeiptr bytes);
    static void bind(GLuint unit, const GlBuffer& buffer);
    /// Orders passes: later passes see the stores of earlier passes, and do not overwrite data that earlier passes
    /// still read.
    static void order();

  private:
    std::array<SavedRange, kUnits> saved_;
    GLint bound_ = 0;
};

}  // namespace relief
