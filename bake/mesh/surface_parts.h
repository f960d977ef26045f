// SPDX-License-Identifier: Apache-2.0
// The parts of a mesh: connected pieces of one node and one material, each judged by itself and its own size.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bake/mesh/mesh.h"
#include "formats/collider.h"
#include "formats/fields/field.h"

namespace relief {

/// kSurface: baked as it is, with the inside left to the parity of rays.
enum class PartKind : std::uint8_t { kSolid, kSolidWithHoles, kSheet, kTerrain, kSurface };
template <>
inline constexpr std::array<std::string_view, 5> kWordsOf<PartKind>{"solid", "solid with holes", "sheet",
                                                                    "terrain", "surface"};

struct SurfacePart {
    PartKind kind = PartKind::kSurface;
    std::uint32_t node_index = 0;  ///< SurfaceName
    std::string node;              ///< "" without a name
    std::string material;          ///< "" without a name
    Bounds bounds;                 ///< of its triangles in the source, object units
    double area = 0.0;             ///< of the same
    std::uint64_t triangles = 0;   ///< the same
    double thickness = 0.0;        ///< of the shell that stands for a sheet, object units; else 0
    double right_thickness =
        0.0;  ///< of it, all that was requested; of a default at most a tenth of the longest side

    [[nodiscard]] double size() const { return static_cast<double>(bounds.longestSide()); }
};

struct SurfaceParts {
    std::vector<SurfacePart> parts;  ///< in the order of their first triangles
    /// Per triangle of the solid that is baked, its part; kNoLabel for caps over holes.
    std::vector<std::uint32_t> part_of;
};

/// Collects the parts of a mesh from its triangles.
class SurfacePartsBuilder {
  public:
    /// \param mesh  borrowed.
    explicit SurfacePartsBuilder(const TriangleMesh& mesh);
    /// Connected triangles; each label among them is a part.
    void add(const std::vector<std::uint32_t>& triangles, PartKind kind);
    /// Per triangle of the mesh; kNoLabel where none was added.
    [[nodiscard]] const std::vector<std::uint32_t>& partOf() const { return part_of_; }
    [[nodiscard]] std::vector<SurfacePart>& parts() { return parts_; }

  private:
    const TriangleMesh& mesh_;
    std::vector<SurfacePart> parts_;
    std::vector<std::uint32_t> part_of_;
};

/// Parts so far from the others that the common box is mostly empty: a stray vertex, a forgotten helper object.
struct OutlierParts {
    std::vector<std::uint32_t> parts;  ///< indices, ascending
    Bounds rest;                       ///< of all others
};
/// All strays together have at most a hundredth of the area, and without them the box's longest side is at most a tenth.
[[nodiscard]] OutlierParts straysOf(const std::vector<SurfacePart>& parts);

}  // namespace relief
