// SPDX-License-Identifier: Apache-2.0
// The surface of a collider as triangles, found from its field alone: for what needs the surface and not the field, as emitters do.
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
    std::vector<glm::uvec3> triangles;  ///< anticlockwise seen from outside
};

inline constexpr std::uint32_t kSurfaceCells = 96;
inline constexpr std::uint32_t kSurfaceCellsMax = 512;

/// The boundary between inside and outside, evaluate(), within the collider's bounds, by dual contouring (Ju et al. 2002): a vertex in each
/// cell of a grid that it passes through, where the planes that it has there meet best. So edges and corners stay sharp,
/// and a curve of radius r is off by cell² / 8 r. Parts thinner than a cell, which none of its corners lies in, are left out. Takes the time of
/// cells³ evaluations. Every map counts once, as the votes have it.
/// \param cells  along the longest side of the bounds, 2 … kSurfaceCellsMax.
/// Errors: kUsage (cells), kInvalidInput (bounds without extent, no surface in them).
[[nodiscard]] Result<ColliderSurface> colliderSurface(const Collider& collider,
                                                      std::uint32_t cells = kSurfaceCells);

/// The triangles of a material, which materialAt() has at the middle of each.
/// Errors: kInvalidInput (no material of this name).
[[nodiscard]] Result<std::vector<glm::uvec3>> materialTriangles(const ColliderSurface& surface,
                                                                const Materials& materials,
                                                                std::string_view name);

}  // namespace relief
