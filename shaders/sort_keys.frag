// Refreshes the keys of an order for where the particles and the viewer are now; the order itself stays.
//
//     order texture, uint    x   index of the particle that is drawn rank-th
//                            y   key: the bits of the squared distance to the eye, which grow as it does;
//                                0 for the dead and the absent
//
// As uints the keys have one order on every machine: no NaN, no flushed denormal, no fused multiply in the way.
uniform highp usampler2D u_order;
uniform highp sampler2D u_position;
uniform int u_kept;    // ranks below it hold an order; from it on rank i is given index i
uniform int u_width;   // texels in a row of u_position
uniform int u_extent;  // indices from it on are absent, whatever their texels hold
uniform vec3 u_eye;

layout(location = 0) out uvec2 o_element;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    int rank = texel.y * RELIEF_ORDER_WIDTH + texel.x;
    int index = rank < u_kept ? int(texelFetch(u_order, texel, 0).x) : rank;
    uint key = 0u;
    if (index < u_extent) {
        vec4 position = texelFetch(u_position, ivec2(index % u_width, index / u_width), 0);
        if (position.w >= 0.0) {
            vec3 away = position.xyz - u_eye;
            key = max(floatBitsToUint(dot(away, away)), 1u);
        }
    }
    o_element = uvec2(uint(index), key);
}
