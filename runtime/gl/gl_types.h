// SPDX-License-Identifier: Apache-2.0
// OpenGL's types, as every GL header defines them: repeated, they agree. So no public header brings a loader of the GL
// along, and a program may include its own before or after.
#pragma once

#include <cstddef>
#include <cstdint>

// NOLINTBEGIN: the GL's own names
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
