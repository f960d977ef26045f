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

vec3 curlGradient(uint h) {
    return vec3(ivec3(uvec3(h, h >> 3u, h >> 6u) & 7u) * 2 - 7);
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
    // Column c: the derivatives of the potential's component c.
    vec3 j0 = vec3(0.0);
    vec3 j1 = vec3(0.0);
    vec3 j2 = vec3(0.0);
    for (uint z = 0u; z < 2u; ++z) {
        uint hz = curlHash(key + cell.z + z);
        uint next_hz = curlHash(next_key + cell.z + z);
        for (uint y = 0u; y < 2u; ++y) {
            uint hy = curlHash(hz + cell.y + y);
            uint next_hy = curlHash(next_hz + cell.y + y);
            for (uint x = 0u; x < 2u; ++x) {
                uint h = curlHash(hy + cell.x + x);
                vec3 g0 = share.x * curlGradient(h);
                vec3 g1 = share.x * curlGradient(h >> 9u);
                vec3 g2 = share.x * curlGradient(h >> 18u);
                if (share.y > 0.0) {
                    h = curlHash(next_hy + cell.x + x);
                    g0 += share.y * curlGradient(h);
                    g1 += share.y * curlGradient(h >> 9u);
                    g2 += share.y * curlGradient(h >> 18u);
                }
                vec3 corner = vec3(uvec3(x, y, z));
                vec3 d = f - corner;
                vec3 w = mix(1.0 - far, far, corner);
                vec3 slope = (2.0 * corner - 1.0) * rise;
                vec3 dw = vec3(slope.x * w.y * w.z, w.x * slope.y * w.z, w.x * w.y * slope.z);
                float all = w.x * w.y * w.z;
                j0 += all * g0 + dot(g0, d) * dw;
                j1 += all * g1 + dot(g1, d) * dw;
                j2 += all * g2 + dot(g2, d) * dw;
            }
        }
    }
    return vec3(j2.y - j1.z, j0.z - j2.x, j1.x - j0.y);
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
