// Births: the first state of a particle (step_state.glsl says what the fourth components mean).
flat in vec3 v_position;
flat in vec3 v_velocity;
flat in vec4 v_birth;

layout(location = 0) out vec4 o_position;
layout(location = 1) out vec4 o_velocity;  // with RELIEF_VERLET: the position before
layout(location = 2) out vec4 o_birth;

#if defined(RELIEF_VERLET)
uniform float u_dt_before;  // the step that the next one takes the velocity from, seconds
#endif

void main() {
    o_position = vec4(v_position, 0.0);
#if defined(RELIEF_VERLET)
    o_velocity = vec4(v_position - u_dt_before * v_velocity, 0.0);
#else
    o_velocity = vec4(v_velocity, 0.0);
#endif
    o_birth = v_birth;
}
