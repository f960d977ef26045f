// Births: a fragment for one particle.
//!include particles/birth.glsl

flat in vec3 v_position;
flat in vec3 v_velocity;
flat in vec4 v_birth;

layout(location = 0) out vec4 o_position;
layout(location = 1) out vec4 o_second;
layout(location = 2) out vec4 o_birth;

void main() {
    o_position = bornPosition(v_position);
    o_second = bornSecond(v_position, v_velocity);
    o_birth = v_birth;
}
