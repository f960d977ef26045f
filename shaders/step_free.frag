// A step with nothing solid but the floor.
//!include step.glsl

Solid solid(vec3 p) {
    return Solid(1e30, vec3(0.0), -1);
}

bool solidAt(vec3 p, int map) {
    return false;
}
