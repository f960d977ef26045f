// SPDX-License-Identifier: Apache-2.0
// The core of the method: the distance from a point to a collider by its depth maps. formats/depth_map.cpp and
// formats/collider.cpp are the C++ version, formats/README.md is the specification; change all three together.
//
// ColliderTextures compiles this file (collider_block.h: RELIEF_MAP_CAPACITY and so on) and binds its inputs.
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
// The sign is reversed for orthographic maps that keep the farthest surface and for cubes that keep the nearest. These
// are the paper's projected distances. In a map of planes f = n*(P - S), where S is the surface point on the ray
// through the texel's centre; normals point outwards, so no sign is reversed.

//!include collider/maps.glsl

// The combined vote. map: the deciding map, -1 if every map abstains; normal: zero if distance is RELIEF_FAR_OUTSIDE
// (only "outside" is known, or no map votes).
struct ReliefField {
    float distance;
    vec3 normal;
    int map;
};

bool reliefInside(ReliefField field) {
    return field.map >= 0 && field.distance < 0.0;
}

// Rule 2 of the paper: one outside vote is enough for outside; the smallest positive or the largest negative vote wins.
// A vote of 0 is outside, so that the order of the maps does not matter.
bool reliefReplaces(float vote, float best) {
    return (best < 0.0 && vote > best) || (vote >= 0.0 && vote < best);
}

#define RELIEF_LOG2_WIDTH RELIEF_LOG2_WIDTHS.z
//!include engines/relief.glsl
//!include collider/texels.glsl
//!include collider/map_votes.glsl

#if defined(RELIEF_HAS_PATCHES)
//!include collider/patches.glsl
#else
vec3 reliefPatchRoots(int i) {
    return vec3(0.0);
}
#endif

// Does not name the votes of absent formats: drivers inline every call before they remove branches that are never taken.
ReliefVote reliefVoteOf(int i, ivec4 info, vec3 p, bool whole) {
    vec3 in_map = reliefInMap(i, p);
    ivec4 place = reliefMapPlace(i);
    ReliefVote vote = ReliefVote(RELIEF_FAR_INSIDE, RELIEF_NO_CODE);
#if defined(RELIEF_HAS_PATCHES)
    if (reliefIsPatches(info)) {
        vote = reliefVotePatches(i, info, in_map, whole);
    } else
#endif
#if defined(RELIEF_HAS_CUBE)
    if (reliefIsCube(info)) {
        vote = reliefVoteCube(i, in_map, place, info);
    } else
#endif
    {
#if defined(RELIEF_HAS_ORTHOGRAPHIC)
        vote = reliefVoteOrthographic(i, in_map, place, info, whole);
#endif
    }
    return vote;
}

ReliefVote reliefVote(int i, vec3 p, bool whole) {
    return reliefVoteOf(i, reliefMapInfo(i), p, whole);
}

// The best of the votes so far; map -1: none.
struct ReliefBest {
    float distance;
    RELIEF_CODE normal;
    int map;
};
const ReliefBest RELIEF_NO_VOTE = ReliefBest(RELIEF_FAR_INSIDE, RELIEF_NO_CODE, -1);

void reliefJoin(inout ReliefBest best, int i, ivec4 info, vec3 p, bool whole) {
    ReliefVote vote = reliefVoteOf(i, info, p, whole);
    // Without `whole`, the best vote so far is negative.
    if (whole ? reliefReplaces(vote.distance, best.distance) : vote.distance > best.distance) {
        best = ReliefBest(vote.distance, vote.normal, i);
    }
}

ReliefField reliefFieldOf(ReliefBest best) {
    bool known = best.map >= 0 && best.distance < RELIEF_FAR_OUTSIDE;
    float distance = best.map >= 0 ? best.distance : RELIEF_FAR_OUTSIDE;
    return ReliefField(distance, known ? reliefDecode(best.normal) : vec3(0.0), best.map);
}

// Evaluates only the maps [first, end), as reliefSolid or, with `whole`, reliefEvaluate.
ReliefField reliefMaps(int first, int end, vec3 p, bool whole) {
    ReliefBest best = RELIEF_NO_VOTE;
    for (int i = first; i < end && (whole || best.distance < 0.0); ++i) {
        reliefJoin(best, i, reliefMapInfo(i), p, whole);
    }
    return reliefFieldOf(best);
}

// Returns the vector from p to the nearest point of the volume of map i; zero inside.
vec3 reliefToVolume(int i, vec3 p) {
    vec3 in_map = reliefInMap(i, p);
    vec3 low = vec3(-1.0);
    vec3 high = vec3(1.0);
    if (reliefIsPatches(reliefMapInfo(i))) {
        low = vec3(0.0);
        high = reliefPatchRoots(i);
    } else if (!reliefIsCube(reliefMapInfo(i))) {  // its border is empty
        low = vec3(1.0, 1.0, 0.0);
        high = vec3(reliefMapColumn(i, 1).w, reliefMapColumn(i, 2).w, 1.0);
    }
    return reliefFromMap(i, clamp(in_map, low, high) - in_map);
}

// Evaluates the maps [first, end) for a point that should be inside; any distance >= 0 means outside. Map `start` is
// evaluated first: it sees the surface near p and is most likely to classify p as outside.
ReliefBest reliefProbe(int first, int end, int start, vec3 p) {
    ReliefBest best = RELIEF_NO_VOTE;
    int i = start;
    for (int k = first; k < end && best.distance < 0.0; ++k) {
        ReliefVote vote = reliefVote(i, p, false);
        // Ties go to the first map, as in reliefMaps().
        if (vote.distance > best.distance || (vote.distance == best.distance && i < best.map)) {
            best = ReliefBest(vote.distance, vote.normal, i);
        }
        i = k < start ? k : k + 1;
    }
    return best;
}

// Returns the surface that a ball penetrates or touches. If its centre is inside: reliefSolid() of the centre, deeper
// by the radius. Otherwise each map that sees a surface nearby gives the direction to it, and the ball's point in that
// direction is evaluated; the deepest such point decides, with a negative distance. Without contact:
// RELIEF_FAR_OUTSIDE, or no map if all maps abstain.
ReliefField reliefBall(int first, int end, vec3 center, float radius) {
    ReliefBest inside = RELIEF_NO_VOTE;
    ReliefField touched = ReliefField(RELIEF_FAR_OUTSIDE, vec3(0.0), -1);
    for (int i = first; i < end; ++i) {
        ReliefVote vote = reliefVote(i, center, true);
        if (vote.distance > inside.distance) {
            inside = ReliefBest(vote.distance, vote.normal, i);
        }
        // A projected distance may be several times the actual distance.
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
    if (inside.map >= 0 && inside.distance < 0.0) {  // WebGL does not support ?: for structures
        touched = reliefFieldOf(inside);
        touched.distance -= radius;
    }
    return touched;
}

#if RELIEF_BODIES == 0

// Evaluates all maps, in their common object space.
ReliefField reliefEvaluate(vec3 p) {
    return reliefMaps(0, u_relief_count.x, p, true);
}

// Format and flags are constants here: if a compiler had to read them from the block, it would keep the code of every
// format for every map, and a GL may execute it.
#define RELIEF_VOTE_OF(n, format, flags) \
    if (best.distance < 0.0) { \
        reliefJoin(best, n, ivec4(reliefMapInfo(n).x, format, flags, reliefMapInfo(n).w), p, false); \
    }

// For simulation steps: equals reliefEvaluate if P is inside. Otherwise the first map that classifies P as outside ends
// the loop, so that most points cost one fetch for any number of maps. (Rule 2 never turns a vote >= 0 into a negative
// one.) The first maps have constant indices, so that GPUs need not index the block dynamically.
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

// Returns reliefInside(reliefSolid(p)), evaluating map `first` before the others: the map that decided nearby is most
// likely to classify p as outside. With few maps, constant indices are cheaper than this order.
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
