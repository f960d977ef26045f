// SPDX-License-Identifier: Apache-2.0
// The materials of a collider: names, responses, and an octree that assigns a material to each point. Described in
// README.md in this folder, "Materials"; shaders/bodies/materials.glsl implements materialAt() on the GPU.
//
// The tree covers a cube around the collider. It does not depend on the maps, so all map formats share it. A cell is
// split only if surfaces of different materials are near it. A cell without a surface gets the nearest surface's
// material because contacts lie slightly off the surface.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace relief {

inline constexpr std::size_t kMaterialsMax = 255;      ///< per collider
inline constexpr std::size_t kMaterialNameMax = 256;   ///< bytes
inline constexpr std::size_t kMaterialSidesMax = 255;  ///< at most 256 together with the materials
inline constexpr std::size_t kMaterialNodesMax = std::size_t{1} << 20;
inline constexpr int kMaterialLevelsMax = 20;  ///< maximum nodes on a path from root to leaf
/// Maximum lifetime loss of a step in contact, in seconds.
inline constexpr float kMaterialLossMax = 1e6F;

struct Material {
    std::string name;            ///< unique in a collider; "" for surfaces without a material
    float restitution = 1.0F;    ///< 0…1, multiplies the particle's and the body's restitution
    float friction = 0.0F;       ///< 0…1; (1 − friction) multiplies the particle's 1 − friction
    float lifetime_loss = 0.0F;  ///< seconds of life lost in each step in contact, 0…kMaterialLossMax
    float area_fraction = 0.0F;  ///< fraction of the mesh's surface area, 0…1

    friend bool operator==(const Material&, const Material&) = default;
};

inline constexpr int kMaterialAxes = 9;

/// Two materials in one cell, distinguished by the surface normal: the two sides of a board, or of an edge.
struct MaterialSides {
    std::uint8_t axis = 0;     ///< 0…8: x, y, z, x + y, x − y, x + z, x − z, y + z, y − z
    std::uint8_t towards = 0;  ///< material if the normal's component along the axis is ≥ 0
    std::uint8_t against = 0;  ///< material if it is below 0

    friend bool operator==(const MaterialSides&, const MaterialSides&) = default;
};

/// A cell with eight octants: octant = x + 2y + 4z.
struct MaterialNode {
    /// Bits 0–7: mask of octants that are nodes. Bits 8–31: index of the first of these nodes; the others follow in
    /// order.
    std::uint32_t head = 0;
    /// For octants that are leaves: a material index, or the number of materials plus an index into `sides`. 0 for
    /// nodes.
    std::array<std::uint8_t, 8> leaves{};

    friend bool operator==(const MaterialNode&, const MaterialNode&) = default;
};
static_assert(sizeof(MaterialNode) == 12);

struct Materials {
    std::vector<Material> list;  ///< empty: the collider has no materials, and the members below are empty
    std::vector<MaterialSides> sides;
    glm::vec3 origin{0.0F};           ///< lowest corner of the cube, object space
    float size = 0.0F;                ///< side of the cube, object units
    std::vector<MaterialNode> nodes;  ///< level by level, root first; empty: material 0 everywhere

    [[nodiscard]] bool empty() const { return list.empty(); }
    /// Returns the total size of nodes, sides and names.
    [[nodiscard]] std::size_t bytes() const;
    friend bool operator==(const Materials&, const Materials&) = default;
};

/// Returns the component of a vector along a MaterialSides axis; for the diagonal axes, √2 times the component.
template <class Vector>
[[nodiscard]] auto alongMaterialAxis(const Vector& v, int axis) {
    const int first = axis < 3 ? axis : axis < 7 ? 0 : 1;
    const int second = axis < 5 ? 1 : 2;
    const auto other = axis % 2 == 1 ? v[second] : -v[second];
    return axis < 3 ? v[first] : v[first] + other;
}

/// Returns the first violated invariant in one line, or "".
[[nodiscard]] std::string faultOfMaterials(const Materials& materials);

/// Returns the material of a contact: an index into `list`, or 0 without materials.
/// \param p       object space; points outside the cube use its nearest cell.
/// \param normal  surface normal, object space, any length.
[[nodiscard]] std::size_t materialAt(const Materials& materials, const glm::vec3& p, const glm::vec3& normal);

}  // namespace relief
