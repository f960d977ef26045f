// SPDX-License-Identifier: Apache-2.0
// Paints a sprite: a soft disc or, with RELIEF_CELLS, a cell of the atlas; both are shaded as the hemisphere that faces
// the viewer.
//!include picture/sprite_paint.glsl

flat in uvec3 v_shading;
#ifdef RELIEF_CELLS
flat in vec4 v_cell;
#endif
#ifdef RELIEF_QUADS
in vec2 v_at;
#endif

uniform highp sampler2D u_behind;  // window depth behind the sprites

layout(location = 0) out vec4 o_color;  // premultiplied by alpha

void main() {
#ifdef RELIEF_QUADS
    vec2 at = v_at;
#else
    vec2 at = vec2(2.0, -2.0) * gl_PointCoord + vec2(-1.0, 1.0);
#endif
    Shading shading = unpackShading(v_shading);
    float radius = length(at);
#ifdef RELIEF_CELLS
    vec4 body = bodyAt(at, radius, shading.per_edge, v_cell);
#else
    vec4 body = bodyAt(at, radius, shading.per_edge);
#endif
    float shown = shading.opacity;
    if (u_soft > 0.0) {
        shown *= softFraction(texelFetch(u_behind, ivec2(gl_FragCoord.xy), 0).r, gl_FragCoord.z);
    }
    o_color = paintOf(shading, at, radius, body, shown);
    if (o_color.a == 0.0) {
        discard;
    }
}
