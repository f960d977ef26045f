// SPDX-License-Identifier: Apache-2.0
// Classifies the parts of a mesh and makes the solid that is baked. Parts are connected by edges (equal positions are one
// vertex) between triangles of one kind:
//
//   solid             closed
//   solid with holes  open, but hardly any ray leads out from behind its surface, or cut off below: the holes are closed
//   sheet             both sides are seen from outside: becomes a shell (sheet.h)
//   terrain           a height field that covers its rectangle: becomes the ground below it
//
// Coincident triangles count once. The inside is the union of all parts: solids may overlap, shells may cross a solid, and a
// sheet within a solid has no effect.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/mesh/prepared_mesh.h"
#include "bake/mesh/surface_parts.h"
#include "bake/shape/shape_options.h"
#include "bake/shape/thickness.h"
#include "formats/base/result.h"

namespace relief {

struct NamedTriangles {
    NamedShape shape;
    std::uint64_t triangles = 0;  ///< of the mesh, without those of later names
};

void fields(FieldVisitor& visit, const NamedTriangles& named);

struct ShapeReport {
    ShapeAs as = ShapeAs::kAuto;
    std::vector<NamedTriangles> named;  ///< in the order of the options
    std::uint64_t solids = 0;
    std::uint64_t solids_with_holes = 0;
    std::uint64_t sheets = 0;
    std::uint64_t closable_sheets = 0;  ///< large ones that closed holes would make solids
    std::uint64_t unjoined_shells =
        0;  ///< within another one, with nearly facing mouths, whose inside is full
    std::uint64_t unclear_walls =
        0;  ///< of two joined shells whose winding does not tell a lining from a body
    std::uint64_t terrains = 0;
    std::uint64_t voids = 0;                 ///< sealed by sheets, and full
    std::uint64_t coincident_triangles = 0;  ///< dropped from sheets, and from solids closed without them
    std::uint64_t near_copies = 0;           ///< closed parts dropped for a larger one (near_copies.h)
    double thickness = 0.0;                  ///< of the thickest shell, object units; 0: no shells
    double thickness_least = 0.0;            ///< of the thinnest
    double default_thickness = 0.0;          ///< from which each part's is derived; 0: it was given

    /// "2 solids, 1 sheet"; empty where no shapes were made
    [[nodiscard]] std::string text() const;
};

void fields(FieldVisitor& visit, const ShapeReport& report);

/// The values of --as, and of --thickness where there are shells, that make the same solid again.
[[nodiscard]] std::vector<std::string> asWords(const ShapeReport& report);
[[nodiscard]] std::optional<Thickness> thicknessOf(const ShapeReport& report);

struct ShapedMesh {
    PreparedMesh mesh;  ///< the source if it is solid already
    ShapeReport report;
    SurfaceParts parts;
};

/// \param mesh  after windOutwards. Its marks refer to options.named; without marks, nothing is named.
/// The same for any number of threads.
/// Errors: those of MeshQuery::build and checkShellThickness; kLimit (kTriangleMax).
[[nodiscard]] Result<ShapedMesh> shapeMesh(const PreparedMesh& mesh, const ShapeOptions& options);

/// The parts of a mesh that is baked unchanged.
[[nodiscard]] SurfaceParts surfacePartsOf(const PreparedMesh& mesh);

}  // namespace relief
