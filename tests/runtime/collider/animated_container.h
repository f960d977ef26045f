// A container of an animated mesh, for the tests of what plays it.
#pragma once

#include "formats/collider.h"
#include "runtime/collider/animated_collider.h"

namespace relief {

/// Its maps at rest are empty: what plays draws its own.
inline Collider animatedContainer(const AnimatedMesh& mesh) {
    Collider collider = *animatedFrames(poseExtent(mesh).room, 16);
    for (DepthMap& map : collider.maps) {
        map.texels.resize(map.texelBytes());
    }
    collider.animation = writeAnimatedMesh(mesh);
    return collider;
}

}  // namespace relief
