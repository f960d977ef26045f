// SPDX-License-Identifier: Apache-2.0
// The share of a voxel that the collider takes: 1 where its middle is inside, and from there down to 0 at a distance of one
// voxel. So a sheet between two middles, however thin, is at least ½.
//!include collider/collider.glsl
//!include picture/volume.glsl

layout(location = 0) out float o_occupied;

void main() {
    ReliefField field = reliefEvaluate(voxelCenter(voxelHere()));
    o_occupied = field.map < 0 ? 0.0 : clamp(1.0 - field.distance / u_voxel, 0.0, 1.0);
}
