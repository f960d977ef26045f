// Turbulence without divergence: the C++ twin is runtime/air/curl_noise.cpp, which says how it works. Casts
// between int and uint keep the bits; uint arithmetic wraps at 2^32.

uint curlHash(uint x) {
    x ^= x >> 16u;
    x *= 0x9E3779B1u;
    x ^= x >> 15u;
    x *= 0x85EBCA77u;
    x ^= x >> 13u;
    return x;
}

// Three components of a gradient from bits 14 to 22 of h: n/512, 1 + n/64 and 1 + n/8, for n from 0 to 7. GPUs cast
// integers slowly, so the bits become those of a float's mantissa. (A sum with 1 + n/512 would lose too much.)
vec3 curlParts(uint h) {
    uint all = (h & 0x7FC000u) | 0x3F800000u;
    return vec3(uintBitsToFloat(all & 0x3F81C000u) - 1.0, uintBitsToFloat(all & 0x3F8E0000u),
                uintBitsToFloat(all & 0x3FF00000u));
}

// The curl of one octave's potential. q: the point in lattice cells; share: of the pattern of `key` and of the
// one that follows it.
vec3 curlOctave(vec3 q, uint key, uint next_key, vec2 share) {
    q = clamp(q, -RELIEF_CURL_CELL_MAX, RELIEF_CURL_CELL_MAX);
    vec3 low = floor(q);
    uvec3 cell = uvec3(ivec3(low));
    vec3 f = q - low;
    vec3 far = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    vec3 rise = 30.0 * f * f * (f * (f - 2.0) + 1.0);
    // From parts to 2 n - 7, times the share.
    vec3 part = share.x * vec3(1024.0, 128.0, 16.0);
    vec3 next_part = share.y * vec3(1024.0, 128.0, 16.0);
    vec3 middle = -(share.x + share.y) * vec3(7.0, 135.0, 23.0);
    vec3 curl = vec3(0.0);
    for (uint z = 0u; z < 2u; ++z) {
        uint hz = curlHash(key + cell.z + z);
        uint next_hz = curlHash(next_key + cell.z + z);
        float wz = z == 0u ? 1.0 - far.z : far.z;
        float sz = z == 0u ? -rise.z : rise.z;
        for (uint y = 0u; y < 2u; ++y) {
            uint hy = curlHash(hz + cell.y + y);
            uint next_hy = curlHash(next_hz + cell.y + y);
            float wy = y == 0u ? 1.0 - far.y : far.y;
            float sy = y == 0u ? -rise.y : rise.y;
            for (uint x = 0u; x < 2u; ++x) {
                uint h = curlHash(hy + cell.x + x);
                // Of the potential's component c, g_c.
                vec3 g0 = part * curlParts(h << 14) + middle;
                vec3 g1 = part * curlParts(h << 5) + middle;
                vec3 g2 = part * curlParts(h >> 4) + middle;
                if (share.y > 0.0) {
                    h = curlHash(next_hy + cell.x + x);
                    g0 += next_part * curlParts(h << 14);
                    g1 += next_part * curlParts(h << 5);
                    g2 += next_part * curlParts(h >> 4);
                }
                vec3 d = f - vec3(uvec3(x, y, z));
                float wx = x == 0u ? 1.0 - far.x : far.x;
                float sx = x == 0u ? -rise.x : rise.x;
                // The corner's share of the potential is w (g_0·d, g_1·d, g_2·d) with w = wx wy wz; its curl, in an order
                // of multiplications and additions that GPUs do at once:
                vec3 dw = vec3(sx * (wy * wz), sy * (wx * wz), sz * (wx * wy));
                float w = wx * (wy * wz);
                float p0 = dot(g0, d);
                float p1 = dot(g1, d);
                float p2 = dot(g2, d);
                curl += w * vec3(g2.y - g1.z, g0.z - g2.x, g1.x - g0.y);
                curl += dw.yzx * vec3(p2, p0, p1);
                curl -= dw.zxy * vec3(p1, p2, p0);
            }
        }
    }
    return curl;
}

// curl: gain, cells per object unit, patterns a second. Object units a second.
vec3 curlVelocity(vec3 p, float t, vec3 curl, int octaves, uint seed) {
    vec3 sum = vec3(0.0);
    for (int o = 0; o < octaves; ++o) {
        float twice = float(1 << o);
        float now = t * (curl.z * twice);
        float pattern = floor(now);
        uint mask = uint((RELIEF_CURL_PATTERNS << o) - 1);
        uint index = uint(int(pattern));
        uint base = curlHash(seed + uint(o) * 0x632BE5ABu);
        float s = now - pattern;
        s = s * s * s * (s * (s * 6.0 - 15.0) + 10.0);
        vec2 share = vec2(1.0 - s, s) / sqrt((1.0 - s) * (1.0 - s) + s * s);
        sum += curlOctave(p * (curl.y * twice), curlHash(base + (index & mask)),
                          curlHash(base + ((index + 1u) & mask)), share) / twice;
    }
    return curl.x * sum;
}
