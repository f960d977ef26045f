// SPDX-License-Identifier: Apache-2.0
// Light constants shared by all pictures.
const vec3 SUN_COLOR = vec3(1.02, 0.97, 0.88);
const vec3 SKY_COLOR = vec3(0.40, 0.46, 0.56);
const vec3 FLOOR_COLOR = vec3(0.25, 0.26, 0.28);  // light reflected from below

const float SKY_HIDDEN = 0.12;  // light from an occluded part of the sky
const float TWO_PI = 6.2831853;

// Returns the light of an unoccluded sky and the floor on an upward surface:
// the mean of mix(FLOOR_COLOR, SKY_COLOR, ½ + ½ d.y) over a cosine-weighted hemisphere, where d.y averages 2/3.
vec3 skylightOpen() {
    return mix(FLOOR_COLOR, SKY_COLOR, 0.5 + 0.5 * (2.0 / 3.0));
}
