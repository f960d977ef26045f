// SPDX-License-Identifier: Apache-2.0
// Finds pairs of open parts that are the two shells of a wall, such as a double-walled vessel, and joins them at their
// rims.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "bake/mesh/mesh.h"
#include "bake/shape/sheet.h"

namespace relief {

/// Two shells, joined by a ring between each pair of facing rims.
struct ShellWall {
    std::size_t outer = 0;  ///< index of the candidate
    std::size_t inner = 0;
    bool alike = false;  ///< both have the same winding: towards the outside, or towards the enclosed space
    TriangleMesh mesh;   ///< before finishMesh; may still have small holes
};

struct ShellWalls {
    std::vector<ShellWall> walls;
    /// Pairs of outer and inner candidates whose largest rims nearly face each other; the inner one is in no wall. At
    /// least one of the two has WallCandidate::may_be_solid.
    std::vector<std::array<std::size_t, 2>> unjoined;
};

struct WallCandidate {
    const Sheet* sheet = nullptr;
    bool may_join = false;      ///< it may be a shell of a wall
    bool may_be_solid = false;  ///< it may be a solid with holes; true for at least one shell of a wall
};

/// Joins the rims of an outer and an inner candidate of similar size if the bounds of one contain the centre of the other.
/// Rims of the inner candidate that face no rim of the outer candidate must be small. A candidate belongs to at most one
/// wall. Tests only pairs that overlap along x, because a file may have thousands of open parts.
/// \param name  of the mesh.
[[nodiscard]] ShellWalls findWalls(const std::vector<WallCandidate>& candidates, const std::string& name);

/// Whether the two shells of a wall have the same winding in the file, or one of them has an inconsistent winding.
/// \param mesh    the mesh of the candidates.
/// \param turned  per triangle of `mesh`: flipped relative to the file.
[[nodiscard]] bool isAmbiguous(const ShellWall& wall, const std::vector<WallCandidate>& candidates,
                               const TriangleMesh& mesh, const std::vector<bool>& turned);

}  // namespace relief
