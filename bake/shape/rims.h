// SPDX-License-Identifier: Apache-2.0
// The two open shells of a double-walled vessel, joined at their rims.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "bake/mesh/mesh.h"

namespace relief {

/// A border of an open shell, in the direction of a cap's triangles.
struct Rim {
    std::vector<std::uint32_t> vertices;
    std::vector<glm::dvec3> places;  ///< of the vertices
};

struct OpenShell {
    TriangleMesh mesh;
    std::vector<Rim> rims;
};

/// \param mesh  after finishMesh.
[[nodiscard]] OpenShell openShellOf(TriangleMesh mesh);

/// The wall between two shells: both, with a ring between each pair of rims that face each other; before finishMesh. nullopt: a
/// rim of the inner shell faces none of the outer one, or the shells do not lie one within the other.
[[nodiscard]] std::optional<TriangleMesh> wallBetween(const OpenShell& outer, const OpenShell& inner);

}  // namespace relief
