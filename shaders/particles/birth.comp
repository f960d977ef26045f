// SPDX-License-Identifier: Apache-2.0
// Writes births with a compute shader: one invocation per particle.
layout(local_size_x = RELIEF_BIRTH_GROUP) in;
layout(rgba32f, binding = 0) writeonly uniform highp image2D u_position_out;
layout(rgba32f, binding = 1) writeonly uniform highp image2D u_velocity_out;
layout(rgba32f, binding = 2) writeonly uniform highp image2D u_birth_out;

// Layout as birth.vert's attributes: index, position, velocity, and the four components of a_birth.
layout(std430, binding = 0) readonly buffer Births { uint b_words[]; };
const uint kWords = 11u;

uniform uint u_count;
uniform ivec2 u_size;  // size of the state textures, texels

vec3 threeAt(uint word) {
    return uintBitsToFloat(uvec3(b_words[word], b_words[word + 1u], b_words[word + 2u]));
}

void main() {
    if (gl_GlobalInvocationID.x >= u_count) {
        return;
    }
    uint word = gl_GlobalInvocationID.x * kWords;
    int index = int(b_words[word]);
    ivec2 texel = ivec2(index % u_size.x, index / u_size.x);
    imageStore(u_position_out, texel, vec4(threeAt(word + 1u), 0.0));
    imageStore(u_velocity_out, texel, vec4(threeAt(word + 4u), 0.0));
    imageStore(u_birth_out, texel, vec4(threeAt(word + 7u), uintBitsToFloat(b_words[word + 10u])));
}
