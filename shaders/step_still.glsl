// For step.glsl where no body moves: a floor alone, or one collider in its own space.
vec3 pointBefore(Solid s, vec3 p) {
    return p;
}

vec3 pointNow(int body, vec3 p) {
    return p;
}

vec2 bodyResponse(int body) {
    return vec2(1.0);
}
