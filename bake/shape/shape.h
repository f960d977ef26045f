// What a mesh is, part by part, and the solid that stands for it. A part hangs together by edges, where equal positions
// are one vertex:
//
//   solid             closed: its inside is what it encloses
//   solid with holes  open, but hardly any ray leads out from behind its surface: the holes are closed
//   sheet             both sides are seen from outside: it becomes a shell of a given thickness (sheet.h)
//   terrain           a height field that covers its rectangle: it becomes the ground below it
//
// Triangles that are taken for different things do not hang together, whatever edges they share.
//
// Coincident triangles count once. What a point is inside of is the union of all parts: solids that overlap, shells that
// cross a solid, and a sheet within a solid, which is never met.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bake/mesh/prepared_mesh.h"
#include "bake/mesh/surface_parts.h"
#include "bake/shape/shape_options.h"
#include "bake/shape/thickness.h"
#include "formats/base/result.h"

namespace relief {

/// What a name was taken for.
struct NamedTriangles {
    NamedShape shape;
    std::uint64_t triangles = 0;  ///< of the mesh, that no later name has too
};

struct ShapeReport {
    ShapeAs as = ShapeAs::kAuto;
    std::vector<NamedTriangles> named;  ///< in the order of the options
    std::uint64_t solids = 0;
    std::uint64_t solids_with_holes = 0;
    std::uint64_t sheets = 0;
    std::uint64_t terrains = 0;
    std::uint64_t coincident_triangles = 0;  ///< left out of sheets, and of solids closed without them
    std::uint64_t near_copies = 0;   ///< closed parts that are left out for a larger one (near_copies.h)
    double thickness = 0.0;          ///< of the thickest shell, object units; 0: there are none
    double thickness_least = 0.0;    ///< of the thinnest
    double default_thickness = 0.0;  ///< from which each part's is derived; 0: it was asked for

    /// "2 solids, 1 sheet"
    [[nodiscard]] std::string text() const;
};

/// " --as shell --as glass=auto --thickness 0.01", or less: for the options that a container records.
[[nodiscard]] std::string shapeOptionsText(const ShapeReport& report);

struct ShapedMesh {
    PreparedMesh mesh;  ///< the mesh that came if it is solid already
    ShapeReport report;
    SurfaceParts parts;
};

/// \param mesh  as windOutwards leaves it. Its marks count options.named; without marks, nothing is named.
/// The same for any number of threads.
/// Errors: those of MeshQuery::build and checkShellThickness; kLimit (kTriangleMax).
[[nodiscard]] Result<ShapedMesh> shapeMesh(const PreparedMesh& mesh, const ShapeOptions& options);

/// The parts of a mesh that is baked as it is.
[[nodiscard]] SurfaceParts surfacePartsOf(const PreparedMesh& mesh);

}  // namespace relief
