// SPDX-License-Identifier: Apache-2.0
// Animated meshes whose poses have closed forms.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "formats/animation/animated_mesh.h"

namespace relief {

/// A closed tube of radius 0.1 along +y from 0 to 2, with a joint at its foot and another at half its height. Weights
/// blend over a third of its length. The clip "bend" rotates the upper joint by 90° about z and back within 2 s, with
/// linear keys. "grow" blends in a morph target within 1 s, which doubles the radius.
[[nodiscard]] AnimatedMesh bendingTube(int around = 32, int rings = 40);

/// A box with half sides `half` and one node. The clip "go" moves it by 1 along +x within 1 s. The clip "turn" rotates
/// it by 90° about y within 1 s.
[[nodiscard]] AnimatedMesh movingBox(const glm::vec3& half);

/// Winding number of a closed surface at a point, from the solid angles of its triangles: ½ and above is inside.
[[nodiscard]] double windingNumber(std::span<const glm::vec3> positions,
                                   std::span<const glm::uvec3> triangles, const glm::dvec3& p);

/// Points distributed uniformly over the surface, offset by a Gaussian of `size` / 200.
[[nodiscard]] std::vector<glm::vec3> pointsNear(std::span<const glm::vec3> positions,
                                                std::span<const glm::uvec3> triangles, std::size_t count,
                                                float size, std::uint32_t seed);

}  // namespace relief
