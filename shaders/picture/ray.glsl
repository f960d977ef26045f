// SPDX-License-Identifier: Apache-2.0
// Steps along a ray through the collider's field. With placed bodies (world.glsl), points outside all boxes skip to the
// next box on the ray. Needs collider.glsl.

// Returns where a ray p + t d enters and leaves the three slabs of a box.
void slabs(vec3 p, vec3 d, vec3 box_min, vec3 box_max, out vec3 near, out vec3 far) {
    vec3 safe = vec3(abs(d.x) < 1e-9 ? 1e-9 : d.x, abs(d.y) < 1e-9 ? 1e-9 : d.y, abs(d.z) < 1e-9 ? 1e-9 : d.z);
    vec3 a = (box_min - p) / safe;
    vec3 b = (box_max - p) / safe;
    near = min(a, b);
    far = max(a, b);
}

#if RELIEF_BODIES > 0 && RELIEF_PLACED

const int BOXES_MAX = 1024;  // with more bodies, the search would take longer than the steps

// Returns the first t from `from` on at which the ray is in the box of a body, or `end`.
float nextBox(vec3 origin, vec3 d, float from, float end) {
    int bodies = reliefBodyCount();
    float next = bodies > BOXES_MAX ? from : end;
    for (int b = 0; b < bodies && next > from; ++b) {
        vec3 o = reliefInMap(b, origin);
        vec3 v = vec3(reliefDot(reliefMapRow(b, 0).xyz, d), reliefDot(reliefMapRow(b, 1).xyz, d), reliefDot(reliefMapRow(b, 2).xyz, d));
        vec3 low, high;
        slabs(o, v, vec3(0.0), reliefPatchRoots(b), low, high);
        float enters = max(max(low.x, low.y), max(low.z, from));
        bool meets = enters <= min(high.x, min(high.y, high.z));
        next = reliefHas(reliefMapInfo(b), RELIEF_ENCLOSES) ? (meets ? min(next, enters) : next) : from;
    }
    return next;
}

// Returns whether the ray is inside at t. `next`: the next t to test while outside, at least `stride` further.
bool insideAt(vec3 origin, vec3 d, float t, float stride, float end, out float next) {
    int body;
    bool inside = reliefInside(reliefUnion(origin + t * d, 0.0, false, body));
    next = min(t + stride, end);
    if (body < 0) {
        next = nextBox(origin, d, next, end);
    }
    return inside;
}

#else

bool insideAt(vec3 origin, vec3 d, float t, float stride, float end, out float next) {
    next = min(t + stride, end);
    return reliefInside(reliefSolid(origin + t * d));
}

#endif
