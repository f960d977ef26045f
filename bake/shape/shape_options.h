// SPDX-License-Identifier: Apache-2.0
// Defines how the parts of a mesh are interpreted (--as), and the thickness of shells (--thickness).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bake/mesh/mesh.h"
#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/fields/field.h"

namespace relief {

/// The interpretation of a part.
enum class ShapeAs : std::uint8_t { kAuto, kSolid, kShell, kTerrain };
template <>
inline constexpr std::array<std::string_view, 4> kWordsOf<ShapeAs>{"auto", "solid", "shell", "terrain"};

/// The treatment of free space that sheets and solids seal together (sealed_voids.h).
enum class VoidMode : std::uint8_t { kFill, kKeep };
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<VoidMode>{"fill", "keep"};

/// The thickness of shells: "0.01", or "auto=0.01" for a default that each sheet adapts to its size.
struct Thickness {
    double length = 0.0;  ///< object units, above 0
    bool by_part = false;
};
[[nodiscard]] bool parseText(std::string_view word, Thickness& thickness);
[[nodiscard]] std::string fieldText(const Thickness& thickness);

/// The interpretation of triangles with a name, identified by TriangleMesh::marks.
struct NamedShape {
    std::string name;  ///< clean UTF-8, 1 to kSelectedNameBytesMax bytes
    ShapeAs as = ShapeAs::kAuto;

    friend bool operator==(const NamedShape&, const NamedShape&) = default;
};

struct ShapeOptions {
    /// kSolid: every part is a solid, with or without holes. kShell: every part is a sheet. kTerrain: every open part
    /// is a height field, along the axis that kAuto finds for a terrain, otherwise along the axis of its largest
    /// projection.
    ShapeAs as = ShapeAs::kAuto;
    double thickness = 0.0;  ///< of shells, object units, above 0; see defaultThickness()
    /// Overrides `as`. Names are unique, at most kSelectedNamesMax. If a triangle has several, the last one applies.
    std::vector<NamedShape> named = {};
    /// `thickness` is a default that each sheet adapts to its size (partThickness).
    bool thickness_by_part = false;
    /// The default is derived from --texel; partThickness() then has a lower minimum.
    bool thickness_by_texel = false;
    VoidMode voids = VoidMode::kFill;

    [[nodiscard]] std::vector<std::string> names() const;  ///< of `named`, in order
};

/// Parses the values of --as: KIND at most once, and NAME=KIND, split at the last "=". Errors: kUsage, kLimit.
[[nodiscard]] Result<ShapeOptions> parseShapeOptions(const std::vector<std::string>& words);

/// Maximum --thickness, in units of the mesh's longest side.
inline constexpr double kThicknessMax = 0.5;

/// Returns 1.5 times the texel length of a bake of this box, because a thinner wall may not fill a texel; at most 4 %
/// of the box's longest side.
/// \param budget_bytes  for all texels.
[[nodiscard]] double defaultThickness(const Bounds& bounds, std::uint64_t budget_bytes);
/// Like defaultThickness(), for a given texel.
[[nodiscard]] double thicknessOfTexel(const Bounds& bounds, double texel);
/// Clamps a default to between 0.4 % and 25 % of a part's longest side. With `by_texel`, the lower limit is 0.01 %.
[[nodiscard]] double partThickness(double default_thickness, double part_size, bool by_texel = false);
/// Returns SurfacePart::target_thickness for a default thickness: at most a tenth of the part's longest side.
[[nodiscard]] double targetThickness(double thickness, double part_size);

/// Checks the thickness. Errors: kUsage, if shells would be thinner than 1e-4 of the smallest sheet's longest side, or
/// too thin for floats to resolve.
[[nodiscard]] Result<void> checkShellThickness(double thickness, double smallest_sheet,
                                               const TriangleMesh& mesh);

}  // namespace relief
