// SPDX-License-Identifier: Apache-2.0
// A volume of cubic voxels, rendered as a picture of its layers, which are then copied into a 3-D texture:
//
//     ┌─────┬─────┬─────┐
//     │ z=2 │  …  │     │    a layer has size.x × size.y pixels
//     ├─────┼─────┼─────┤    u_tiles of them per row
//     │ z=0 │ z=1 │     │
//     └─────┴─────┴─────┘
uniform ivec3 u_size;        // voxels
uniform int u_tiles;         // per row
uniform vec3 u_first;        // object space: the centre of voxel (0, 0, 0)
uniform float u_voxel;       // its side, object units

// Returns the voxel of this fragment; z >= u_size.z if there is none.
ivec3 voxelHere() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 tile = at / u_size.xy;
    return ivec3(at - tile * u_size.xy, tile.y * u_tiles + tile.x);
}

vec3 voxelCenter(ivec3 voxel) {
    return u_first + u_voxel * vec3(voxel);
}
