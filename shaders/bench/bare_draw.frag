// One colour. RELIEF_WORDS: for a target of integers. RELIEF_ALPHA: how opaque.
#ifndef RELIEF_ALPHA
#define RELIEF_ALPHA 1.0
#endif
#ifdef RELIEF_WORDS
layout(location = 0) out uvec4 o_texel;
void main() {
    o_texel = uvec4(1u, 2u, 3u, 4u);
}
#else
layout(location = 0) out vec4 o_texel;
void main() {
    o_texel = vec4(0.25, 0.5, 0.75, RELIEF_ALPHA);
}
#endif
