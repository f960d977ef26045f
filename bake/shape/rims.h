// SPDX-License-Identifier: Apache-2.0
// Joins the two open shells of a double-walled vessel at their rims.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "bake/mesh/mesh.h"

namespace relief {

struct OpenShell {
    TriangleMesh mesh;      ///< after finishMesh
    bool is_solid = false;  ///< may be a solid with holes; true for at least one shell of a wall
};

/// Two shells, joined by a ring between each pair of facing rims.
struct ShellWall {
    std::size_t outer = 0;  ///< index of the shell
    std::size_t inner = 0;
    bool alike = false;  ///< both have the same winding: towards the outside, or towards the enclosed space
    TriangleMesh mesh;   ///< before finishMesh; may still have small holes
};

struct ShellWalls {
    std::vector<ShellWall> walls;
    /// Pairs of outer and inner shells with nearly facing mouths, one per inner shell that is in no wall. Either may be
    /// a solid.
    std::vector<std::array<std::size_t, 2>> unjoined;
};

/// Joins each outer shell to an inner one. Holes of the inner shell that face no hole of the outer shell must be small.
/// A shell belongs to at most one wall.
[[nodiscard]] ShellWalls joinRims(const std::vector<OpenShell>& shells);

}  // namespace relief
