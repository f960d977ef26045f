// The first pass of the statistics: 16 particles of the state textures.
//!include reduce.glsl

uniform highp sampler2D u_position;
uniform highp sampler2D u_velocity;  // or, where u_rate_before is above 0, the position before
uniform float u_rate_before;         // 1 / seconds of the last step
uniform int u_extent;  // particles; what lies beyond are leftovers

Sums sumsAt(ivec2 texel) {
    vec4 position = texelFetch(u_position, texel, 0);
    if (texel.y * u_size.x + texel.x >= u_extent || position.w < 0.0) {
        return Sums(vec4(0.0), vec4(0.0));
    }
    vec4 velocity = texelFetch(u_velocity, texel, 0);
    if (u_rate_before > 0.0) {  // Verlet: step.glsl
        float collisions = floor(position.w);
        velocity = vec4((position.xyz - velocity.xyz) * u_rate_before, 16.0 * (position.w - collisions));
        position.w = collisions;
    }
    float speed2 = dot(velocity.xyz, velocity.xyz);
    float contact = velocity.w;
    float high = floor(position.w / 4096.0);
    return Sums(vec4(1.0, contact == 1.0 || contact >= 3.0 ? 1.0 : 0.0, contact == 2.0 ? 1.0 : 0.0, 0.5 * speed2),
                vec4(position.w - 4096.0 * high, high, speed2, 0.0));
}
