// SPDX-License-Identifier: Apache-2.0
// The light on a sprite: on the hemisphere that faces the viewer, with the view-space normal n.
//!include picture/sky.glsl

uniform vec3 u_sun_view;  // unit vectors in view space
uniform vec3 u_up_view;

// `sun`, `sky`: their visible fractions.
vec3 spriteLight(vec3 n, float sun, float sky) {
    // Snow scatters light: the terminator is soft, and no side is dark.
    float key = 0.72 * sun * (0.42 + 0.58 * max((dot(n, u_sun_view) + 0.5) / 1.5, 0.0));
#ifdef RELIEF_LIT
    vec3 above = mix(SKY_HIDDEN, 1.0, sky) * skylightOpen();
#else
    vec3 above = SKY_COLOR;
#endif
    return key * SUN_COLOR + mix(FLOOR_COLOR, above, 0.5 + 0.5 * dot(n, u_up_view));
}
