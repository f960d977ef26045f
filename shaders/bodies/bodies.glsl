// SPDX-License-Identifier: Apache-2.0
// The motion and the union of the bodies of a world (world.glsl).

// Moves a point of a body from the start to the end of the step; and back.
vec3 reliefMoved(int body, vec3 p) {
    vec3 now = p;
    if (reliefBodyResponse(body).w != 0.0) {
        now = vec3(reliefRow(reliefBodyMove(body, 0), p), reliefRow(reliefBodyMove(body, 1), p),
                   reliefRow(reliefBodyMove(body, 2), p));
    }
    return now;
}
vec3 reliefMovedBack(int body, vec3 p) {
    vec3 before = p;
    if (reliefBodyResponse(body).w != 0.0) {
        vec4 row0 = reliefBodyMove(body, 0);
        vec4 row1 = reliefBodyMove(body, 1);
        vec4 row2 = reliefBodyMove(body, 2);
        // The rows are orthogonal and of equal length.
        before = (row0.xyz * (p.x - row0.w) + (row1.xyz * (p.y - row1.w) + row2.xyz * (p.z - row2.w))) *
                 (1.0 / reliefDot(row0.xyz, row0.xyz));
    }
    return before;
}

// Rotates a direction from world to object space, which scales its length; and back.
vec3 reliefTurned(int body, vec3 v) {
    return vec3(reliefDot(reliefBodyRow(body, 0).xyz, v), reliefDot(reliefBodyRow(body, 1).xyz, v),
                reliefDot(reliefBodyRow(body, 2).xyz, v));
}
vec3 reliefTurnedBack(int body, vec3 v) {
    return reliefBodyRow(body, 0).xyz * v.x +
           (reliefBodyRow(body, 1).xyz * v.y + reliefBodyRow(body, 2).xyz * v.z);
}

vec3 reliefToObject(int body, vec3 p) {
    return vec3(reliefRow(reliefBodyRow(body, 0), p), reliefRow(reliefBodyRow(body, 1), p),
                reliefRow(reliefBodyRow(body, 2), p));
}

// Evaluates one body for a ball about p, as reliefSolid or, with `whole`, reliefEvaluate.
#if RELIEF_PLACED

ReliefField reliefBodyField(int body, vec3 p, float radius, bool whole) {
#if defined(RELIEF_RADIUS)
    if (radius > 0.0) {
        return reliefBall(body, body + 1, p, radius);
    }
#endif
    return reliefMaps(body, body + 1, p, whole);
}

#else

ReliefField reliefInObject(int body, vec3 q, float radius, bool whole) {
    int first = reliefBodyMaps(body).x;
    int end = first + reliefBodyMaps(body).y;
#if defined(RELIEF_RADIUS)
    if (radius > 0.0) {
        return reliefBall(first, end, q, radius);
    }
#endif
    return reliefMaps(first, end, q, whole);
}

ReliefField reliefBodyField(int body, vec3 p, float radius, bool whole) {
    float scale = reliefBodyResponse(body).x;
    ReliefField field = reliefInObject(body, reliefToObject(body, p), radius / scale, whole);
    // The transpose of a rotation is its inverse.
    return ReliefField(scale * field.distance, scale * reliefTurnedBack(body, field.normal), field.map);
}

#endif

// Adds a body to the union of the previous bodies. The smallest distance decides; ties go to the lower index.
void reliefJoinBody(inout ReliefField best, inout int best_body, int body, vec3 p, float radius, bool whole) {
#if defined(RELIEF_MASKS)  // only in a step: step.frag
    if (!collidesWith(reliefBodyMaps(body).w)) {
        return;
    }
#endif
    ReliefField field = reliefBodyField(body, p, radius, whole);
    if (field.map >= 0 && (field.distance < best.distance || (field.distance == best.distance && body < best_body))) {
        best = field;
        best_body = body;
    }
}

// Must match cellHash() in body_grid.h.
uint reliefCellHash(ivec3 cell) {
    uint h = uint(cell.x) * 0x8da6b343u + uint(cell.y) * 0xd8163841u + uint(cell.z) * 0xcb1ab31fu;
    h ^= h >> 15u;
    h *= 0x2c1b3c6du;
    return h ^ (h >> 13u);
}

// Returns false if a ball about p cannot touch the oriented box of a placed body; for other bodies, the cell test
// suffices.
bool reliefTouchesBox(int body, vec3 p, float radius) {
    bool meets = true;
#if RELIEF_PLACED
    if (reliefHas(reliefMapInfo(body), RELIEF_ENCLOSES)) {
        vec3 in_map = reliefInMap(body, p);
        // Slightly more than the radius, to allow for rounding.
        float margin = radius * (1.001 / reliefObjectPerMap(body).x);
        meets = all(greaterThanEqual(in_map, vec3(-margin))) && all(lessThan(in_map, reliefPatchRoots(body) + margin));
    }
#endif
    return meets;
}

// The state of a search for bodies that may contain a point, through the lists of its cells.
struct ReliefSearch {
    int level;   // next level
    uint entry;  // next entry of the list
    uint end;
    uint hash;   // hash of the cell
};

// Starts the list of the next level for the cell of p, and returns its first entry: body and hash.
uvec2 reliefFirstEntry(inout ReliefSearch search, vec3 p) {
    ivec4 cells = u_relief_levels[search.level];
    ivec3 cell = ivec3(floor(clamp(p * intBitsToFloat(cells.x), -1e9, 1e9)));
    search.hash = reliefCellHash(cell);
    uvec4 list = reliefWords(cells.y + int(search.hash & uint(cells.z)));
    search.entry = list.x;
    search.end = list.y;
    ++search.level;
    return list.zw;
}

// Returns up to four bodies whose boxes contain p, starting at x; -1: none. If w is set, there may be more.
ivec4 reliefNextBodies(inout ReliefSearch search, vec3 p, float radius) {
    ivec4 found = ivec4(-1);
    while (found.w < 0 && (search.entry < search.end || search.level < u_relief_world_place.w)) {
        uvec2 entry;
        if (search.entry < search.end) {
            entry = reliefWords(int(search.entry)).xy;
            ++search.entry;
        } else {
            entry = reliefFirstEntry(search, p);
        }
        int body = int(entry.x);
        bool holds = entry.y == search.hash && body >= 0;
        found = holds && reliefTouchesBox(body, p, radius) ? ivec4(body, found.xyz) : found;
    }
    return found;
}

// Evaluates the union of the bodies whose boxes contain p; boxes are enlarged by the radius of a ball. No other body
// contains p. The distance is in world units; body is -1 if no body votes; `whole` is only for placed bodies. Each lane
// first searches for its next bodies, so that all lanes then evaluate bodies at the same time.
ReliefField reliefUnion(vec3 p, float radius, bool whole, out int body) {
    ReliefField best = ReliefField(RELIEF_FAR_OUTSIDE, vec3(0.0), -1);
    body = -1;
    ReliefSearch search = ReliefSearch(0, 0u, 0u, 0u);
    bool more = true;
    while (more) {
        ivec4 next = reliefNextBodies(search, p, radius);
        more = next.w >= 0;
        while (next.x >= 0) {
            reliefJoinBody(best, body, next.x, p, radius, whole);
            next = ivec4(next.yzw, -1);
        }
    }
    return best;
}

ReliefField reliefSolid(vec3 p) {
    int body;
    return reliefUnion(p, 0.0, false, body);
}

// Evaluates the union of all bodies. Placed bodies are patches, which have no distance outside their boxes: of them, only
// bodies whose boxes contain p are evaluated.
ReliefField reliefEvaluate(vec3 p) {
    int body;
#if RELIEF_PLACED
    return reliefUnion(p, 0.0, true, body);
#else
    body = -1;
    ReliefField best = ReliefField(RELIEF_FAR_OUTSIDE, vec3(0.0), -1);
    for (int b = 0; b < reliefBodyCount(); ++b) {
        reliefJoinBody(best, body, b, p, 0.0, true);
    }
    return best;
#endif
}

#if RELIEF_LIVE

// Returns the motion of the surface of map i of a body at a point q of object space since the previous update. If the
// texel has two surfaces, uses the surface whose normal is more similar to `normal`, in object space. The texel must
// have a surface.
vec3 reliefMotion(int body, int i, vec3 q, vec3 normal) {
    vec3 in_map = reliefInMap(i, q);
    ivec4 place = reliefMapPlace(i);
    ivec4 info = reliefMapInfo(i);
    ivec2 at = ivec2(clamp(in_map.xy, vec2(0.0), vec2(place.w - 1, info.x - 1)));
    uvec4 words = texelFetch(u_relief_front_back, reliefTexel(place.x + at.y * place.y + at.x, RELIEF_LOG2_WIDTHS.z), 0);
    float front = reliefDot(normal, reliefUnit(reliefOctahedron(words.r)));
    float back = reliefDot(normal, reliefUnit(reliefOctahedron(words.g)));
    at.y += words.b == 0u || (words.a != 0u && back > front) ? info.x : 0;
    int texel = info.w + (at.y << RELIEF_LOG2_WIDTHS.x) + at.x;
    vec3 motion = texelFetch(u_relief_float, reliefTexel(texel, RELIEF_LOG2_WIDTHS.x), 0).xyz;
    float scale = reliefBodyResponse(body).x;
    return (scale * scale) * reliefTurnedBack(body, motion);
}

// Returns the motion of the surface of a body near a world point; zero for bodies that are not live. Each map is
// evaluated separately because near a silhouette one map may miss a surface that another map sees. If several maps see
// the surface at the same distance, the map that faces it most decides: in a view along the surface, the surface in the
// same texel may be far away.
vec3 reliefBodyMotion(int body, vec3 p) {
    if (reliefBodyMaps(body).z == 0) {
        return vec3(0.0);
    }
    vec3 q = reliefToObject(body, p);
    ReliefField met = ReliefField(RELIEF_FAR_OUTSIDE, vec3(0.0), -1);
    float best = 0.0;
    int first = reliefBodyMaps(body).x;
    for (int i = first; i < first + reliefBodyMaps(body).y; ++i) {
        ReliefField one = reliefMaps(i, i + 1, q, true);
        if (one.map >= 0 && one.distance < RELIEF_FAR_OUTSIDE) {
            float texel = 1.0 / length(reliefMapRow(i, 0).xyz);
            float faces = abs(reliefDot(one.normal, reliefUnit(reliefMapRow(i, 2).xyz))) / (abs(one.distance) + texel);
            if (faces >= best) {
                best = faces;
                met = one;
            }
        }
    }
    return met.map >= 0 ? reliefMotion(body, met.map, q, met.normal) : vec3(0.0);
}

// Returns the longest texel diagonal of a live body's maps, world units.
float reliefBodyTexel(int body) {
    float texel = 0.0;
    int first = reliefBodyMaps(body).x;
    for (int i = first; i < first + reliefBodyMaps(body).y; ++i) {
        texel = max(texel, length(1.0 / vec2(length(reliefMapRow(i, 0).xyz), length(reliefMapRow(i, 1).xyz))));
    }
    return reliefBodyResponse(body).x * texel;
}

#else

vec3 reliefBodyMotion(int body, vec3 p) {
    return vec3(0.0);
}

float reliefBodyTexel(int body) {
    return 0.0;
}

#endif
