// The first pass of the statistics: a square of the state textures.
//!include particles/reduce.glsl

uniform highp sampler2D u_position;
uniform highp sampler2D u_velocity;
uniform highp sampler2D u_birth;
uniform int u_extent;  // particles; texels beyond hold leftovers

// By its bits: a compiler may take it for granted that there is no NaN.
bool finite(vec4 v) {
    return all(notEqual(floatBitsToUint(v) & 0x7F800000u, uvec4(0x7F800000u)));
}

// Of a particle without a finite position, or too fast for sums of squares: it only counts as alive.
Sums lostAt(ivec2 texel) {
    float type = clamp(texelFetch(u_birth, texel, 0).z, 0.0, RELIEF_TYPE_CODES - 1.0);
    return Sums(vec4(1.0, 0.0, 0.0, 0.0), vec4(0.0, 0.0, 0.0, RELIEF_TYPE_CODES - type));
}

Sums sumsAt(ivec2 texel) {
    vec4 position = texelFetch(u_position, texel, 0);
    if (texel.y * u_size.x + texel.x >= u_extent || position.w < 0.0) {
        return Sums(vec4(0.0), vec4(0.0));
    }
    vec4 velocity = texelFetch(u_velocity, texel, 0);
    if (!finite(position) || !finite(velocity)) {
        return lostAt(texel);
    }
    float speed2 = dot(velocity.xyz, velocity.xyz);
    if (!finite(vec4(speed2)) || speed2 > RELIEF_SPEED_MAX_OF_STATE * RELIEF_SPEED_MAX_OF_STATE) {
        return lostAt(texel);
    }
    float contact = velocity.w;
    float high = floor(position.w / float(RELIEF_COLLISIONS_HIGH));
    return Sums(vec4(1.0, contact == float(RELIEF_CONTACT_COLLIDED) || contact >= float(RELIEF_CONTACT_STOPPED) ? 1.0 : 0.0,
                     contact == float(RELIEF_CONTACT_CAUGHT) ? 1.0 : 0.0, 0.5 * speed2),
                vec4(position.w - float(RELIEF_COLLISIONS_HIGH) * high, high, speed2, 0.0));
}
