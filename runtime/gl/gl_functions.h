// SPDX-License-Identifier: Apache-2.0
// Declares OpenGL functions and constants: from libepoxy, or in a browser from WebGL2 under the names of OpenGL ES 3.0.
// All code that calls the GL includes this header.
#pragma once

#if defined(__EMSCRIPTEN__)

#include <GLES3/gl31.h>

// Desktop GL only. isGles() is constant in browsers, so calls to these functions are eliminated.
#define GL_CLAMP_READ_COLOR 0x891C
#define GL_COLOR_LOGIC_OP 0x0BF2
#define GL_DEPTH_CLAMP 0x864F
#define GL_FILL 0x1B02
#define GL_FRAMEBUFFER_SRGB 0x8DB9
#define GL_LAST_VERTEX_CONVENTION 0x8E4E
#define GL_POINT_SPRITE_COORD_ORIGIN 0x8CA0
#define GL_POLYGON_MODE 0x0B40
#define GL_PRIMITIVE_RESTART 0x8F9D
#define GL_PROGRAM_POINT_SIZE 0x8642
#define GL_PROVOKING_VERTEX 0x8E4F
#define GL_UPPER_LEFT 0x8CA2
inline void glPointParameteri(GLenum, GLint) {}
inline void glPolygonMode(GLenum, GLenum) {}
inline void glProvokingVertex(GLenum) {}

#else

#include <epoxy/gl.h>

#endif
