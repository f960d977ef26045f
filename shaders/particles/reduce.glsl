// Sums over squares of texels, one fragment each: shared by reduce_state.frag and reduce_sum.frag.
//
//     counts   x particles alive   y collided   z caught   w half the sum of |v|^2
//     sums     x, y collisions = x + RELIEF_COLLISIONS_HIGH y   z greatest |v|^2
//              w RELIEF_TYPE_CODES - the first type of which a particle is lost; 0 if none is
//
// Counts are whole numbers below 2^24, which floats hold exactly. The collisions of all particles go beyond; in
// two parts they are exact up to 2^36.

uniform ivec2 u_size;  // of the summed texture, texels

layout(location = 0) out vec4 o_counts;
layout(location = 1) out vec4 o_sums;

struct Sums {
    vec4 counts;
    vec4 sums;
};

// Of one texel, which lies within u_size.
Sums sumsAt(ivec2 texel);

void main() {
    ivec2 first = RELIEF_REDUCED_SIDE * ivec2(gl_FragCoord.xy);
    ivec2 end = min(first + RELIEF_REDUCED_SIDE, u_size);
    vec4 counts = vec4(0.0);
    vec4 sums = vec4(0.0);
    for (int y = first.y; y < end.y; ++y) {
        // A row first, then the rows: fewer roundings in a chain.
        vec4 row = vec4(0.0);
        for (int x = first.x; x < end.x; ++x) {
            Sums one = sumsAt(ivec2(x, y));
            row += one.counts;
            sums.xy += one.sums.xy;
            sums.zw = max(sums.zw, one.sums.zw);
        }
        counts += row;
    }
    float carry = floor(sums.x / float(RELIEF_COLLISIONS_HIGH));
    o_counts = counts;
    o_sums = vec4(sums.x - float(RELIEF_COLLISIONS_HIGH) * carry, sums.y + carry, sums.zw);
}
