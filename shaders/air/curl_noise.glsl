// SPDX-License-Identifier: Apache-2.0
// Divergence-free turbulence, see runtime/air/curl_noise.h. Casts between int and uint keep the bits; uint arithmetic
// wraps at 2^32.

uint curlHash(uint x) {
    x ^= x >> 16u;
    x *= 0x9E3779B1u;
    x ^= x >> 15u;
    x *= 0x85EBCA77u;
    x ^= x >> 13u;
    return x;
}

// Returns the random bits of a pattern at a lattice point; bits below bit 7 are of poor quality.
uint curlDraw(uint point, uint key) {
    uint x = (point ^ key) * 0x9E3779B1u;
    return (x ^ (x >> 16u)) * 0x85EBCA77u;
}

// Convert four bits each to floats: 1 + n/16 from bits 19 to 22, and 1 + n/256 from bits 15 to 18, for n from 0 to 15.
// The bits are placed in a float's mantissa because GPUs cast integers slowly. one: the bits of 1.0, from a uniform,
// because GPUs do not fuse the AND and the OR if both masks are constants.
vec3 curlHigh(uvec3 h, uint one) {
    return uintBitsToFloat((h & 0x780000u) | one);
}

vec3 curlLow(uvec3 h, uint one) {
    return uintBitsToFloat((h & 0x078000u) | one);
}

// Returns the contribution of a corner; d is the offset of the point from the corner. part: factors of curlHigh and
// curlLow, for the patterns of key.x and key.y; middle: added to both products.
vec3 curlCorner(vec3 d, uint corner, uvec2 key, vec4 part, vec2 middle, uint one) {
    uint point = corner ^ (corner >> 16u);
    uint h = curlDraw(point, key.x);
    uvec3 bits = uvec3(h >> 8u, h, h << 8u);
    vec3 a = part.x * curlHigh(bits, one) + middle.x;
    vec3 b = part.y * curlLow(bits, one) + middle.y;
    if (part.z > 0.0) {
        h = curlDraw(point, key.y);
        bits = uvec3(h >> 8u, h, h << 8u);
        a += part.z * curlHigh(bits, one);
        b += part.w * curlLow(bits, one);
    }
    float t = max(0.5 - dot(d, d), 0.0);
    // Ordered for fused multiply-add.
    vec3 curl = (t * (4.0 / 3.0) - 0.5) * b;
    curl += dot(b, d) * d;
    curl += a.yzx * d.zxy;
    curl -= a.zxy * d.yzx;
    return (t * t) * curl;
}

// Returns the curl of one octave's potential. q: the point in lattice units; share: weights of the pattern of key.x and
// of its successor, key.y.
vec3 curlOctave(vec3 q, uvec2 key, vec2 share, uint one) {
    q = clamp(q, -RELIEF_CURL_CELL_MAX, RELIEF_CURL_CELL_MAX);
    q += (q.x + q.y + q.z) * (1.0 / 3.0);
    vec3 low = floor(q);
    vec3 f = q - low;
    const uvec3 steps = uvec3(0xEBD5C9D3u, 0x3966CCC3u, 0xFE172BC7u);
    const uint across = 0x2353C25Du;  // their sum
    uvec3 cell = uvec3(ivec3(low)) * steps;
    uint corner = cell.x + cell.y + cell.z;
    // The corners of the simplex are visited by descending fraction of their axes.
    bool xy = f.x >= f.y;
    bool xz = f.x >= f.z;
    bool yz = f.y >= f.z;
    bool x_first = xy && xz;
    bool y_first = yz && !xy;
    bool x_last = !xy && !xz;
    bool y_last = xy && !yz;
    // A step along an axis of the skewed lattice is 5/6 along that axis and -1/6 along the others.
    vec3 first = vec3(x_first ? -5.0 / 6.0 : 1.0 / 6.0, y_first ? -5.0 / 6.0 : 1.0 / 6.0,
                      xz || yz ? 1.0 / 6.0 : -5.0 / 6.0);
    vec3 second = vec3(x_last ? 1.0 / 3.0 : -2.0 / 3.0, y_last ? 1.0 / 3.0 : -2.0 / 3.0,
                       xz && yz ? 1.0 / 3.0 : -2.0 / 3.0);
    uint to_first = x_first ? steps.x : (y_first ? steps.y : steps.z);
    uint to_last = x_last ? steps.x : (y_last ? steps.y : steps.z);
    // Maps curlHigh and curlLow to 2 n - 15, times the share.
    vec4 part = share.xxyy * vec2(32.0, 512.0).xyxy;
    vec2 middle = -(share.x + share.y) * vec2(47.0, 527.0);
    vec3 d = f - (f.x + f.y + f.z) * (1.0 / 6.0);
    vec3 curl = curlCorner(d, corner, key, part, middle, one);
    curl += curlCorner(d + first, corner + to_first, key, part, middle, one);
    curl += curlCorner(d + second, corner + (across - to_last), key, part, middle, one);
    curl += curlCorner(d - 0.5, corner + across, key, part, middle, one);
    return curl;
}

// Returns object units/s. curl: gain, lattice units per object unit, patterns per second, 1.
vec3 curlVelocity(vec3 p, float t, vec4 curl, int octaves, uint seed) {
    vec3 sum = vec3(0.0);
    float twice = 1.0;
    float size = 1.0;
    for (int o = 0; o < octaves; ++o) {
        float now = t * (curl.z * twice);
        float pattern = floor(now);
        uint mask = uint((RELIEF_CURL_PATTERNS << o) - 1);
        uint index = uint(int(pattern));
        uint base = curlHash(seed + uint(o) * 0x632BE5ABu);
        uvec2 key = uvec2(curlHash(base + (index & mask)), curlHash(base + ((index + 1u) & mask)));
        float s = now - pattern;
        s = s * s * s * (s * (s * 6.0 - 15.0) + 10.0);
        vec2 share = vec2(1.0 - s, s);
        share *= inversesqrt(dot(share, share));
        sum += size * curlOctave(p * (curl.y * twice), key, share, floatBitsToUint(curl.w));
        twice *= 2.0;
        size *= 0.5;
    }
    return curl.x * sum;
}
