// SPDX-License-Identifier: Apache-2.0
// A container of an animated mesh, for tests that play clips.
#pragma once

#include "formats/collider.h"
#include "runtime/live/animated_collider.h"
#include "tests/formats/animation/animated_meshes.h"

namespace relief {

/// A tube whose upper half, by triangles, has another material.
inline AnimatedMesh tubeWithMaterials(const char* lower, const char* upper) {
    AnimatedMesh mesh = bendingTube(12, 8);
    mesh.materials = {lower, upper};
    for (const glm::uvec3& t : mesh.triangles) {
        const float y = mesh.positions[t.x].y + mesh.positions[t.y].y + mesh.positions[t.z].y;
        mesh.triangle_materials.push_back(y > 3.0F ? 1 : 0);
    }
    return mesh;
}

/// Its maps at rest are empty, because animated colliders draw their own.
inline Collider animatedContainer(const AnimatedMesh& mesh) {
    Collider collider = *animatedMaps(poseExtent(mesh).box_size, 16);
    for (DepthMap& map : collider.maps) {
        map.texels.resize(map.texelBytes());
    }
    collider.animation = writeAnimatedMesh(mesh);
    return collider;
}

}  // namespace relief
