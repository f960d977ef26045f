// SPDX-License-Identifier: Apache-2.0
// The inside of a mesh in one cell of a grid, sampled along parallel lines.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "bake/mesh/mesh_query.h"
#include "formats/patch_tree.h"

namespace relief {

/// The corners of a triangle, in the unit cube of a cell.
using UnitTriangle = std::array<glm::dvec3, 3>;

/// A cube in object space, and the triangles that meet it.
struct MeshCell {
    /// A point of the unit cube near its centre.
    static constexpr glm::dvec3 kKnown{0.5137, 0.4919, 0.5113};

    glm::dvec3 low{0.0};
    double size = 0.0;
    std::vector<std::uint32_t> triangles;  ///< those that meet the cube, in ascending order
    BodyCounter bodies;                    ///< the solids that contain kKnown

    [[nodiscard]] glm::dvec3 middle() const { return low + 0.5 * size; }
    [[nodiscard]] UnitTriangle inUnit(const TriangleMesh& mesh, std::uint32_t triangle) const;
};

/// Returns all triangles of a cell in its unit cube, in the order of MeshCell::triangles.
[[nodiscard]] std::vector<UnitTriangle> unitTriangles(const TriangleMesh& mesh, const MeshCell& cell);

/// The part of a triangle within the unit cube: its area, centroid and normal.
struct ClippedTriangle {
    double area = 0.0;
    glm::dvec3 center{0.0};
    glm::dvec3 normal{0.0};  ///< unit length, by the winding
};
/// The corners of the part of a triangle within the unit cube.
struct ClippedPolygon {
    std::array<glm::dvec3, 9> corners;
    unsigned count = 0;
};
/// \param polygon  optional; filled in if the area is not 0.
[[nodiscard]] ClippedTriangle clipToUnitCube(const UnitTriangle& triangle, ClippedPolygon* polygon = nullptr);
[[nodiscard]] bool meetsUnitCube(const UnitTriangle& triangle);

/// A plane in the unit cube of a cell.
struct CellPlane {
    glm::dvec3 normal{0.0, 1.0, 0.0};  ///< unit length, outwards
    double offset = 0.0;               ///< signed distance of the cube's centre, in cells, negative inside

    [[nodiscard]] double at(const glm::dvec3& in_cell) const { return dot(normal, in_cell - 0.5) + offset; }
};
/// Returns the plane through the centroid of a surface, with its mean normal. The normal is +y if the normals cancel
/// out; the plane passes through the centre of the cell if no piece has an area.
[[nodiscard]] CellPlane meanPlane(std::span<const ClippedTriangle> pieces);
/// Returns the mean normal of faces of either orientation; reverses the normals that point against `along`.
[[nodiscard]] glm::dvec3 meanNormalAlong(std::span<const ClippedTriangle> pieces, const glm::dvec3& along);

/// Returns the octants of a cell, x fastest.
/// \param triangles  from unitTriangles().
[[nodiscard]] std::array<MeshCell, 8> childrenOf(const MeshQuery& query, const MeshCell& cell,
                                                 std::span<const UnitTriangle> triangles);

/// The inverse of PatchFrame::across: the point of the cube at (u, v, w) = 0, and its derivatives by u, v and w.
struct CubeAxes {
    glm::dvec3 origin;
    glm::dmat3 by;

    explicit CubeAxes(const PatchFrame& frame);
    [[nodiscard]] glm::dvec3 at(double u, double v, double w) const {
        return origin + u * by[0] + v * by[1] + w * by[2];
    }
};

/// `across` × `across` lines through the unit cube along w of a PatchFrame, and the data of these lines shared by all
/// cells. Rows are ordered by v. A row interleaves its four quarters: the first line of each quarter, then the second
/// of each, and so on. Fits can thus process four lines at once (lanes.h): along a row, each lane stays between the
/// same two heights.
class LineGrid {
  public:
    /// Distance from the side of the cube to the first line, in line spacings. Not 0.5, because models are built on
    /// round numbers.
    static constexpr double kOffset = 0.5371;

    /// \param across  a multiple of 4.
    LineGrid(const PatchFrame& frame, unsigned across);

    /// The interval of w (PatchFrame) in which a line is inside the cube. Both ends are 0 if the line misses the cube.
    struct Line {
        double enters = 0.0;
        double leaves = 0.0;
        [[nodiscard]] bool misses() const { return leaves == 0.0 && enters == 0.0; }
    };
    /// The point at which a line enters the cube.
    struct Start {
        std::uint32_t line;
        std::uint32_t column;
        glm::dvec3 point;  ///< in the cube, next to its side
    };

    [[nodiscard]] const PatchFrame& frame() const { return frame_; }
    [[nodiscard]] unsigned across() const { return across_; }
    /// The index of the line at a column (u) and a row (v).
    [[nodiscard]] std::uint32_t lineAt(unsigned column, unsigned row) const {
        return row * across_ + in_row_[column];
    }
    [[nodiscard]] const std::vector<Line>& lines() const { return lines_; }
    /// The members of lines(), as separate arrays.
    [[nodiscard]] const std::vector<float>& enters() const { return enters_; }
    [[nodiscard]] const std::vector<float>& leaves() const { return leaves_; }
    [[nodiscard]] const std::vector<double>& lengths() const { return lengths_; }
    /// The starts of all lines that do not miss the cube, in order along a path of short segments.
    [[nodiscard]] const std::vector<Start>& starts() const { return starts_; }
    /// Whether the triangle is near a side where lines enter, so that the path from one start to the next may cross it.
    [[nodiscard]] bool nearStarts(const UnitTriangle& triangle) const;
    /// Calls visit(i) for each i > 0 for which the segment from starts()[i − 1] to starts()[i] may cross a triangle.
    /// \param over  the triangle in grid coordinates: lines are at integer x and y.
    template <class Visit>
    void forEachSegmentNear(const UnitTriangle& over, const Visit& visit) const;
    /// The expected number of lines that meet a piece of a surface, by its area.
    [[nodiscard]] double expectedHits(const ClippedTriangle& piece) const;
    /// One unit of w, as a vector in the cube.
    [[nodiscard]] const glm::dvec3& along() const { return along_; }
    /// The volume of a column per unit of w, in cells.
    [[nodiscard]] double volumePerLength() const { return volume_per_length_; }
    /// The volume of all columns, in cells.
    [[nodiscard]] double volume() const { return volume_; }
    /// −1 if (u, v, w) is left-handed, else 1.
    [[nodiscard]] int handedness() const { return handedness_; }

  private:
    PatchFrame frame_;
    unsigned across_;
    std::vector<std::uint32_t> in_row_;  // lineAt() of row 0
    std::vector<Line> lines_;
    std::vector<float> enters_;
    std::vector<float> leaves_;
    std::vector<double> lengths_;
    std::vector<Start> starts_;
    std::vector<std::size_t> row_starts_;  // the first start of each row, then the total
    glm::dvec3 along_{0.0};                // one unit of w, in the cube
    double start_reach_ = 0;  // the path stays within this distance of the sides where lines enter
    double volume_per_length_ = 0.0;
    double volume_ = 0.0;
    int handedness_ = 1;
};

/// Weights of misclassified volume.
struct ErrorCosts {
    double false_inside = 1.0;
    double false_outside = 1.0;
};

/// The inside along one line of a cell.
struct CellColumn {
    double enters = 0.0;
    double leaves = 0.0;
    bool inside = false;            ///< at `enters`
    std::span<const double> turns;  ///< where the line changes between outside and inside, in ascending order

    /// Returns the length that is inside between `enters` and `w`.
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
    /// Returns the weighted length that is misclassified by "inside where w < height", or by "inside where w ≥ height"
    /// with outside_below.
    [[nodiscard]] double wrongAt(double height, bool outside_below, const ErrorCosts& costs) const;
};

/// The columns of all lines of a cell.
class CellColumns {
  public:
    /// \param triangles  from unitTriangles().
    /// \param grid  borrowed.
    CellColumns(const MeshQuery& query, const MeshCell& cell, std::span<const UnitTriangle> triangles,
                const LineGrid& grid);

    [[nodiscard]] const LineGrid& grid() const { return grid_; }
    /// Number of intersections of lines with triangles that face along the lines, or against them.
    [[nodiscard]] std::size_t hits(bool along) const { return hits_[along ? 1 : 0]; }
    /// \param line  an index of LineGrid::lines() whose line does not miss the cube.
    [[nodiscard]] CellColumn operator[](std::size_t line) const {
        const Turns& turns = columns_[line];
        return {grid_.lines()[line].enters, grid_.lines()[line].leaves, inside_[line] != 0.0F,
                std::span(turns_).subspan(turns.first, turns.count)};
    }
    /// For each line: 1 if it is inside where it enters, else 0.
    [[nodiscard]] std::span<const float> inside() const { return inside_; }
    /// The lines with turns, ascending.
    [[nodiscard]] std::span<const std::uint32_t> turning() const { return turning_; }

  private:
    struct Turns {
        std::uint32_t first = 0;
        std::uint32_t count = 0;
    };
    /// Treats voids as inside. \param first  index in turns_ of the line's first turn; no other line's turns follow.
    void fillVoids(const MeshQuery& query, const MeshCell& cell, const LineGrid::Start& start,
                   std::size_t first);

    const LineGrid& grid_;
    std::vector<Turns> columns_;
    std::vector<float> inside_;
    std::vector<std::uint32_t> turning_;
    std::vector<double> turns_;
    std::array<std::size_t, 2> hits_{};
};

}  // namespace relief
