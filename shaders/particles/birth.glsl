// Births: the first state of a particle, as in step_state.glsl.
#if defined(RELIEF_VERLET)
uniform float u_dt_before;  // the step that the next one takes the velocity from, seconds
#endif

vec4 bornPosition(vec3 position) {
    return vec4(position, 0.0);
}

// The velocity; with RELIEF_VERLET the position before.
vec4 bornSecond(vec3 position, vec3 velocity) {
#if defined(RELIEF_VERLET)
    return vec4(position - u_dt_before * velocity, 0.0);
#else
    return vec4(velocity, 0.0);
#endif
}
