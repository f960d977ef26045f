// SPDX-License-Identifier: Apache-2.0
// Removes the macros of shader_words_begin.h and of the text.
#undef float
#undef float2
#undef float3
#undef float4
#undef vec2
#undef vec3
#undef vec4
#undef ivec2
#undef ivec4
#undef uvec2
#undef uvec4
#undef highp
#undef xy
#undef xyz
#undef yzx
#undef zxy
#undef yzw
#undef RELIEF_LOG2_WIDTH
#ifdef __clang__
#pragma clang diagnostic pop
#endif
