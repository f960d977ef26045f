// SPDX-License-Identifier: Apache-2.0
// Declares OpenGL's types as every GL header does; identical redeclarations are valid. Public headers thus need no GL
// loader, and programs may include a loader before or after them.
#pragma once

#include <cstddef>
#include <cstdint>

// NOLINTBEGIN: names defined by the GL
typedef unsigned int GLenum;
typedef unsigned char GLboolean;
typedef unsigned int GLuint;
typedef int GLint;
typedef int GLsizei;
typedef float GLfloat;
typedef std::ptrdiff_t GLsizeiptr;
typedef std::int64_t GLint64;
typedef std::uint64_t GLuint64;
typedef struct __GLsync* GLsync;
// NOLINTEND
