// A step with nothing solid but the floor.
#define RELIEF_BODIES 0
#define RELIEF_LIVE 0
//!include air.glsl
//!include step.glsl

Solid solid(vec3 p, float radius) {
    return Solid(1e30, vec3(0.0), -1, -1);
}

bool insideBefore(vec3 p, float radius, Solid s) {
    return false;
}
