// SPDX-License-Identifier: Apache-2.0
// The two open shells of a double-walled vessel, joined at their rims.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "bake/mesh/mesh.h"

namespace relief {

struct OpenShell {
    TriangleMesh mesh;      ///< after finishMesh
    bool is_solid = false;  ///< it may be a solid with holes; one shell of a wall at least is one
};

/// Two shells, with a ring between each pair of rims that face each other.
struct ShellWall {
    std::size_t outer = 0;  ///< index of the shell
    std::size_t inner = 0;
    bool alike = false;  ///< both were wound alike: to the outside, or into the space within
    TriangleMesh mesh;   ///< before finishMesh; small holes may be left
};

struct ShellWalls {
    std::vector<ShellWall> walls;
    /// Outer and inner shells with nearly facing mouths, by the inner one: it is in no wall, and either may be a solid.
    std::vector<std::array<std::size_t, 2>> unjoined;
};

/// Joins each outer shell to an inner one. The holes of the inner one that face no hole of the outer one have to be
/// small. Each shell is part of one wall at most.
[[nodiscard]] ShellWalls joinRims(const std::vector<OpenShell>& shells);

}  // namespace relief
