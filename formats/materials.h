// SPDX-License-Identifier: Apache-2.0
// The materials of a collider: names, responses, and an octree of which surface is of which. README.md beside this file,
// "Materials", in words; shaders/bodies/materials.glsl is materialAt() on the GPU.
//
// The tree is over a cube that holds the collider, not over texels, so that maps of every format share it. A cell is split
// only where surfaces of different materials are near, and a cell without surface has the material of the nearest:
// contacts lie a little off the surface.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace relief {

inline constexpr std::size_t kMaterialsMax = 255;      ///< of a collider
inline constexpr std::size_t kMaterialNameMax = 256;   ///< bytes
inline constexpr std::size_t kMaterialSidesMax = 255;  ///< with the materials at most 256
inline constexpr std::size_t kMaterialNodesMax = std::size_t{1} << 20;
inline constexpr int kMaterialLevelsMax = 20;  ///< nodes from the root to a leaf at most
/// Seconds of life that a step in contact may cost.
inline constexpr float kMaterialLossMax = 1e6F;

struct Material {
    std::string name;            ///< "" of surfaces without one; no two materials of a collider share it
    float restitution = 1.0F;    ///< factor of the particle's and the body's, 0…1
    float friction = 0.0F;       ///< 0…1: 1 − friction is a factor of the particle's 1 − friction
    float lifetime_loss = 0.0F;  ///< seconds of life that each step in contact costs, 0…kMaterialLossMax
    float area_share = 0.0F;     ///< of the mesh's surface, 0…1

    friend bool operator==(const Material&, const Material&) = default;
};

inline constexpr int kMaterialAxes = 9;

/// Two materials in one cell, which the normals of their surfaces tell apart: both sides of a board, or of an edge.
struct MaterialSides {
    std::uint8_t axis = 0;     ///< 0…8: x, y, z, x + y, x − y, x + z, x − z, y + z, y − z
    std::uint8_t towards = 0;  ///< material where the normal's component along the axis is ≥ 0
    std::uint8_t against = 0;  ///< where it is below 0

    friend bool operator==(const MaterialSides&, const MaterialSides&) = default;
};

/// A cell of eight octants, x lowest: octant = x + 2y + 4z.
struct MaterialNode {
    /// Bits 0–7: octants that are nodes. Bits 8–31: the node of the first of them; the others follow in order.
    std::uint32_t head = 0;
    /// Of an octant that is no node: a material, or from the number of materials on one of the sides. 0 of a node.
    std::array<std::uint8_t, 8> leaves{};

    friend bool operator==(const MaterialNode&, const MaterialNode&) = default;
};
static_assert(sizeof(MaterialNode) == 12);

struct Materials {
    std::vector<Material> list;  ///< empty: the collider has none, and all below is empty
    std::vector<MaterialSides> sides;
    glm::vec3 origin{0.0F};           ///< the lowest corner of the cube, object space
    float size = 0.0F;                ///< its side, object units
    std::vector<MaterialNode> nodes;  ///< level by level, the root first; empty: all is of material 0

    [[nodiscard]] bool empty() const { return list.empty(); }
    /// Of nodes, sides and names.
    [[nodiscard]] std::size_t bytes() const;
    friend bool operator==(const Materials&, const Materials&) = default;
};

/// The component of a vector along the axis of two sides; along those of two coordinates √2 times that.
template <class Vector>
[[nodiscard]] auto alongMaterialAxis(const Vector& v, int axis) {
    const int first = axis < 3 ? axis : axis < 7 ? 0 : 1;
    const int second = axis < 5 ? 1 : 2;
    const auto other = axis % 2 == 1 ? v[second] : -v[second];
    return axis < 3 ? v[first] : v[first] + other;
}

/// The first invariant above that does not hold, in one line; "": all do.
[[nodiscard]] std::string faultOfMaterials(const Materials& materials);

/// The material of a contact: an index into `list`, 0 without any.
/// \param p       object space; beyond the cube the nearest of its cells counts.
/// \param normal  of the surface, object space, of any length.
[[nodiscard]] std::size_t materialAt(const Materials& materials, const glm::vec3& p, const glm::vec3& normal);

}  // namespace relief
