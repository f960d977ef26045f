// SPDX-License-Identifier: Apache-2.0
// Animated meshes with poses in closed form.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "formats/animation/animated_mesh.h"

namespace relief {

/// A tube of radius 0.1 along +y from 0 to 2, its ends closed, with a joint at its foot and another at half its height. Weights
/// go over within a third of its length. The clip "bend" turns the upper joint by 90° about z and back within 2 s, by linear
/// keys; "grow" lets one morph target, which doubles the radius, come in 1 s.
[[nodiscard]] AnimatedMesh bendingTube(int around = 32, int rings = 40);

/// A box of half sides `half`, one node, which the clip "go" moves along +x by 1 within 1 s, and the clip "turn" turns about y
/// by 90° within 1 s.
[[nodiscard]] AnimatedMesh movingBox(const glm::vec3& half);

/// How often a closed surface winds around a point, by the solid angles of its triangles: ½ and more is inside.
[[nodiscard]] double windingNumber(std::span<const glm::vec3> positions,
                                   std::span<const glm::uvec3> triangles, const glm::dvec3& p);

/// Points on the surface by its area, moved by a Gaussian of a two hundredth of `size`.
[[nodiscard]] std::vector<glm::vec3> pointsNear(std::span<const glm::vec3> positions,
                                                std::span<const glm::uvec3> triangles, std::size_t count,
                                                float size, std::uint32_t seed);

}  // namespace relief
