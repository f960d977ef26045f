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

template <class Visitor, FieldsOf<NamedTriangles> N>
void fields(Visitor& visit, N& named) {
    visit("name", named.shape.name,
          {.help = "Name of a node, mesh, group or material of the file", .pattern = "."});
    visit("as", named.shape.as, {"How its triangles are treated"});
    visit("triangles", named.triangles, {"Triangles with this name and no later one"});
}

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

    /// "2 solids, 1 sheet"; empty where no shapes were made
    [[nodiscard]] std::string text() const;
};

template <class Visitor, FieldsOf<ShapeReport> R>
void fields(Visitor& visit, R& report) {
    const auto length = [](double value) { return onlyIf(value > 0.0, static_cast<float>(value)); };
    constexpr FieldRange kAboveZero{.low = 0.0, .low_included = false};
    visit("as", report.as, {"KIND of --as, for triangles without a named one"});
    visit("named", report.named, {"Each --as NAME=KIND, in the order of the options"});
    visit("solids", report.solids, {"Closed parts"});
    visit("solids_with_holes", report.solids_with_holes,
          {"Open parts whose inside is mostly hidden; their holes are closed"});
    visit("sheets", report.sheets, {"Parts that are visible from both sides; they become shells"});
    visit("terrains", report.terrains, {"Height fields; they become the ground below them"});
    visit("coincident_triangles", report.coincident_triangles,
          {"Triangles left out because they coincide with another one"});
    visit("near_copies", report.near_copies,
          {"Closed parts left out because they lie within a ten-thousandth of their longest side of a larger "
           "one"});
    visit("thickness", length(report.thickness),
          {"Thickness of the thickest shell; null without shells", "object units", kAboveZero});
    visit("thickness_least", length(report.thickness_least),
          {"Thickness of the thinnest shell; null without shells", "object units", kAboveZero});
    visit("thickness_asked", report.thickness > 0.0 && report.default_thickness == 0.0,
          {"--thickness was given; otherwise each shell suits the size of its part"});
}

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
