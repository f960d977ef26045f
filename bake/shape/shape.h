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
    std::uint64_t closable_sheets = 0;  ///< large ones that closed holes would make solids
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
    visit("closable_sheets", report.closable_sheets,
          {"Sheets of at least a quarter of the mesh's longest side that would be solids with closed holes: "
           "vessels, or bodies for --as solid"});
    visit("terrains", report.terrains, {"Height fields; they become the ground below them"});
    visit("voids", report.voids,
          {"Voids that sheets and solids seal together; they are full, but with --voids hollow"});
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
