// SPDX-License-Identifier: Apache-2.0
// A step with distances in a sparse grid of bricks, as game engines use, in place of depth maps: the baseline of
// `relief-bench step --bricks`. Everything except the solid is shared with particles/step.frag. With RELIEF_DENSE there
// is one brick and no index.
//
// A point near the surface costs one index fetch and one filtered fetch of the atlas. Other points in the mesh's box cost
// one index fetch, and points outside the box no fetch. Only points inside the mesh need a normal: three more fetches.
//!include particles/step.glsl

#if !defined(RELIEF_DENSE)
uniform highp usampler3D u_index;  // for each cube: the position of its brick in the atlas, or one of the two values
                                   // below
uniform uint u_outside;
uniform uint u_inside;
#endif
uniform highp sampler3D u_atlas;
uniform vec3 u_box_min;   // of the mesh, object space
uniform vec3 u_box_max;
uniform vec3 u_origin;    // of cube (0, 0, 0)
uniform vec3 u_per_cube;  // cubes per object unit
uniform vec3 u_last_cube;
uniform vec3 u_cells;     // voxels per cube
uniform vec3 u_per_node;  // 1 / the atlas's texels
uniform float u_range;    // object units

float distanceAt(vec3 place) {
    return u_range * textureLod(u_atlas, place * u_per_node, 0.0).r;
}

// Computes the distance at p and its position in the atlas, in texels. Returns false if there is no brick.
bool brickAt(vec3 p, out float distance, out vec3 place) {
    bool found = false;
    distance = RELIEF_FAR_OUTSIDE;
    place = vec3(0.0);
    if (all(greaterThanEqual(p, u_box_min)) && all(lessThanEqual(p, u_box_max))) {
        vec3 in_cubes = (p - u_origin) * u_per_cube;
#if defined(RELIEF_DENSE)
        found = true;
        place = in_cubes * u_cells + 0.5;
#else
        vec3 cube = clamp(floor(in_cubes), vec3(0.0), u_last_cube);
        uint brick = texelFetch(u_index, ivec3(cube), 0).r;
        found = brick < u_inside;
        distance = brick == u_inside ? -u_range : RELIEF_FAR_OUTSIDE;
        uint mask = (1u << RELIEF_BRICK_BITS) - 1u;
        vec3 corner = vec3(float(brick & mask), float((brick >> RELIEF_BRICK_BITS) & mask), float(brick >> (2 * RELIEF_BRICK_BITS)));
        place = corner * (u_cells + 1.0) + (in_cubes - cube) * u_cells + 0.5;
#endif
        if (found) {
            distance = distanceAt(place);
        }
    }
    return found;
}

Solid solid(vec3 p, float radius) {
    float distance;
    vec3 place;
    vec3 normal = vec3(0.0);
    if (brickAt(p, distance, place) && distance < 0.0) {
        // Within a voxel the filter is linear along each axis: a step of half a voxel towards its centre gives the
        // exact slope.
        vec3 way = 0.5 - step(0.5, fract(place - 0.5));
        vec3 beside = vec3(distanceAt(place + vec3(way.x, 0.0, 0.0)), distanceAt(place + vec3(0.0, way.y, 0.0)),
                           distanceAt(place + vec3(0.0, 0.0, way.z)));
        vec3 slope = (beside - distance) * way * u_cells * u_per_cube;  // up to a factor
        // Zero if all codes are clamped.
        normal = slope * inversesqrt(max(dot(slope, slope), 1e-30));
    }
    return Solid(distance < 0.0 ? distance : RELIEF_FAR_OUTSIDE, normal, 0, 0, vec3(0.0));
}

bool insideBefore(vec3 p, float radius, Solid s, bool free) {
    float distance;
    vec3 place;
    brickAt(p, distance, place);
    return distance < 0.0;
}

//!include particles/step_still.glsl
