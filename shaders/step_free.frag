// A step with nothing solid but the floor.
//!include step_mask.glsl
//!include air.glsl
//!include step.glsl
//!include step_still.glsl

Solid solid(vec3 p, float radius) {
    return Solid(RELIEF_FAR_OUTSIDE, vec3(0.0), -1, -1, vec3(0.0));
}

bool insideBefore(vec3 p, float radius, Solid s) {
    return false;
}
