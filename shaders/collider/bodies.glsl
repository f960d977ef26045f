// The bodies of a world (world.glsl): poses, and their union.

vec3 reliefToObject(vec4 row0, vec4 row1, vec4 row2, vec3 p) {
    return vec3(reliefRow(row0, p), reliefRow(row1, p), reliefRow(row2, p));
}

// A point of a body's object space in the world. (The transpose of a rotation is its inverse.)
vec3 reliefToWorld(vec4 row0, vec4 row1, vec4 row2, float scale, vec3 q) {
    return (scale * scale) * (row0.xyz * (q.x - row0.w) + (row1.xyz * (q.y - row1.w) + row2.xyz * (q.z - row2.w)));
}

// World to object space and back, at the beginning and at the end of the step.
vec3 reliefBodyNow(int body, vec3 p) {
    return reliefToObject(reliefBodyRow(body, 0), reliefBodyRow(body, 1), reliefBodyRow(body, 2), p);
}
vec3 reliefBodyBefore(int body, vec3 p) {
    return reliefToObject(reliefBodyRowBefore(body, 0), reliefBodyRowBefore(body, 1),
                          reliefBodyRowBefore(body, 2), p);
}
vec3 reliefWorldNow(int body, vec3 q) {
    return reliefToWorld(reliefBodyRow(body, 0), reliefBodyRow(body, 1), reliefBodyRow(body, 2),
                         reliefBodyResponse(body).x, q);
}
vec3 reliefWorldBefore(int body, vec3 q) {
    return reliefToWorld(reliefBodyRowBefore(body, 0), reliefBodyRowBefore(body, 1),
                         reliefBodyRowBefore(body, 2), reliefBodyResponse(body).x, q);
}

vec3 reliefWorldNormal(int body, vec3 n) {
    return reliefBodyResponse(body).x *
           (reliefBodyRow(body, 0).xyz * n.x +
            (reliefBodyRow(body, 1).xyz * n.y + reliefBodyRow(body, 2).xyz * n.z));
}

// One body and a ball about a point of its object space, as reliefSolid or, with `whole`, reliefEvaluate.
ReliefField reliefBodyField(int body, vec3 q, float radius, bool whole) {
    int first = reliefBodyMaps(body).x;
    int end = first + reliefBodyMaps(body).y;
#if defined(RELIEF_RADIUS)
    if (radius > 0.0) {
        return reliefBall(first, end, q, radius / reliefBodyResponse(body).x);
    }
#endif
    return reliefMaps(first, end, q, whole);
}

// Joins a body to the union of those before it, in which the nearest, inside the deepest, decides, and of equals the first.
void reliefJoinBody(inout ReliefField best, inout int best_body, int body, vec3 p, float radius, bool whole) {
#if defined(RELIEF_MASKS)  // of a step, alone: step.frag
    if (!collidesWith(reliefBodyMaps(body).w)) {
        return;
    }
#endif
    float scale = reliefBodyResponse(body).x;
    ReliefField field = reliefBodyField(body, reliefBodyNow(body, p), radius, whole);
    float distance = scale * field.distance;
    if (field.map >= 0 && (distance < best.distance || (distance == best.distance && body < best_body))) {
        best = ReliefField(distance, reliefWorldNormal(body, field.normal), field.map);
        best_body = body;
    }
}

// cellHash() of body_grid.h; the places in cells are its placeInCell().
uint reliefCellHash(ivec3 cell) {
    uint h = uint(cell.x) * 0x8da6b343u + uint(cell.y) * 0xd8163841u + uint(cell.z) * 0xcb1ab31fu;
    h ^= h >> 15u;
    h *= 0x2c1b3c6du;
    return h ^ (h >> 13u);
}

// The next body whose box holds a point, in the lists of its cells one after another.
struct ReliefSearch {
    int level;    // the next one
    uint entry;   // the next one of the list
    uint end;
    uint hash;    // of the cell
    uvec3 place;  // in it
};

int reliefNextBody(inout ReliefSearch search, vec3 p) {
    int body = -1;
    while (body < 0 && (search.entry < search.end || search.level < u_relief_world_place.w)) {
        if (search.entry < search.end) {
            uvec4 entry = reliefWords(int(search.entry));
            uvec3 low = (uvec3(entry.y) >> uvec3(0u, 8u, 16u)) & 255u;
            uvec3 high = (uvec3(entry.z) >> uvec3(0u, 8u, 16u)) & 255u;
            bool holds = entry.w == search.hash && all(greaterThanEqual(search.place, low)) && all(lessThanEqual(search.place, high));
            body = holds ? int(entry.x) : -1;
            ++search.entry;
        } else {
            ivec4 cells = u_relief_levels[search.level];
            vec3 in_cells = clamp(p * intBitsToFloat(cells.x), -1e9, 1e9);
            vec3 cell = floor(in_cells);
            search.hash = reliefCellHash(ivec3(cell));
            search.place = uvec3(clamp(256.0 * (in_cells - cell), 0.0, 255.0));
            uvec4 list = reliefWords(cells.y + int(search.hash & uint(cells.z)));
            search.entry = list.x;
            search.end = list.y;
            ++search.level;
        }
    }
    return body;
}

// The union of all bodies in the world. The distance is in world units. body is -1 where none votes. Without `whole` those
// alone whose boxes hold p, which a box grown by the radius does where a ball meets the body: no other is inside. Each lane
// searches on to its next body before any evaluates one, so that all evaluate theirs at once.
ReliefField reliefUnion(vec3 p, float radius, bool whole, out int body) {
    ReliefField best = ReliefField(RELIEF_FAR_OUTSIDE, vec3(0.0), -1);
    body = -1;
    if (whole) {
        for (int b = 0; b < reliefBodyCount(); ++b) {
            reliefJoinBody(best, body, b, p, radius, true);
        }
    } else {
        ReliefSearch search = ReliefSearch(0, 0u, 0u, 0u, uvec3(0u));
        for (int b = reliefNextBody(search, p); b >= 0; b = reliefNextBody(search, p)) {
            reliefJoinBody(best, body, b, p, radius, false);
        }
    }
    return best;
}

ReliefField reliefSolid(vec3 p) {
    int body;
    return reliefUnion(p, 0.0, false, body);
}

ReliefField reliefEvaluate(vec3 p) {
    int body;
    return reliefUnion(p, 0.0, true, body);
}

#if RELIEF_LIVE

// The motion of the surface of map i at a point p of object space since the update before, in object units. Of two ends it
// is the one whose normal is more like `normal`. Zero where the map has no surface.
vec3 reliefMotion(int i, vec3 p, vec3 normal) {
    vec3 in_map = reliefInMap(i, p);
    ivec4 place = reliefMapPlace(i);
    ivec4 info = reliefMapInfo(i);
    ivec2 at = ivec2(clamp(in_map.xy, vec2(0.0), vec2(place.w - 1, info.x - 1)));
    uvec4 words = texelFetch(u_relief_front_back, reliefTexel(place.x + at.y * place.y + at.x, RELIEF_LOG2_WIDTHS.z), 0);
    float front = reliefDot(normal, reliefUnit(reliefOctahedron(words.r)));
    float back = reliefDot(normal, reliefUnit(reliefOctahedron(words.g)));
    at.y += words.b == 0u || (words.a != 0u && back > front) ? info.x : 0;
    int texel = info.w + (at.y << RELIEF_LOG2_WIDTHS.x) + at.x;
    return texelFetch(u_relief_float, reliefTexel(texel, RELIEF_LOG2_WIDTHS.x), 0).xyz;
}

// The same of a body; zero of one that is not live. q: its object space at the end of the step; normal: in the world.
vec3 reliefBodyMotion(int body, int map, vec3 q, vec3 normal) {
    if (reliefBodyMaps(body).z == 0 || map < 0) {
        return vec3(0.0);
    }
    vec3 in_body = reliefBodyResponse(body).x *
                   reliefToObject(vec4(reliefBodyRow(body, 0).xyz, 0.0), vec4(reliefBodyRow(body, 1).xyz, 0.0),
                                  vec4(reliefBodyRow(body, 2).xyz, 0.0), normal);
    return reliefMotion(map, q, in_body);
}

// The motion of a particle that rests on a live body: that of the nearest surface; zero on one that is not live. Each map
// is evaluated alone: where one sees nothing near a silhouette, another one does.
vec3 reliefNearestMotion(int body, vec3 q) {
    if (reliefBodyMaps(body).z == 0) {
        return vec3(0.0);
    }
    ReliefField nearest = ReliefField(RELIEF_FAR_OUTSIDE, vec3(0.0), -1);
    int first = reliefBodyMaps(body).x;
    for (int i = first; i < first + reliefBodyMaps(body).y; ++i) {
        ReliefField one = reliefMaps(i, i + 1, q, true);
        if (one.map >= 0 && abs(one.distance) < abs(nearest.distance)) {
            nearest = one;
        }
    }
    return nearest.map >= 0 ? reliefMotion(nearest.map, q, nearest.normal) : vec3(0.0);
}

#else

vec3 reliefBodyMotion(int body, int map, vec3 q, vec3 normal) {
    return vec3(0.0);
}

vec3 reliefNearestMotion(int body, vec3 q) {
    return vec3(0.0);
}

#endif
