// SPDX-License-Identifier: Apache-2.0
// For collider.glsl: tests of map formats, and the votes of projected maps, orthographic and cube.

// ColliderTextures defines RELIEF_HAS_... for the formats present.
#if defined(RELIEF_HAS_FLOAT) || defined(RELIEF_HAS_FIXED) || defined(RELIEF_HAS_FRONT_BACK)
#define RELIEF_HAS_ORTHOGRAPHIC
#endif

// The tests of a map's format are constants if all maps have the same format: otherwise a GL may execute the branches of
// all formats for every map.
bool reliefIsCube(ivec4 info) {
#if !defined(RELIEF_HAS_CUBE)
    return false;
#elif defined(RELIEF_HAS_ORTHOGRAPHIC)
    return info.y == RELIEF_MAP_FORMAT_CUBE8;
#else
    return true;
#endif
}

// Test this before the other formats.
bool reliefIsPatches(ivec4 info) {
#if !defined(RELIEF_HAS_PATCHES)
    return false;
#elif defined(RELIEF_HAS_ORTHOGRAPHIC) || defined(RELIEF_HAS_CUBE)
    return info.y == RELIEF_MAP_FORMAT_PATCHES;
#else
    return true;
#endif
}

bool reliefIsFrontBack(ivec4 info) {  // orthographic maps only
#if !defined(RELIEF_HAS_FRONT_BACK)
    return false;
#elif defined(RELIEF_HAS_FLOAT) || defined(RELIEF_HAS_FIXED)
    return info.y == RELIEF_MAP_FORMAT_FRONT_BACK_HALF || info.y == RELIEF_MAP_FORMAT_FRONT_BACK_FIXED;
#else
    return true;
#endif
}

// The vote of one map. An abstention is RELIEF_FAR_INSIDE, which never wins.
struct ReliefVote {
    float distance;
    RELIEF_CODE normal;
};

float reliefEmpty(ivec4 info) {
    return reliefHas(info, RELIEF_EMPTY_IS_OUTSIDE) ? RELIEF_FAR_OUTSIDE : RELIEF_FAR_INSIDE;
}

// Functions that run for every particle do not return early: a GL may turn an early return into a loop.

// A point of an orthographic map relative to the ray through its texel's centre.
struct ReliefSight {
    int texel;    // texel index
    float z;      // depth of the point
    bool plane;   // set if the map decodes planes
    vec3 from;    // see reliefPlane(); likewise ray
    vec3 ray;
    float scale;  // z_scale
};

float reliefSightPlane(vec3 along_normal, float depth, ReliefSight sight) {
    return reliefOctahedralPlane(along_normal, depth, sight.from, sight.ray);
}

float reliefSightProjected(ivec4 info, float depth, ReliefSight sight) {
    return sight.scale * ((info.z & RELIEF_KEEPS_FARTHEST) != 0 ? sight.z - depth : depth - sight.z);
}

// The votes of each kind of texel; undefined if `found` is false.

// Outside if either surface votes outside.
ReliefVote reliefVoteFrontBack(ivec4 info, ReliefSight sight, bool whole, out bool found) {
    uvec4 words = texelFetch(u_relief_front_back, reliefTexel(sight.texel, RELIEF_LOG2_WIDTHS.z), 0);
    // Uses integers, which needs fewer instructions than combined conditions.
    uint depths = !sight.plane || RELIEF_HALF_EMPTY ? words.b | words.a : words.b;
    found = depths != 0u;
    float front = reliefFrontBackDepth(info.y, words.b);
    float back = reliefFrontBackDepth(info.y, words.a);
    if (sight.plane) {
        front = reliefSightPlane(reliefOctahedron(words.r), front, sight);
        back = reliefSightPlane(reliefOctahedron(words.g), back, sight);
    } else {
        front = sight.scale * (front - sight.z);
        back = sight.scale * (sight.z - back);
    }
    if (!sight.plane || RELIEF_HALF_EMPTY) {
        front = words.b != 0u ? front : RELIEF_FAR_INSIDE;
        back = words.a != 0u ? back : RELIEF_FAR_INSIDE;
    }
    float distance = max(front, back);
    if (whole) {
        distance = reliefReplaces(back, front) ? back : front;
    }
    return ReliefVote(distance, reliefCode(distance == front ? words.r : words.g));
}

ReliefVote reliefVoteFixed(ivec4 info, ReliefSight sight, out bool found) {
    float depth;
    vec2 index;
    found = reliefFixedTexel(sight.texel, 1.0, depth, index);
    float distance = sight.plane ? reliefSightPlane(reliefOctahedron(index), depth, sight)
                                 : reliefSightProjected(info, depth, sight);
    return ReliefVote(distance, reliefCode(index));
}

#if defined(RELIEF_HAS_FLOAT)
// Normals of float maps are used as stored.
ReliefVote reliefVoteFloat(ivec4 info, ReliefSight sight, out bool found) {
    vec4 values = texelFetch(u_relief_float, reliefTexel(sight.texel, RELIEF_LOG2_WIDTHS.x), 0);
    found = values.a >= 0.0;
    float distance = sight.plane ? reliefPlane(values.rgb, 1.0, values.a, sight.from, sight.ray)
                                 : reliefSightProjected(info, values.a, sight);
    return ReliefVote(distance, values.rgb);
}
#endif

// Texels with one surface.
ReliefVote reliefVoteSingle(ivec4 info, ReliefSight sight, out bool found) {
    ReliefVote vote;
#if defined(RELIEF_HAS_FLOAT)
    if (info.y == RELIEF_MAP_FORMAT_FLOAT32) {
        vote = reliefVoteFloat(info, sight, found);
    } else
#endif
    {
        vote = reliefVoteFixed(info, sight, found);
    }
    return vote;
}

// Without `whole`, any distance >= 0 means outside.
ReliefVote reliefVoteOrthographic(int i, vec3 p, ivec4 place, ivec4 info, bool whole) {
    bool encloses = reliefHas(info, RELIEF_ENCLOSES);
    ReliefVote vote = ReliefVote(encloses ? RELIEF_FAR_OUTSIDE : RELIEF_FAR_INSIDE, RELIEF_NO_CODE);
    bool in_window = reliefInWindow(i, p);
    bool in_depth = reliefInDepth(p);
    // In front of and behind the volume, the texel only determines the distance or an abstention.
    bool sees_beyond = encloses && (whole || !reliefHas(info, RELIEF_EMPTY_IS_OUTSIDE));
    if (in_window && (in_depth || sees_beyond)) {
        ivec2 at = ivec2(p.xy);
        ReliefSight sight = ReliefSight(place.x + at.y * place.y + at.x, p.z, reliefIsPlane(info),
                                        reliefFromMap(i, vec3(p.xy - (vec2(at) + 0.5), p.z)),
                                        reliefMapColumn(i, 2).xyz, reliefObjectPerMap(i).z);
        bool found;
        if (reliefIsFrontBack(info)) {
            vote = reliefVoteFrontBack(info, sight, whole, found);
        } else {
            vote = reliefVoteSingle(info, sight, found);
        }
        if (sees_beyond && !in_depth && !(vote.distance >= 0.0)) {  // the collider does not extend there
            vote.distance = RELIEF_FAR_OUTSIDE;
        }
        vote.distance = found ? vote.distance : reliefEmpty(info);
    }
    return vote;
}

ReliefVote reliefVoteCube(int i, vec3 p, ivec4 place, ivec4 info) {
    bool encloses = reliefHas(info, RELIEF_ENCLOSES);
    ReliefVote vote = ReliefVote(encloses ? RELIEF_FAR_OUTSIDE : RELIEF_FAR_INSIDE, RELIEF_NO_CODE);
    bool in_volume = all(lessThanEqual(abs(p), vec3(1.0)));
    // Keeps the squares below from overflowing.
    if (in_volume || (encloses && all(lessThanEqual(abs(p), vec3(1e15))))) {
        float radius = reliefLength(p);
        vec3 direction = radius > 0.0 ? p / radius : vec3(1.0, 0.0, 0.0);
        vec3 st_face = reliefCubeCoordinates(direction);
        ivec2 at = min(ivec2(st_face.xy * float(place.w)), ivec2(place.w - 1));
        float depth;
        vec2 index;
        int texel = place.x + int(st_face.z) * place.z + at.y * place.y + at.x;
        bool found = reliefFixedTexel(texel, RELIEF_CUBE_DEPTH_MAX, depth, index);
        vote.normal = reliefCode(index);
        if (reliefIsPlane(info)) {
            vec3 ray = reliefUnit(reliefCubeDirection(vec3((vec2(at) + 0.5) / float(place.w), st_face.z)));
            vote.distance = reliefOctahedralPlane(reliefOctahedron(index), depth, reliefFromMap(i, p), reliefFromMap(i, ray));
        } else {
            float ahead = (info.z & RELIEF_KEEPS_FARTHEST) != 0 ? radius - depth : depth - radius;
            vote.distance = ahead * reliefLength(reliefObjectPerMap(i).xyz * direction);
        }
        if (!in_volume && !(vote.distance >= 0.0)) {
            vote.distance = RELIEF_FAR_OUTSIDE;
        }
        vote.distance = found ? vote.distance : reliefEmpty(info);
    }
    return vote;
}
