// SPDX-License-Identifier: Apache-2.0
// The method's core: the distance of a point to a collider by its depth maps. formats/depth_map.cpp and
// formats/collider.cpp are the same in C++, formats/README.md in words; all three change together.
//
// ColliderTextures compiles it (collider_block.h: RELIEF_MAP_CAPACITY and so on) and binds all below.
//
//     P --T_i--> P'    orthographic                       cube
//                      z'                                        \  dist  /
//                      |  near                                 \   +--+  /
//                      | +----------+ 0                          \ | \|/   P' in [-1,1]^3
//                      | |   dist   |     f = z_scale *          --+  *--+
//                      | | ~~~~~~~~~|        (dist - z')         / | /|\   f = (|P'| - dist) * |s*d|
//                      v | * P'     |     negative: inside     /   +--+  \   d = P'/|P'|
//                        +----------+ 1
//
// An orthographic map that keeps the farthest surface, and a cube that keeps the nearest, turn the sign. Those
// are the paper's projected distances. In a map of planes f = n*(P - S) instead, with S the surface point on
// the ray through the texel's centre; the normal points outwards, so that no sign turns.

//!include collider/maps.glsl

// The combined vote. map is the deciding map, -1 where every map abstains; normal is zero where nothing but "outside"
// is known (distance RELIEF_FAR_OUTSIDE).
struct ReliefField {
    float distance;
    vec3 normal;
    int map;
};

bool reliefInside(ReliefField field) {
    return field.map >= 0 && field.distance < 0.0;
}

// Rule 2 of the paper: outside as soon as one map sees P outside; the smallest positive or the largest
// negative vote wins. A vote of 0 is outside, so that the order of the maps does not matter.
bool reliefReplaces(float vote, float best) {
    return (best < 0.0 && vote > best) || (vote >= 0.0 && vote < best);
}

//!include collider/texels.glsl
//!include collider/map_votes.glsl

#if defined(RELIEF_HAS_PATCHES)
//!include collider/patches.glsl
#else
vec3 reliefPatchRoots(int i) {
    return vec3(0.0);
}
ReliefVote reliefVotePatches(int i, ivec4 info, vec3 p, bool whole) {
    return ReliefVote(RELIEF_FAR_INSIDE, RELIEF_NO_CODE);
}
#endif

ReliefVote reliefVoteOf(int i, ivec4 info, vec3 p, bool whole) {
    vec3 in_map = reliefInMap(i, p);
    ivec4 place = reliefMapPlace(i);
    ReliefVote vote;
    if (reliefIsPatches(info)) {
        vote = reliefVotePatches(i, info, in_map, whole);
    } else if (reliefIsCube(info)) {
        vote = reliefVoteCube(i, in_map, place, info);
    } else {
        vote = reliefVoteOrthographic(i, in_map, place, info, whole);
    }
    return vote;
}

ReliefVote reliefVote(int i, vec3 p, bool whole) {
    return reliefVoteOf(i, reliefMapInfo(i), p, whole);
}

// The votes so far: of none the map is -1.
struct ReliefBest {
    float distance;
    RELIEF_CODE normal;
    int map;
};
const ReliefBest RELIEF_NO_VOTE = ReliefBest(RELIEF_FAR_INSIDE, RELIEF_NO_CODE, -1);

void reliefJoin(inout ReliefBest best, int i, ivec4 info, vec3 p, bool whole) {
    ReliefVote vote = reliefVoteOf(i, info, p, whole);
    // Without `whole` the best one is below 0 so far.
    if (whole ? reliefReplaces(vote.distance, best.distance) : vote.distance > best.distance) {
        best = ReliefBest(vote.distance, vote.normal, i);
    }
}

ReliefField reliefFieldOf(ReliefBest best) {
    bool known = best.map >= 0 && best.distance < RELIEF_FAR_OUTSIDE;
    return ReliefField(best.distance, known ? reliefDecode(best.normal) : vec3(0.0), best.map);
}

// The maps [first, end) alone, as reliefSolid or, with `whole`, reliefEvaluate.
ReliefField reliefMaps(int first, int end, vec3 p, bool whole) {
    ReliefBest best = RELIEF_NO_VOTE;
    for (int i = first; i < end && (whole || best.distance < 0.0); ++i) {
        reliefJoin(best, i, reliefMapInfo(i), p, whole);
    }
    return reliefFieldOf(best);
}

// From p to the nearest point of the volume of map i; zero where p is in it.
vec3 reliefToVolume(int i, vec3 p) {
    vec3 in_map = reliefInMap(i, p);
    vec3 low = vec3(-1.0);
    vec3 high = vec3(1.0);
    if (reliefIsPatches(reliefMapInfo(i))) {
        low = vec3(0.0);
        high = reliefPatchRoots(i);
    } else if (!reliefIsCube(reliefMapInfo(i))) {  // its rim has nothing
        low = vec3(1.0, 1.0, 0.0);
        high = vec3(reliefMapColumn(i, 1).w, reliefMapColumn(i, 2).w, 1.0);
    }
    return reliefFromMap(i, clamp(in_map, low, high) - in_map);
}

// The maps [first, end) of a point that is inside; any distance that is not below 0 stands for all others. Map `start` is
// first: it saw p from near, and most often knows that it is outside.
ReliefBest reliefProbe(int first, int end, int start, vec3 p) {
    ReliefBest best = RELIEF_NO_VOTE;
    int i = start;
    for (int k = first; k < end && best.distance < 0.0; ++k) {
        ReliefVote vote = reliefVote(i, p, false);
        // Of equal votes that of the first map counts, as in reliefMaps().
        if (vote.distance > best.distance || (vote.distance == best.distance && i < best.map)) {
            best = ReliefBest(vote.distance, vote.normal, i);
        }
        i = k < start ? k : k + 1;
    }
    return best;
}

// The surface that a ball is in or touches. Where its centre is inside, as reliefSolid() of that, and deeper by the radius. Else
// each map that sees a surface near gives the direction to it, and the point of the ball there is evaluated; the deepest such
// point decides, with a distance below 0. Where it touches nothing: RELIEF_FAR_OUTSIDE, or where all maps abstain, no map.
ReliefField reliefBall(int first, int end, vec3 center, float radius) {
    ReliefBest inside = RELIEF_NO_VOTE;
    ReliefField touched = ReliefField(RELIEF_FAR_OUTSIDE, vec3(0.0), -1);
    for (int i = first; i < end; ++i) {
        ReliefVote vote = reliefVote(i, center, true);
        if (vote.distance > inside.distance) {
            inside = ReliefBest(vote.distance, vote.normal, i);
        }
        // A projected distance may be some times the distance.
        bool seen = vote.distance >= 0.0 && vote.distance < 4.0 * radius;
        vec3 way = reliefToVolume(i, center);
        float apart = reliefLength(way);
        if (seen || (apart > 0.0 && apart < radius)) {
            vec3 normal = seen ? reliefDecode(vote.normal) : -way / apart;
            ReliefBest probe = reliefProbe(first, end, i, center - radius * normal);
            if (probe.map >= 0 && probe.distance < 0.0 && probe.distance < touched.distance) {
                touched = ReliefField(probe.distance, seen ? reliefDecode(probe.normal) : normal, probe.map);
            }
        }
    }
    if (inside.map >= 0 && inside.distance < 0.0) {  // WebGL has no ?: of structures
        touched = reliefFieldOf(inside);
        touched.distance -= radius;
    }
    return touched;
}

#if RELIEF_BODIES == 0

// Of all maps, in the object space that they share.
ReliefField reliefEvaluate(vec3 p) {
    return reliefMaps(0, u_relief_count.x, p, true);
}

// Its format and flags are numbers here: a compiler that reads them in the block keeps the code of every format for every
// map, and a GL may run it.
#define RELIEF_VOTE_OF(n, format, flags) \
    if (best.distance < 0.0) { \
        reliefJoin(best, n, ivec4(reliefMapInfo(n).x, format, flags, reliefMapInfo(n).w), p, false); \
    }

// For a step of a simulation: the same as reliefEvaluate where P is inside; where it is not, the first map that sees it
// outside ends the loop, so that most points cost one fetch however many maps there are. (Rule 2 never turns a vote >= 0
// into one below.) The first maps have constant indices, so that GPUs need not index the block for them.
ReliefField reliefSolid(vec3 p) {
    ReliefBest best = RELIEF_NO_VOTE;
    RELIEF_VOTES
#if RELIEF_MAP_CAPACITY > RELIEF_UNROLLED_MAPS
    for (int i = RELIEF_UNROLLED_MAPS; i < u_relief_count.x && best.distance < 0.0; ++i) {
        reliefJoin(best, i, reliefMapInfo(i), p, false);
    }
#endif
    return reliefFieldOf(best);
}

// reliefInside(reliefSolid(p)) with map `first` before the others: the map that decides nearby most often knows that p is
// outside. With a few maps constants are cheaper than what that order saves.
bool reliefSolidAt(vec3 p, int first) {
#if RELIEF_MAP_CAPACITY <= 4
    return reliefInside(reliefSolid(p));
#else
    float best = RELIEF_FAR_INSIDE;
    int i = first;
    for (int k = 0; k < u_relief_count.x && best < 0.0; ++k) {
        best = max(best, reliefVote(i, p, false).distance);
        i = k < first ? k : k + 1;
    }
    return best < 0.0 && best > RELIEF_FAR_INSIDE;
#endif
}

#else

//!layer bodies/bodies.glsl

#endif
