// SPDX-License-Identifier: Apache-2.0
// Classifies the parts of a mesh and builds the solid that is baked. A part is connected by edges (equal positions
// count as one vertex) and has one ShapeAs:
//
//   solid             closed
//   solid with holes  open, but cut off at the bottom, or few rays escape from behind its surface: holes are closed
//   sheet             visible from outside on both sides: becomes a shell (sheet.h)
//   terrain           a height field that covers its rectangle: becomes the ground below it
//
// Coincident triangles count once. The inside is the union of all parts: solids may overlap, shells may cross a solid,
// and a sheet within a solid has no effect.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/mesh/prepared_mesh.h"
#include "bake/mesh/surface_parts.h"
#include "bake/shape/shape_options.h"
#include "formats/base/result.h"

namespace relief {

struct NamedTriangles {
    NamedShape shape;
    std::uint64_t triangles = 0;  ///< triangles of the name, except those that a later name overrides
};

void fields(FieldVisitor& visit, const NamedTriangles& named);

struct ShapeReport {
    ShapeAs as = ShapeAs::kAuto;
    std::vector<NamedTriangles> named;  ///< in the order of the options
    std::uint64_t solids = 0;
    std::uint64_t solids_with_holes = 0;
    std::uint64_t sheets = 0;
    std::uint64_t closable_sheets = 0;  ///< large sheets that would be solids if their holes were closed
    /// Open parts inside another open part, with rims too far apart to join the parts; the inside is filled.
    std::uint64_t unjoined_shells = 0;
    /// Walls of two joined shells that may be a character in clothes: isAmbiguous() in walls.h.
    std::uint64_t ambiguous_walls = 0;
    std::uint64_t terrains = 0;
    std::uint64_t voids = 0;  ///< sealed by sheets, and filled
    /// Dropped from sheets, and from solids that are closed without them.
    std::uint64_t coincident_triangles = 0;
    /// Closed parts dropped in favour of a larger part (parts.h).
    std::uint64_t near_copies = 0;
    double thickness = 0.0;          ///< of the thickest shell, object units; 0: no shells
    double thickness_min = 0.0;      ///< of the thinnest shell
    double default_thickness = 0.0;  ///< each sheet adapts it; 0: --thickness given, or no shells

    /// "2 solids, 1 sheet"; empty if no shapes were made.
    [[nodiscard]] std::string text() const;
};

void fields(FieldVisitor& visit, const ShapeReport& report);

/// Returns the values of --as that reproduce the solid.
[[nodiscard]] std::vector<std::string> asOptionWords(const ShapeReport& report);
/// Returns the value of --thickness that reproduces the solid; nullopt without shells.
[[nodiscard]] std::optional<Thickness> thicknessOf(const ShapeReport& report);

struct ShapedMesh {
    PreparedMesh mesh;  ///< the source itself if it is already a solid
    ShapeReport report;
    SurfaceParts parts;
};

/// Builds the solid. The result does not depend on the number of threads.
/// \param mesh  after windOutwards. Its `marks` refer to options.named; if they are empty, no triangle is named.
/// Errors: those of MeshQuery::build and checkShellThickness; kLimit (kTriangleMax).
[[nodiscard]] Result<ShapedMesh> shapeMesh(const PreparedMesh& mesh, const ShapeOptions& options);

/// Returns the parts of a mesh that is baked unchanged.
[[nodiscard]] SurfaceParts surfacePartsOf(const PreparedMesh& mesh);

}  // namespace relief
