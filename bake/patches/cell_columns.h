// The inside of a mesh in one cell of a grid, on lines along the axis of a patch.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "bake/mesh/mesh_query.h"
#include "formats/patch_tree.h"

namespace relief {

/// A cube in object space, and the part of the surface in it.
struct MeshCell {
    glm::dvec3 low{0.0};
    double size = 0.0;
    std::vector<std::uint32_t> triangles;  ///< those that meet the cube, in order
    /// A point of the unit cube, beside its middle, and the bodies that it is in.
    glm::dvec3 known{0.5137, 0.4919, 0.5113};
    BodyCounter bodies;

    [[nodiscard]] glm::dvec3 middle() const { return low + 0.5 * size; }
    /// The corners of a triangle, in the unit cube.
    [[nodiscard]] std::array<glm::dvec3, 3> inUnit(const TriangleMesh& mesh, std::uint32_t triangle) const {
        std::array<glm::dvec3, 3> unit;
        const auto corners = cornersOf(mesh, triangle);
        for (std::size_t i = 0; i < 3; ++i) {
            unit[i] = (glm::dvec3(corners[i]) - low) / size;
        }
        return unit;
    }
};

/// The area of a triangle within the unit cube, and where it lies.
struct ClippedTriangle {
    double area = 0.0;
    glm::dvec3 center{0.0};
    glm::dvec3 normal{0.0};  ///< of unit length, by the winding
};
/// \param corners  in the cell's unit cube.
[[nodiscard]] ClippedTriangle clipToUnitCube(const std::array<glm::dvec3, 3>& corners);

/// \param corners  of a triangle, in the cell's unit cube.
[[nodiscard]] bool meetsUnitCube(const std::array<glm::dvec3, 3>& corners);

/// One eighth of a cell, x fastest.
[[nodiscard]] MeshCell childOf(const MeshQuery& query, const MeshCell& cell, unsigned octant);

/// One line of a cell, from where it enters the cube to where it leaves it; w of PatchFrame.
struct CellColumn {
    double u = 0.0;
    double v = 0.0;
    double enters = 0.0;
    double leaves = 0.0;
    bool inside = false;            ///< where it enters
    std::span<const double> turns;  ///< where it goes from outside to inside or back, in order

    /// The length on which "inside where w < height" is wrong, or with outside_below "w ≥ height".
    [[nodiscard]] double wrongAt(double height, bool outside_below) const;
    /// The length that is inside.
    [[nodiscard]] double insideLength() const;
};

/// All lines of a cell along one frame.
class CellColumns {
  public:
    /// \param across  lines along each side of the square that u and v span; those that miss the cube are left out.
    CellColumns(const MeshQuery& query, const MeshCell& cell, const PatchFrame& frame, unsigned across);

    [[nodiscard]] const std::vector<CellColumn>& columns() const { return columns_; }
    /// The volume of a column for a unit of its w, in cells: wrongAt() times this is a volume.
    [[nodiscard]] double volumePerLength() const { return volume_per_length_; }

  private:
    std::vector<CellColumn> columns_;
    std::vector<double> turns_;
    double volume_per_length_ = 0.0;
};

}  // namespace relief
