// SPDX-License-Identifier: Apache-2.0
// Macros that make a shader text valid C++ with shader_types.h. Include shader_words_end.h after the text.
#ifdef __clang__
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wkeyword-macro"
#endif
#define float Real
#define float2 Real2
#define float3 Real3
#define float4 Real4
#define vec2 Real2
#define vec3 Real3
#define vec4 Real4
#define ivec2 int2
#define ivec4 int4
#define uvec2 uint2
#define uvec4 uint4
#define highp
#define xy componentsXy()
#define xyz componentsXyz()
#define yzx componentsYzx()
#define zxy componentsZxy()
#define yzw componentsYzw()
