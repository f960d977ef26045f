// SPDX-License-Identifier: Apache-2.0
// A volume of cubic voxels, drawn as a picture of its layers, which then are copied into a 3-D texture:
//
//     ┌─────┬─────┬─────┐
//     │ z=2 │  …  │     │    a layer has size.x × size.y pixels
//     ├─────┼─────┼─────┤    tiles.x of them in a row
//     │ z=0 │ z=1 │     │
//     └─────┴─────┴─────┘
uniform ivec3 u_size;        // voxels
uniform int u_tiles;         // in a row
uniform vec3 u_first;        // object space: the middle of voxel (0, 0, 0)
uniform float u_voxel;       // its side, object units

// The voxel of this fragment; z is u_size.z or more where there is none.
ivec3 voxelHere() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 tile = at / u_size.xy;
    return ivec3(at - tile * u_size.xy, tile.y * u_tiles + tile.x);
}

vec3 voxelCenter(ivec3 voxel) {
    return u_first + u_voxel * vec3(voxel);
}
