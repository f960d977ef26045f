// SPDX-License-Identifier: Apache-2.0
// Stores the imported surface of a mesh, with a material for each triangle.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "bake/mesh/mesh.h"
#include "formats/base/result.h"
#include "formats/materials.h"

namespace relief {

/// The surface that carries the materials. Large; avoid copies.
struct MaterialSource {
    std::vector<glm::vec3> positions;   ///< object space
    std::vector<glm::uvec3> triangles;  ///< counter-clockwise seen from outside
    std::vector<std::uint8_t> ids;      ///< per triangle, an index into `list`
    std::vector<Material> list;         ///< in file order
    /// True for a bake with closed holes and no repair, sheets or terrains. The normal then distinguishes the
    /// materials on the two sides of a thin wall; a sheet has one material on both sides.
    bool sides = true;

    [[nodiscard]] bool empty() const { return list.empty(); }
};

/// Returns the materials of an imported mesh, merged by name; none if all have the same name.
/// \param mesh    its triangles are still those of the source (TriangleMesh::labels).
/// \param single  keeps a single material, too, if it has a name.
/// Errors, naming the mesh: kLimit (more than kMaterialsMax), kInvalidInput (one name, two restitutions or frictions).
[[nodiscard]] Result<MaterialSource> materialSource(const TriangleMesh& mesh, bool single);

}  // namespace relief
