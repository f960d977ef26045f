// SPDX-License-Identifier: Apache-2.0
// Collects the parts of a mesh: connected pieces of one node and one material, each judged at its own scale.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bake/mesh/mesh.h"
#include "formats/collider.h"
#include "formats/fields/field.h"

namespace relief {

/// kSurface: baked unchanged; ray parity decides what is inside.
enum class PartKind : std::uint8_t { kSolid, kSolidWithHoles, kSheet, kTerrain, kSurface };
template <>
inline constexpr std::array<std::string_view, 5> kWordsOf<PartKind>{"solid", "solid_with_holes", "sheet",
                                                                    "terrain", "surface"};

struct SurfacePart {
    PartKind kind = PartKind::kSurface;
    std::uint32_t node_index = 0;  ///< as in SurfaceName
    std::string node;              ///< "" if unnamed
    std::string material;          ///< "" if unnamed
    Bounds bounds;                 ///< of its triangles in the source, object units
    double area = 0.0;             ///< of its triangles in the source
    std::uint64_t triangles = 0;   ///< number in the source
    double thickness = 0.0;        ///< of the shell that represents a sheet, object units; else 0
    /// The thickness that the shell should have: `thickness` if it was requested; for a default thickness, at most a
    /// tenth of the part's longest side.
    double target_thickness = 0.0;

    [[nodiscard]] double size() const { return static_cast<double>(bounds.longestSide()); }
};

struct SurfaceParts {
    std::vector<SurfacePart> parts;  ///< ordered by first triangle
    /// Per triangle of the baked solid, its part; kNoLabel for caps over holes.
    std::vector<std::uint32_t> part_of;

    /// Adds a connected piece of a mesh. Its triangles with the same value in TriangleMesh::labels become one
    /// part.
    void add(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles, PartKind kind);
};

/// Parts so far from the others that the common box is mostly empty: a stray vertex, a forgotten helper object.
struct OutlierParts {
    std::vector<std::uint32_t> parts;  ///< ascending
    Bounds rest;                       ///< of all other parts
};
/// Finds outlier parts. Together they have at most 1 % of the area, and without them the box's longest side shrinks to
/// at most a tenth.
[[nodiscard]] OutlierParts findOutlierParts(const std::vector<SurfacePart>& parts);

}  // namespace relief
