// SPDX-License-Identifier: Apache-2.0
// Packed normals, 256 * s + t, as in formats/normal_index.cpp.

vec3 reliefUnpackNormal(uint code) {
    const float half_range = float(RELIEF_NORMAL_HALF_RANGE);
    const uint last = uint(2 * RELIEF_NORMAL_HALF_RANGE);
    vec2 st = (vec2(float(min(code >> 8, last)), float(min(code & 255u, last))) - half_range) / half_range;
    vec3 v = vec3(st, 1.0 - abs(st.x) - abs(st.y));
    if (v.z < 0.0) {
        v.x = (st.x < 0.0 ? -1.0 : 1.0) * (1.0 - abs(st.y));
        v.y = (st.y < 0.0 ? -1.0 : 1.0) * (1.0 - abs(st.x));
    }
    return v / sqrt(dot(v, v));
}

// Returns the best of the four indices around a unit normal. Compares squared distances between the vectors' ends,
// because a float cosine does not resolve angles below a thirtieth of a degree.
uint reliefPackNormal(vec3 n) {
    vec2 st = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    if (n.z < 0.0) {
        st = vec2((n.x < 0.0 ? -1.0 : 1.0) * (1.0 - abs(st.y)), (n.y < 0.0 ? -1.0 : 1.0) * (1.0 - abs(st.x)));
    }
    ivec2 low = clamp(ivec2(floor(st * float(RELIEF_NORMAL_HALF_RANGE))) + RELIEF_NORMAL_HALF_RANGE, ivec2(0),
                      ivec2(2 * RELIEF_NORMAL_HALF_RANGE - 1));
    uint best = 0u;
    float best_distance = 8.0;
    for (int dt = 0; dt <= 1; ++dt) {
        for (int ds = 0; ds <= 1; ++ds) {
            uint code = uint((low.x + ds) << 8 | (low.y + dt));
            vec3 d = reliefUnpackNormal(code) - n;
            float distance = dot(d, d);
            // Twice the cosine improvement that the CPU requires: ties go to the lower index.
            if (distance < best_distance - 2e-9) {
                best = code;
                best_distance = distance;
            }
        }
    }
    return best;
}
