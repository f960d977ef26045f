// SPDX-License-Identifier: Apache-2.0
// The inside of a mesh in one cell of a grid, on lines along the axis of a patch.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "bake/mesh/mesh_query.h"
#include "formats/patch_tree.h"

namespace relief {

/// The corners of a triangle in the unit cube of a cell.
using UnitTriangle = std::array<glm::dvec3, 3>;

/// A cube in object space, and the part of the surface in it.
struct MeshCell {
    /// A point of the unit cube, beside its middle.
    static constexpr glm::dvec3 kKnown{0.5137, 0.4919, 0.5113};

    glm::dvec3 low{0.0};
    double size = 0.0;
    std::vector<std::uint32_t> triangles;  ///< those that meet the cube, in order
    BodyCounter bodies;                    ///< that kKnown is in

    [[nodiscard]] glm::dvec3 middle() const { return low + 0.5 * size; }
    [[nodiscard]] UnitTriangle inUnit(const TriangleMesh& mesh, std::uint32_t triangle) const;
};

/// All triangles of a cell, by their index there.
[[nodiscard]] std::vector<UnitTriangle> unitTriangles(const TriangleMesh& mesh, const MeshCell& cell);

/// The area of a triangle within the unit cube, and where it lies.
struct ClippedTriangle {
    double area = 0.0;
    glm::dvec3 center{0.0};
    glm::dvec3 normal{0.0};  ///< of unit length, by the winding
};
/// Of a triangle within the unit cube.
struct ClippedPolygon {
    std::array<glm::dvec3, 9> corners;
    unsigned count = 0;
};
/// \param polygon  filled in, if it is given and the area is not 0.
[[nodiscard]] ClippedTriangle clipToUnitCube(const UnitTriangle& triangle, ClippedPolygon* polygon = nullptr);
[[nodiscard]] bool meetsUnitCube(const UnitTriangle& triangle);

/// A plane in the unit cube of a cell.
struct CellPlane {
    glm::dvec3 normal{0.0, 1.0, 0.0};  ///< of unit length, outwards
    double offset = 0.0;               ///< distance of the cube's middle, in cells, negative inside

    [[nodiscard]] double at(const glm::dvec3& in_cell) const { return dot(normal, in_cell - 0.5) + offset; }
};
/// Through the middle of a surface, by its mean normal; level where that is none, and through the cell's middle where no piece
/// has an area.
[[nodiscard]] CellPlane meanPlane(std::span<const ClippedTriangle> pieces);
/// The mean normal of faces that may look to either side: those against `along` are reversed.
[[nodiscard]] glm::dvec3 meanNormalAlong(std::span<const ClippedTriangle> pieces, const glm::dvec3& along);

/// The eighths of a cell, x fastest.
/// \param triangles  of unitTriangles().
[[nodiscard]] std::array<MeshCell, 8> childrenOf(const MeshQuery& query, const MeshCell& cell,
                                                 std::span<const UnitTriangle> triangles);

/// The lines through the unit cube along one frame, in a square of `across` lines by as many: what they have in common for all
/// cells. Rows follow each other by v. Within a row, four quarters are beside each other, the first line of each, then the
/// second of each: fits treat four lines at once (lanes.h), in up to four squares between heights.
class LineGrid {
  public:
    /// From the side of the cube to its first line, in distances between lines. Not by half, since models are built on even
    /// numbers.
    static constexpr double kOffset = 0.5371;

    /// \param across  a multiple of 4.
    LineGrid(const PatchFrame& frame, unsigned across);

    /// From where a line enters the cube to where it leaves it, w of PatchFrame. Both 0 if it misses the cube.
    struct Line {
        double enters = 0.0;
        double leaves = 0.0;
        [[nodiscard]] bool misses() const { return leaves == 0.0 && enters == 0.0; }
    };
    /// The place at which a line enters the cube.
    struct Start {
        std::uint32_t line;
        std::uint32_t column;
        glm::dvec3 point;  ///< in the cube, next to its side
    };

    [[nodiscard]] const PatchFrame& frame() const { return frame_; }
    [[nodiscard]] unsigned across() const { return across_; }
    /// The index of a line, by its u and v.
    [[nodiscard]] std::uint32_t lineAt(unsigned column, unsigned row) const {
        return row * across_ + in_row_[column];
    }
    [[nodiscard]] const std::vector<Line>& lines() const { return lines_; }
    /// What lines() says, each in an array.
    [[nodiscard]] const std::vector<float>& enters() const { return enters_; }
    [[nodiscard]] const std::vector<float>& leaves() const { return leaves_; }
    [[nodiscard]] const std::vector<double>& lengths() const { return lengths_; }
    /// One for each line that does not miss, along a path in short steps.
    [[nodiscard]] const std::vector<Start>& starts() const { return starts_; }
    /// Whether the way from one start to the next may cross the triangle: that it may be near a side by which lines enter.
    [[nodiscard]] bool nearStarts(const UnitTriangle& triangle) const;
    /// Calls visit(i) for each i > 0 such that the way from starts()[i − 1] to starts()[i] may cross a triangle.
    /// \param over  the triangle, with lines at whole numbers of x and y.
    template <class Visit>
    void forEachWayBy(const UnitTriangle& over, const Visit& visit) const;
    /// Lines that meet a piece of a surface, as far as that goes by its area.
    [[nodiscard]] double expectedHits(const ClippedTriangle& piece) const;
    /// A step of w, in the cube.
    [[nodiscard]] const glm::dvec3& along() const { return along_; }
    /// The volume of a column for a unit of its w, in cells.
    [[nodiscard]] double volumePerLength() const { return volume_per_length_; }
    /// Of all columns.
    [[nodiscard]] double volume() const { return volume_; }
    /// −1 if (u, v, w) is left-handed, else 1.
    [[nodiscard]] int handedness() const { return handedness_; }

  private:
    PatchFrame frame_;
    unsigned across_;
    std::vector<std::uint32_t> in_row_;  // lineAt() row 0
    std::vector<Line> lines_;
    std::vector<float> enters_;
    std::vector<float> leaves_;
    std::vector<double> lengths_;
    std::vector<Start> starts_;
    std::vector<std::size_t> row_starts_;  // the first of each row, and their number
    glm::dvec3 along_{0.0};                // of w, in the cube
    double start_reach_ = 0;               // how far from such a side the way gets
    double volume_per_length_ = 0.0;
    double volume_ = 0.0;
    int handedness_ = 1;
};

/// The costs of volume on the wrong side.
struct ErrorCosts {
    double false_inside = 1.0;
    double false_outside = 1.0;
};

/// One line of a cell.
struct CellColumn {
    double enters = 0.0;
    double leaves = 0.0;
    bool inside = false;            ///< where it enters
    std::span<const double> turns;  ///< where it goes from outside to inside or back, in order

    /// The length from where it enters to `w` that is inside.
    [[nodiscard]] double insideTo(double w) const {
        double length = 0.0;
        double from = enters;
        bool in = inside;
        for (const double turn : turns) {
            if (turn >= w) {
                break;
            }
            length += in ? turn - from : 0.0;
            from = turn;
            in = !in;
        }
        return length + (in ? std::max(0.0, w - from) : 0.0);
    }
    /// The length on which "inside where w < height" is wrong, or with outside_below "w ≥ height", times its costs.
    [[nodiscard]] double wrongAt(double height, bool outside_below, const ErrorCosts& costs) const;
};

/// All lines of a cell.
class CellColumns {
  public:
    /// \param triangles  of unitTriangles().
    /// \param grid  borrowed.
    CellColumns(const MeshQuery& query, const MeshCell& cell, std::span<const UnitTriangle> triangles,
                const LineGrid& grid);

    [[nodiscard]] const LineGrid& grid() const { return grid_; }
    /// Of lines with triangles.
    [[nodiscard]] std::size_t hits() const { return hits_; }
    /// \param line  an index of LineGrid::lines(), of one that does not miss.
    [[nodiscard]] CellColumn operator[](std::size_t line) const {
        const Turns& turns = columns_[line];
        return {grid_.lines()[line].enters, grid_.lines()[line].leaves, inside_[line] != 0.0F,
                std::span(turns_).subspan(turns.first, turns.count)};
    }
    /// Of each line: 1 if it is inside where it enters, else 0.
    [[nodiscard]] std::span<const float> inside() const { return inside_; }
    /// The lines with turns.
    [[nodiscard]] std::span<const std::uint32_t> turning() const { return turning_; }

  private:
    struct Turns {
        std::uint32_t first = 0;
        std::uint32_t count = 0;
    };
    /// Takes what lies in voids for inside. \param first  of the line's turns, which are the last.
    void fillVoids(const MeshQuery& query, const MeshCell& cell, const LineGrid::Start& start,
                   std::size_t first);

    const LineGrid& grid_;
    std::vector<Turns> columns_;
    std::vector<float> inside_;
    std::vector<std::uint32_t> turning_;
    std::vector<double> turns_;
    std::size_t hits_ = 0;
};

}  // namespace relief
