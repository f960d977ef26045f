// Animated meshes with poses in closed form.
#pragma once

#include "formats/animation/animated_mesh.h"

namespace relief {

/// A tube of radius 0.1 along +y from 0 to 2, its ends closed, with a joint at its foot and another at half its height. Weights
/// go over within a third of its length. The clip "bend" turns the upper joint by 90° about z and back within 2 s, by linear
/// keys; "grow" lets one morph target, which doubles the radius, come in 1 s.
[[nodiscard]] AnimatedMesh bendingTube(int around = 32, int rings = 40);

}  // namespace relief
