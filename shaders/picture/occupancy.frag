// SPDX-License-Identifier: Apache-2.0
// Writes the fraction of a voxel that the collider occupies: 1 if its centre is inside, decreasing to 0 at a distance
// of one voxel. A sheet between two centres thus gives at least ½, however thin it is.
//!include collider/collider.glsl
//!include picture/volume.glsl

layout(location = 0) out float o_occupied;

void main() {
    ReliefField field = reliefEvaluate(voxelCenter(voxelHere()));
    o_occupied = field.map < 0 ? 0.0 : clamp(1.0 - field.distance / u_voxel, 0.0, 1.0);
}
