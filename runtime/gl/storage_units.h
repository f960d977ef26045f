// The shader storage blocks of compute passes.
#pragma once

#include <array>

#include "runtime/gl/gl_object.h"

namespace relief {

/// On construction: saves shader storage bindings 0 to 3 and the buffer bound to the target. On destruction: puts them
/// back. Needs hasCompute(). What PassState does for all other state; few passes use storage.
class StorageUnits {
  public:
    static constexpr GLuint kUnits = 4;  ///< what OpenGL ES 3.1 promises
    StorageUnits();
    ~StorageUnits();
    StorageUnits(const StorageUnits&) = delete;
    StorageUnits& operator=(const StorageUnits&) = delete;

    /// A buffer of so many bytes, contents undefined. Leaves it bound to the target.
    [[nodiscard]] static GlBuffer make(GLsizeiptr bytes);  // GL_STREAM_COPY
    [[nodiscard]] static GlBuffer make(GLsizeiptr bytes, GLenum usage);
    static void bind(GLuint unit, const GlBuffer& buffer);
    /// Between passes: the next one sees what those before have stored, and stores nothing that they still read.
    static void order();

  private:
    struct Unit {
        GLint buffer = 0;
        GLint64 offset = 0, size = 0;
    };
    std::array<Unit, kUnits> saved_;
    GLint bound_ = 0;
};

}  // namespace relief
