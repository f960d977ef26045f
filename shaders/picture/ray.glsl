// SPDX-License-Identifier: Apache-2.0
// Steps along a ray through the collider's field. A ray skips empty cells of trees of patches and, between placed bodies
// (world.glsl), the space outside their boxes. Needs collider.glsl.

// Returns the t at which a ray p + t d enters and leaves the three slabs of a box.
void slabs(vec3 p, vec3 d, vec3 box_min, vec3 box_max, out vec3 near, out vec3 far) {
    vec3 safe = vec3(abs(d.x) < 1e-9 ? 1e-9 : d.x, abs(d.y) < 1e-9 ? 1e-9 : d.y, abs(d.z) < 1e-9 ? 1e-9 : d.z);
    vec3 a = (box_min - p) / safe;
    vec3 b = (box_max - p) / safe;
    near = min(a, b);
    far = max(a, b);
}

#if defined(RELIEF_HAS_PATCHES) && (RELIEF_BODIES == 0 || RELIEF_PLACED)

// Returns the t at which a ray from q meets the range of heights of a patch; 0 in that range. inside: q is inside, and
// not in that range.
float aheadOfHeights(uvec2 record, vec3 q, vec3 d, out bool inside) {
    float z = reliefPatchAcross(record, q).z - (float((record.x >> 11u) & 0xfffu) - 2048.0) * (1.0 / 512.0);
    float longest = max(abs(d.x), max(abs(d.y), abs(d.z)));  // differences of rounded numbers need a scale near 1
    float dz = longest * (reliefPatchAcross(record, d / longest).z - reliefPatchAcross(record, vec3(0.0)).z);
    float thick = 255.0 * reliefPatchStep(record);
    float to = z > thick ? thick - z : z < 0.0 ? -z : 0.0;
    inside = (record.x & 16u) != 0u ? to < 0.0 : to > 0.0;
    return to == 0.0 ? 0.0 : to * dz > 0.0 ? to / dz : 1e30;
}

// Returns a t up to which a ray from p, outside, meets no surface of map i: at most the t at which the ray leaves the
// cell of p. Returns 0 if the cell is inside, which rounding of p may cause.
float emptyAhead(int i, vec3 p, vec3 d) {
    int first = reliefMapPlace(i).x;
    ReliefLeaf leaf = reliefPatchLeaf(u_relief_front_back, reliefMapPlace(i), p);
    if (leaf.inside) {
        return 0.0;
    }
    uvec2 record = leaf.record;
    if ((record.x & 3u) == 2u) {  // an octant without a record
        leaf.q = 2.0 * leaf.q - step(vec3(1.0), 2.0 * leaf.q);
        leaf.cell *= 0.5;
    }
    vec3 way = d / leaf.cell;
    vec3 near, far;
    slabs(leaf.q, way, vec3(0.0), vec3(1.0), near, far);
    float ahead = min(far.x, min(far.y, far.z));
    bool inside = false;
    if ((record.x & 15u) == 15u) {
        int pair = first + int(record.y & 0xffffffu);
        bool other;
        ahead = min(ahead, aheadOfHeights(reliefPatchTexel(u_relief_front_back, pair), leaf.q, way, inside));
        ahead = min(ahead, aheadOfHeights(reliefPatchTexel(u_relief_front_back, pair + 1), leaf.q, way, other));
        inside = (record.x & 16u) != 0u ? inside && other : inside || other;
    } else if ((record.x & 3u) == 3u) {
        ahead = min(ahead, aheadOfHeights(record, leaf.q, way, inside));
    }
    return inside ? 0.0 : ahead;
}

// Returns a t, at least `from`, up to which the ray is outside map i of patches if it is outside at `from`.
float emptyUntil(int i, vec3 origin, vec3 d, float from) {
    if (!reliefHas(reliefMapInfo(i), RELIEF_ENCLOSES)) {
        return from;
    }
    vec3 v = vec3(reliefDot(reliefMapRow(i, 0).xyz, d), reliefDot(reliefMapRow(i, 1).xyz, d), reliefDot(reliefMapRow(i, 2).xyz, d));
    vec3 p = reliefInMap(i, origin + from * d);  // exactly as in the sample that is outside
    vec3 roots = reliefPatchRoots(i);
    if (all(greaterThanEqual(p, vec3(0.0))) && all(lessThan(p, roots))) {
        return from + emptyAhead(i, p, v);
    }
    vec3 near, far;
    slabs(reliefInMap(i, origin), v, vec3(0.0), roots, near, far);
    float enters = max(near.x, max(near.y, near.z));
    float leaves = min(far.x, min(far.y, far.z));
    return enters > leaves || leaves < from ? 1e30 : max(enters, from);
}

#endif

#if RELIEF_BODIES > 0 && RELIEF_PLACED && defined(RELIEF_HAS_PATCHES)

const int CELLS_MAX = 1024;  // of a level
const int BODIES_FEW = 32;   // up to this number, visiting all bodies is faster than the broad phase

// Returns a t, at most `end`, up to which the ray meets no body if it is outside all bodies at `from`.
float nextSurface(vec3 origin, vec3 d, float from, float end) {
    float next = end;
    if (reliefBodyCount() <= BODIES_FEW) {
        for (int b = 0; b < reliefBodyCount() && next > from; ++b) {
            next = min(next, emptyUntil(b, origin, d, from));
        }
        return next;
    }
    for (int level = u_relief_world_place.w - 1; level >= 0; --level) {
        float cells = intBitsToFloat(u_relief_levels[level].x);  // per world unit
        if (cells == 0.0) {  // of bodies without bounds
            return from;
        }
        float beyond = 1e-3 / (cells * max(abs(d.x), max(abs(d.y), abs(d.z))));  // into the next cell despite rounding
        float t = from;
        for (int i = 0; i < CELLS_MAX && t < next; ++i) {
            vec3 p = origin + t * d;
            ReliefSearch list = ReliefSearch(level, 0u, 0u, 0u);
            uvec2 entry = reliefFirstEntry(list, p);
            bool more = true;
            while (more) {
                if (entry.y == list.hash && int(entry.x) >= 0) {
                    next = min(next, emptyUntil(int(entry.x), origin, d, from));
                }
                more = list.entry < list.end;
                if (more) {
                    entry = reliefWords(int(list.entry)).xy;
                    ++list.entry;
                }
            }
            vec3 near, far;
            slabs(fract(cells * p), cells * d, vec3(0.0), vec3(1.0), near, far);
            t += min(far.x, min(far.y, far.z)) + beyond;
        }
        next = min(next, t);
    }
    return next;
}

#endif

// Returns the next t to test on a ray that is outside at t: at least `stride` further, at most `end`. field: at t.
float nextTest(ReliefField field, vec3 origin, vec3 d, float t, float stride, float end) {
    float next = min(t + stride, end);
#if RELIEF_BODIES > 0 && RELIEF_PLACED && defined(RELIEF_HAS_PATCHES)
    next = max(next, nextSurface(origin, d, t, end));
#elif defined(RELIEF_HAS_PATCHES) && RELIEF_BODIES == 0
    if (field.map >= 0 && reliefIsPatches(reliefMapInfo(field.map))) {
        next = max(next, min(emptyUntil(field.map, origin, d, t), end));
    }
#endif
    return next;
}
