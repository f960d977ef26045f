// SPDX-License-Identifier: Apache-2.0
// Writes the cosine-weighted fraction of the sky that each voxel sees past the collider: rays of limited length through
// the occupied voxels, in steps of one voxel. All voxels use the same rays, so that neighbours are consistent.
//!include picture/sky.glsl
//!include picture/volume.glsl

uniform highp sampler3D u_occupied;
uniform vec3 u_occupied_shift;  // object space to 0…1 of u_occupied: u_occupied_scale · (p - shift)
uniform vec3 u_occupied_scale;
uniform int u_sky_rays;         // per voxel
uniform int u_sky_steps;        // per ray

layout(location = 0) out float o_share;

float occupied(vec3 p) {
    vec3 at = u_occupied_scale * (p - u_occupied_shift);
    bool within = all(greaterThanEqual(at, vec3(0.0))) && all(lessThanEqual(at, vec3(1.0)));
    return within ? textureLod(u_occupied, at, 0.0).r : 0.0;
}

// Returns the start of a voxel's rays. Voxels are also looked up on surfaces. If an upward surface crosses the voxel or
// lies just above it, the rays start above that surface. Below a downward surface, the voxel stays dark.
vec3 startAt(vec3 p) {
    float here = occupied(p);
    vec2 step = vec2(u_voxel, 0.0);
    vec3 away = vec3(occupied(p - step.xyy) - occupied(p + step.xyy), occupied(p - step.yxy) - occupied(p + step.yxy),
                     occupied(p - step.yyx) - occupied(p + step.yyx));
    away.y += 0.2;  // a sheet through the centre faces both ways
    return here > 0.0 && away.y > 0.0 ? p + (u_voxel * (here < 1.0 ? here : 2.0)) * normalize(away) : p;
}

void main() {
    vec3 start = startAt(voxelCenter(voxelHere()));
    float open = 0.0;
    for (int ray = 0; ray < u_sky_rays; ++ray) {
        float r2 = (float(ray) + 0.5) / float(u_sky_rays);
        float angle = TWO_PI * 0.618034 * float(ray);
        vec3 d = vec3(sqrt(r2) * cos(angle), sqrt(1.0 - r2), sqrt(r2) * sin(angle));
        float most = 0.0;
        for (int i = 1; i <= u_sky_steps && most < 0.6; ++i) {
            most = max(most, occupied(start + (float(i) * u_voxel) * d));
        }
        open += 1.0 - smoothstep(0.2, 0.5, most);
    }
    o_share = open / float(u_sky_rays);
}
