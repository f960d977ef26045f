// SPDX-License-Identifier: Apache-2.0
// Executes relief.glsl in Vulkan for vulkan_host.cpp. DISTANCE_ONLY is for --time.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "relief.glsl"
layout(local_size_x = 64) in;
layout(binding = 0) uniform usampler2D texels;
layout(std140, binding = 1) uniform Constants {
    ReliefCollider collider;
};
struct Query {
    vec4 point;
    vec4 velocity;
    vec4 reaction;
};
struct Answer {
    vec4 surface;
    vec4 position;
    vec4 velocity;
    vec4 normal;
};
layout(std430, binding = 2) readonly buffer Queries {
    Query queries[];
};
layout(std430, binding = 3) writeonly buffer Answers {
    Answer answers[];
};
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(queries.length())) {
        return;
    }
    Query query = queries[i];
    ReliefSurface s = reliefDistance(texels, collider, query.point.xyz);
#ifdef DISTANCE_ONLY
    answers[i].surface = vec4(s.normal, s.distance);
#else
    ReliefMotion m = reliefCollide(texels, collider, query.point.xyz, query.velocity.xyz, query.reaction.x,
                                   query.reaction.y, query.reaction.z);
    answers[i] = Answer(vec4(s.normal, s.distance), vec4(m.position, m.distance), vec4(m.velocity, 0.0),
                        vec4(m.normal, 0.0));
#endif
}
