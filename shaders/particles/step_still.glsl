// SPDX-License-Identifier: Apache-2.0
// For step.glsl: the functions of a body that does not move, and that changes no reaction.
vec3 pointBefore(Solid s, vec3 p) {
    return p;
}

vec3 placedNow(int body, vec3 p) {
    return p;
}

vec3 motionOf(int body, vec3 p) {
    return vec3(0.0);
}

vec2 bodyResponse(int body) {
    return vec2(1.0);
}
