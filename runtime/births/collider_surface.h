// SPDX-License-Identifier: Apache-2.0
// Extracts a triangle surface from a collider's field, for emitters and other users.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string_view>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

struct ColliderSurface {
    std::vector<glm::vec3> positions;   ///< object units
    std::vector<glm::uvec3> triangles;  ///< counter-clockwise seen from outside
};

inline constexpr std::uint32_t kSurfaceCells = 96;
inline constexpr std::uint32_t kSurfaceCellsMax = 512;

/// Extracts the boundary between inside and outside (evaluate()) within the collider's bounds by dual contouring (Ju et
/// al. 2002). Each grid cell on the boundary gets a vertex that best fits the planes in the cell. Edges and corners
/// thus stay sharp, and a curve of radius r is off by cell² / (8 r). Parts thinner than a cell are lost if they contain
/// no corner of the grid. Costs cells³ evaluations of all maps.
/// \param cells  along the longest side of the bounds, 2 … kSurfaceCellsMax.
/// Errors: kUsage (cells), kInvalidInput (empty bounds, or no surface in them).
[[nodiscard]] Result<ColliderSurface> colliderSurface(const Collider& collider,
                                                      std::uint32_t cells = kSurfaceCells);

/// Returns the triangles for which materialAt() returns this material at their centre.
/// Errors: kInvalidInput (no material with this name).
[[nodiscard]] Result<std::vector<glm::uvec3>> materialTriangles(const ColliderSurface& surface,
                                                                const Materials& materials,
                                                                std::string_view name);

}  // namespace relief
