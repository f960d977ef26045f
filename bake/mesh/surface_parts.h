// The parts that a mesh consists of: pieces that hang together and are of one node and one material. Each can be judged by
// itself and by its own size, however little of the mesh it is.
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
    Bounds bounds;                 ///< of its triangles as they came, object units
    double area = 0.0;             ///< of the same
    std::uint64_t triangles = 0;   ///< of the same
    double thickness = 0.0;        ///< of the shell that stands for a sheet, object units; else 0
    /// Of that thickness, what is right: all that was asked for; of a default, a tenth of the part's longest side.
    double right_thickness = 0.0;

    [[nodiscard]] double size() const { return static_cast<double>(bounds.longestSide()); }
};

struct SurfaceParts {
    std::vector<SurfacePart> parts;  ///< in the order of their first triangles
    /// For each triangle of the solid that is baked the part that it stands for; kNoLabel for caps over holes.
    std::vector<std::uint32_t> part_of;
};

/// Collects the parts of a mesh from its triangles.
class SurfacePartsBuilder {
  public:
    /// \param mesh  borrowed.
    explicit SurfacePartsBuilder(const TriangleMesh& mesh);
    /// Triangles that hang together; those of another label are another part.
    void add(const std::vector<std::uint32_t>& triangles, PartKind kind);
    /// For each triangle of the mesh; kNoLabel where none was added.
    [[nodiscard]] const std::vector<std::uint32_t>& partOf() const { return part_of_; }
    [[nodiscard]] std::vector<SurfacePart>& parts() { return parts_; }

  private:
    const TriangleMesh& mesh_;
    std::vector<SurfacePart> parts_;
    std::vector<std::uint32_t> part_of_;
};

/// Parts that lie so far from the others that the box of all is mostly empty: a vertex gone astray, a forgotten helper.
struct Strays {
    std::vector<std::uint32_t> parts;  ///< indices, ascending; empty: there are none
    Bounds rest;                       ///< of all others
};
/// A part is a stray if all such parts together hold at most a hundredth of the area, and without them the box's longest
/// side is at most a tenth.
[[nodiscard]] Strays straysOf(const std::vector<SurfacePart>& parts);

}  // namespace relief
