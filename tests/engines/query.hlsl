// SPDX-License-Identifier: Apache-2.0
// Executes relief.hlsl in Vulkan for vulkan_host.cpp.
#include "relief.hlsl"
[[vk::binding(0)]] Texture2D<uint4> texels : register(t0);
[[vk::binding(1)]] cbuffer Constants : register(b0) {
    ReliefCollider collider;
};
struct Query {
    float4 at;
    float4 velocity;
    float4 reaction;
};
struct Answer {
    float4 surface;
    float4 position;
    float4 velocity;
    float4 normal;
};
[[vk::binding(2)]] StructuredBuffer<Query> queries : register(t1);
[[vk::binding(3)]] RWStructuredBuffer<Answer> answers : register(u0);
[numthreads(64, 1, 1)]
void main(uint3 id : SV_DispatchThreadID) {
    uint count;
    uint stride;
    queries.GetDimensions(count, stride);
    if (id.x < count) {
        Query query = queries[id.x];
        ReliefSurface s = reliefDistance(texels, collider, query.at.xyz);
        Answer answer;
        answer.surface = float4(s.normal, s.distance);
        ReliefMotion m = reliefCollide(texels, collider, query.at.xyz, query.velocity.xyz, query.reaction.x,
                                       query.reaction.y, query.reaction.z);
        answer.position = float4(m.position, m.distance);
        answer.velocity = float4(m.velocity, 0.0);
        answer.normal = float4(m.normal, 0.0);
        answers[id.x] = answer;
    }
}
