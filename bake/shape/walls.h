// SPDX-License-Identifier: Apache-2.0
// Finds pairs of open parts that are the two shells of a wall.
#pragma once

#include <string>
#include <vector>

#include "bake/shape/rims.h"
#include "bake/shape/sheet.h"

namespace relief {

/// An open part of a mesh.
struct WallCandidate {
    const Sheet* sheet = nullptr;
    bool may_join = false;      ///< it may be a shell of a wall
    bool may_be_solid = false;  ///< OpenShell::is_solid
};

/// Joins the rims of candidates of similar size whose bounds contain each other's centre. Tests only pairs that overlap
/// along x, because a file may have thousands of open parts.
/// \param name  of the mesh.
/// \return shells as indices of candidates.
[[nodiscard]] ShellWalls wallsAmong(const std::vector<WallCandidate>& candidates, const std::string& name);

/// Whether the two shells of a wall have the same winding in the file, or one of them has an inconsistent winding.
/// \param mesh    the mesh of the candidates.
/// \param turned  per triangle of it: flipped relative to the file.
[[nodiscard]] bool isAmbiguous(const ShellWall& wall, const std::vector<WallCandidate>& candidates,
                               const TriangleMesh& mesh, const std::vector<bool>& turned);

}  // namespace relief
