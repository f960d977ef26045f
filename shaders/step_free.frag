// A step with nothing solid but the floor.
//!include air.glsl
//!include step.glsl

Solid solid(vec3 p, float radius) {
    return Solid(1e30, vec3(0.0), -1, -1);
}

bool insideBefore(vec3 p, float radius, Solid s) {
    return false;
}

vec3 pointBefore(int body, vec3 p) {
    return p;
}

vec3 pointNow(int body, vec3 p) {
    return p;
}

vec2 bodyResponse(int body) {
    return vec2(1.0);
}
