// The nearest surface of a collider, behind collider.glsl: formats/nearest_surface.cpp is the same in C++, with the reasons.
// All queries go through one loop, so that a GL that inlines every call has four loops over the maps and not forty. A file of
// its own, so that other programs need not compile it.

// distance: signed, RELIEF_FAR_OUTSIDE where no surface was found; point: the nearest found; normal: of the surface
// there; map: whose, -1 where every map abstains at P.
struct ReliefSurface {
    float distance;
    vec3 point;
    vec3 normal;
    int map;
};

// Up to three planes, the newest last, with P's side as the positive one. xyz: normal; w: distance of P.
struct ReliefCorner {
    vec4 planes[3];
    int count;
    vec3 foot;  // the point behind all that is nearest to P; relative to P
};

struct ReliefSearch {
    int first;  // of the maps
    int end;
    vec3 p;
    vec3 low;  // the bounds
    vec3 high;
    float side;
    float way;  // 1 where P is outside, -1 where it is inside
    int left;   // evaluations of the maps still allowed
    bool settled;
    ReliefSurface best;  // its distance is not signed
};

float reliefBehind(vec4 plane, vec3 y) {
    return plane.w + reliefDot(plane.xyz, y);
}

bool reliefTake(inout ReliefCorner corner, vec3 y) {
    bool taken = true;
    for (int i = 0; i < corner.count; ++i) {
        taken = taken && reliefBehind(corner.planes[i], y) <= 1e-4 * corner.planes[i].w;
    }
    corner.foot = taken ? y : corner.foot;
    return taken;
}

bool reliefTakeEdge(inout ReliefCorner corner, vec4 a, vec4 b) {
    float cosine = reliefDot(a.xyz, b.xyz);
    float sine2 = 1.0 - cosine * cosine;
    float along_a = cosine * b.w - a.w;
    float along_b = cosine * a.w - b.w;
    return sine2 > 1e-4 && along_a <= 0.0 && along_b <= 0.0 &&
           reliefTake(corner, (along_a / sine2) * a.xyz + (along_b / sine2) * b.xyz);
}

vec3 reliefCross(vec3 a, vec3 b) {
    return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

bool reliefMeet(inout ReliefCorner corner) {
    vec4 a = corner.planes[corner.count - 1];
    vec4 b = corner.planes[0];
    vec4 c = corner.planes[1];
    bool met = reliefTake(corner, -a.w * a.xyz) || corner.count == 1;
    met = met || reliefTakeEdge(corner, a, b);
    met = met || (corner.count == 3 && reliefTakeEdge(corner, a, c));
    if (!met && corner.count == 3) {
        vec3 bc = reliefCross(b.xyz, c.xyz);
        float volume = reliefDot(a.xyz, bc);
        met = abs(volume) > 1e-3;
        if (met) {
            corner.foot = (-1.0 / volume) *
                          (a.w * bc + (b.w * reliefCross(c.xyz, a.xyz) + c.w * reliefCross(a.xyz, b.xyz)));
        }
    }
    return met;
}

ReliefCorner reliefCornerOf(vec4 plane) {
    return ReliefCorner(vec4[3](plane, plane, plane), 1, -plane.w * plane.xyz);
}

void reliefDropOldest(inout ReliefCorner corner) {
    corner.planes[0] = corner.planes[1];
    corner.planes[1] = corner.planes[2];
    --corner.count;
}

void reliefAdd(inout ReliefCorner corner, vec4 plane) {
    if (corner.count == 3) {
        reliefDropOldest(corner);
    }
    corner.planes[corner.count] = plane;
    ++corner.count;
    while (!reliefMeet(corner)) {
        reliefDropOldest(corner);
    }
}

vec3 reliefClamped(ReliefSearch search, vec3 q) {
    return search.way < 0.0 ? q : min(max(q, search.low), search.high);
}

bool reliefFound(ReliefSearch search) {
    return search.best.distance < RELIEF_FAR_OUTSIDE;
}

bool reliefIsOther(ReliefSearch search, ReliefField field) {
    return field.map >= 0 && (field.distance < 0.0) != (search.way < 0.0);
}

vec4 reliefPlaneOf(ReliefSearch search, ReliefField field, vec3 y) {
    if (field.map < 0 || field.distance >= RELIEF_FAR_OUTSIDE) {
        return vec4(0.0);
    }
    vec3 normal = search.way * field.normal;
    return vec4(normal, search.way * field.distance - reliefDot(normal, y));
}

ReliefField reliefAsk(inout ReliefSearch search, vec3 q, bool whole) {
    --search.left;
    return reliefMaps(search.first, search.end, q, whole);
}

bool reliefOffer(inout ReliefSearch search, vec3 y, ReliefField field) {
    float distance = reliefLength(y);
    bool nearer = distance < search.best.distance;
    if (nearer) {
        bool far = field.distance >= RELIEF_FAR_OUTSIDE;
        search.best = ReliefSurface(distance, search.p + y, far ? y / distance : field.normal, field.map);
        search.settled = false;
    }
    return nearer;
}

void reliefFollow(inout ReliefSearch search, vec4 plane, bool has_other, vec3 other, int steps) {
    ReliefCorner corner = reliefCornerOf(plane);
    vec3 failed = vec3(0.0);
    bool halving = false;
    for (int i = 0; i < steps && search.left > 0; ++i) {
        vec3 y = 0.5 * (other + failed);
        float to_foot = 1.0;
        if (!halving) {
            float way = reliefLength(corner.foot);
            if (!(way < search.best.distance)) {
                return;
            }
            float least = RELIEF_NEAREST_SEARCH_BEYOND_MIN * search.side;
            float beyond = max(min(RELIEF_NEAREST_SEARCH_BEYOND * way, RELIEF_NEAREST_SEARCH_BEYOND_MAX * search.side), least);
            y = corner.foot + (way > least ? (beyond / way) * corner.foot : -beyond * corner.planes[corner.count - 1].xyz);
            to_foot = way / (way + beyond);
        }
        ReliefField field = reliefAsk(search, search.p + y, true);
        vec4 met = reliefPlaneOf(search, field, y);
        if (reliefIsOther(search, field)) {
            float share = met.w > 0.0 ? met.w / (met.w - search.way * field.distance) : 1.0;
            bool nearest = reliefOffer(search, max(share, to_foot) * y, field);
            has_other = true;
            other = y;
            if (!halving) {
                if (!(met.w > 0.0 && met.w < RELIEF_NEAREST_SEARCH_NEARER * search.best.distance)) {
                    search.settled = search.settled || nearest;
                    return;
                }
                corner = reliefCornerOf(met);
            }
        } else if (met.w > 0.0 && reliefBehind(met, corner.foot) > 0.0) {
            reliefAdd(corner, met);
            halving = false;
        } else if (has_other) {
            failed = y;
            halving = true;
        } else {
            return;
        }
    }
}

vec3 reliefNearerOther(inout ReliefSearch search, vec3 y, inout vec4 plane) {
    vec3 own = vec3(0.0);
    for (int i = 0; i < RELIEF_NEAREST_SEARCH_HALVINGS && search.left > 0; ++i) {
        vec3 middle = 0.5 * (own + y);
        ReliefField field = reliefAsk(search, search.p + middle, true);
        if (reliefIsOther(search, field)) {
            reliefOffer(search, middle, field);
            y = middle;
            plane = reliefPlaneOf(search, field, middle);
        } else {
            own = middle;
        }
    }
    return y;
}

vec3 reliefDiagonal(int i) {
    return 0.57735027 * vec3((i & 1) != 0 ? 1.0 : -1.0, (i & 2) != 0 ? 1.0 : -1.0, (i & 4) != 0 ? 1.0 : -1.0);
}

vec3 reliefAxis(int i) {
    float to = (i & 1) != 0 ? 1.0 : -1.0;
    return (i >> 1) == 0 ? vec3(to, 0.0, 0.0) : (i >> 1) == 1 ? vec3(0.0, to, 0.0) : vec3(0.0, 0.0, to);
}

// The next query.
const int RELIEF_WALK_VOTE = 0;        // the plane of the vote at P
const int RELIEF_WALK_BOUNDS = 1;      // the point of the bounds nearest to P
const int RELIEF_WALK_RINGS = 2;       // rings around that, for the other side
const int RELIEF_WALK_WHOLE_RINGS = 3; // rings around that, for any plane
const int RELIEF_WALK_AROUND = 4;      // around P, nearer than what was found
const int RELIEF_WALK_TURN = 5;        // beside the way to what was found
const int RELIEF_WALK_DONE = 6;
struct ReliefWalk {
    int stage;
    int ring;  // also round, turn
    int i;     // in the ring
    float before;
    float tilt;
};

void reliefNext(ReliefSearch search, inout ReliefWalk walk) {
    bool found = reliefFound(search);
    ++walk.i;
    if (walk.stage == RELIEF_WALK_RINGS && walk.i == 14 || walk.stage == RELIEF_WALK_WHOLE_RINGS && walk.i == 6) {
        --walk.ring;
        walk.i = 0;
    }
    if (walk.stage == RELIEF_WALK_VOTE) {
        walk.stage = RELIEF_WALK_BOUNDS;
    } else if (walk.stage == RELIEF_WALK_BOUNDS) {
        walk = ReliefWalk(RELIEF_WALK_RINGS, RELIEF_NEAREST_SEARCH_FINEST_RING, 0, 0.0, 0.0);
    }
    if (walk.stage == RELIEF_WALK_RINGS && walk.i == 0 && (walk.ring < 0 || found)) {
        walk = ReliefWalk(RELIEF_WALK_WHOLE_RINGS, RELIEF_NEAREST_SEARCH_FINEST_WHOLE_RING, 0, 0.0, 0.0);
    }
    if (walk.stage == RELIEF_WALK_WHOLE_RINGS && walk.i == 0 && (walk.ring < 0 || found)) {
        walk = ReliefWalk(RELIEF_WALK_AROUND, -1, 14, RELIEF_FAR_OUTSIDE, 0.0);
    }
    if (walk.stage == RELIEF_WALK_AROUND && walk.i >= 14) {
        ++walk.ring;
        walk.i = 0;
        if (walk.ring < RELIEF_NEAREST_SEARCH_ROUNDS && search.best.distance < walk.before) {
            walk.before = search.best.distance;
        } else {
            walk = ReliefWalk(RELIEF_WALK_TURN, -1, 4, search.best.distance, 2.0 * RELIEF_NEAREST_SEARCH_TILT);
        }
    }
    if (walk.stage == RELIEF_WALK_TURN && (walk.i == 4 || search.best.distance != walk.before)) {
        walk.tilt *= search.best.distance == walk.before ? 0.5 : 1.0;
        ++walk.ring;
        walk.i = 0;
        walk.before = search.best.distance;
        bool ends = walk.ring == RELIEF_NEAREST_SEARCH_TURNS || walk.tilt < RELIEF_NEAREST_SEARCH_TILT_MIN || !found || search.settled;
        walk.stage = ends ? RELIEF_WALK_DONE : RELIEF_WALK_TURN;
    }
}

vec3 reliefProbeAt(ReliefSearch search, ReliefWalk walk) {
    vec3 center = reliefClamped(search, search.p);
    vec3 q = center;
    bool diagonal = walk.i < 8 && walk.stage != RELIEF_WALK_WHOLE_RINGS;
    vec3 way = diagonal ? reliefDiagonal(walk.i) : reliefAxis(walk.stage == RELIEF_WALK_WHOLE_RINGS ? walk.i : walk.i - 8);
    if (walk.stage == RELIEF_WALK_RINGS || walk.stage == RELIEF_WALK_WHOLE_RINGS) {
        q = center + (search.side / float(1 << walk.ring)) * way;
    } else if (walk.stage == RELIEF_WALK_AROUND) {
        q = search.p + search.best.distance * ((walk.i < 8 ? RELIEF_NEAREST_SEARCH_SHARE_NEAR : RELIEF_NEAREST_SEARCH_SHARE_FAR) * way);
    } else if (walk.stage == RELIEF_WALK_TURN) {
        way = (search.best.point - search.p) / walk.before;
        vec3 across = abs(way.x) < 0.6 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
        vec3 right = across - reliefDot(across, way) * way;
        vec3 side = right / reliefLength(right);
        vec3 up = reliefCross(way, side);
        vec3 turned = way + ((walk.i & 1) != 0 ? -walk.tilt : walk.tilt) * (walk.i < 2 ? side : up);
        q = search.p + (walk.before * (1.0 - 0.25 * walk.tilt) / reliefLength(turned)) * turned;
    }
    return reliefClamped(search, q);
}

// A float map's normals may be a little longer or shorter.
vec3 reliefOfLengthOne(vec3 normal) {
    float size = reliefLength(normal);
    return size > 0.0 ? normal / size : normal;
}

// From the vote at P alone.
ReliefSurface reliefFromVote(vec3 p, ReliefField field) {
    float distance = clamp(field.distance, -RELIEF_FAR_OUTSIDE, RELIEF_FAR_OUTSIDE);
    vec3 foot = p - distance * reliefOfLengthOne(field.normal);
    bool known = distance < RELIEF_FAR_OUTSIDE && all(lessThanEqual(abs(foot), vec3(RELIEF_FAR_OUTSIDE)));
    return ReliefSurface(distance, known ? foot : p, field.normal, field.map);
}

// The maps [first, end) alone. low, high: the collider's bounds, of which nothing is outside.
ReliefSurface reliefNearest(int first, int end, vec3 p, vec3 low, vec3 high) {
    ReliefField vote = reliefMaps(first, end, p, true);
    ReliefSurface nearest = ReliefSurface(0.0, vec3(0.0), vec3(0.0), -1);
    if (vote.map >= 0) {  // WebGL has no ?: of structures
        nearest = reliefFromVote(p, vote);
    }
    vec3 size = high - low;
    float side = max(size.x, max(size.y, size.z));
    vec3 reach = max(abs(p), max(abs(low), abs(high)));
    if (vote.map >= 0 && side >= RELIEF_NEAREST_SEARCH_REACH_MIN && all(lessThanEqual(reach, vec3(RELIEF_NEAREST_SEARCH_REACH_MAX)))) {
        ReliefSearch search = ReliefSearch(first, end, p, low, high, side, vote.distance < 0.0 ? -1.0 : 1.0,
                                           RELIEF_NEAREST_SEARCH_EVALUATIONS_MAX - 1, false,
                                           ReliefSurface(RELIEF_FAR_OUTSIDE, vec3(0.0), vec3(0.0), -1));
        ReliefWalk walk = ReliefWalk(RELIEF_WALK_VOTE, 0, 0, 0.0, 0.0);
        while (walk.stage != RELIEF_WALK_DONE && search.left > 0) {
            vec3 y = vec3(0.0);
            vec4 plane = vec4(0.0);
            bool other = false;
            if (walk.stage == RELIEF_WALK_VOTE) {
                plane = reliefPlaneOf(search, vote, y);
            } else {
                vec3 q = reliefProbeAt(search, walk);
                bool whole = walk.stage == RELIEF_WALK_BOUNDS || walk.stage == RELIEF_WALK_WHOLE_RINGS;
                y = q - p;
                float apart = reliefLength(y);
                if (apart > 0.0 && apart < search.best.distance) {
                    ReliefField field = reliefAsk(search, q, whole || search.way < 0.0);
                    other = reliefIsOther(search, field);
                    if (other || whole) {
                        plane = reliefPlaneOf(search, field, y);
                    }
                    if (other) {
                        bool is_first = !reliefFound(search);
                        reliefOffer(search, y, field);
                        if (is_first) {
                            y = reliefNearerOther(search, y, plane);
                        }
                    }
                }
            }
            if (plane.w > 0.0 || walk.stage == RELIEF_WALK_VOTE && vote.distance < RELIEF_FAR_OUTSIDE) {
                reliefFollow(search, plane, other, y, walk.stage == RELIEF_WALK_VOTE ? RELIEF_NEAREST_SEARCH_STEPS : RELIEF_NEAREST_SEARCH_STEPS_FROM_PROBE);
            }
            reliefNext(search, walk);
        }
        if (reliefFound(search)) {
            nearest = search.best;
            nearest.distance = search.way * max(nearest.distance, RELIEF_NEAREST_SEARCH_DISTANCE_MIN);
        }
    }
    nearest.normal = reliefOfLengthOne(nearest.normal);
    return nearest;
}

#if RELIEF_BODIES == 0

// Of all maps, in the object space that they share.
ReliefSurface reliefNearest(vec3 p, vec3 low, vec3 high) {
    return reliefNearest(0, u_relief_count.x, p, low, high);
}

#endif
