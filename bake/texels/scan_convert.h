// Which triangle each texel's ray meets, without a ray: triangle by triangle, row by row, as GPUs do it, in double
// precision. The rays of an orthographic view are side by side and those of a cube's face run from one point, so that a
// triangle knows those that meet it. Several times as fast as a ray each, for both ends of the view at once, and the same
// on every processor, as no ray tracer's arithmetic takes part.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "bake/plan/view.h"
#include "bake/texels/ray_scene.h"
#include "bake/texels/seen_plane.h"

namespace relief {

/// A mesh as a view sees it.
///
/// The depth is that of the triangle's plane in double precision. Texels on the edge of two triangles belong to both, bit by
/// bit: no ray slips through. Of the triangles that share an edge there, and of those in one place, one that faces the ray
/// counts, of those the one that faces it most, and of equals the one of the lowest index. But where rays may start in the
/// solid and this one did, one that it leaves the solid by counts: two solids that touch at an edge are left and entered
/// there at once.
class ScanConverter {
  public:
    /// \param scene, view  borrowed; must outlive it.
    ScanConverter(const RayScene& scene, const View& view);

    /// What each texel of some rows meets, from either end of its ray, on the calling thread; from any number of them at
    /// once.
    /// \param near, far  (end − begin) · width, row by row; empty: not wanted.
    void scan(const RowRange& rows, std::span<Hit> near, std::span<Hit> far) const;

  private:
    /// Rows whose triangles are known together.
    static constexpr std::uint32_t kBlockRows = 32;

    /// A triangle that may have texels in a block.
    struct Entry {
        std::uint32_t triangle;
        std::uint8_t begin;  ///< of its rows, counted from the block's first
        std::uint8_t end;    ///< one behind the last
    };
    struct Block;
    class Edge;
    class Shape;

    void place();
    void sortIntoBlocks();
    /// The triangles of a block of rows of a face.
    [[nodiscard]] std::span<const Entry> entriesOf(std::uint32_t face, std::uint32_t block) const;
    /// The triangles after the i-th, which lie anywhere in memory: waiting for them took half of the time.
    void prefetch(std::span<const Entry> entries, std::size_t i) const;
    /// The rows [begin, end) of a triangle, which lie in a block.
    void draw(std::uint32_t triangle, std::uint32_t begin, std::uint32_t end, const Block& block) const;
    inline void meet(const SeenPlane& plane, std::uint32_t x, std::uint32_t y, const Block& block) const;
    [[nodiscard]] inline bool isInView(double depth, std::uint32_t face, std::uint32_t x,
                                       std::uint32_t y) const;
    /// Whether a hit counts more than one of almost the same depth.
    [[nodiscard]] bool isBetter(std::uint32_t triangle, double depth, const Hit& than, RayEnd end,
                                std::uint32_t face, std::uint32_t x, std::uint32_t y) const;
    [[nodiscard]] bool atEdge(std::uint32_t triangle, std::uint32_t face, std::uint32_t x,
                              std::uint32_t y) const;
    /// Of a ray whose first surface lies at a depth: whether it runs through the solid up to there.
    [[nodiscard]] bool startsInside(double depth, RayEnd end, std::uint32_t face, std::uint32_t x,
                                    std::uint32_t y) const;

    const RayScene& scene_;
    const View& view_;
    bool cube_;
    std::array<bool, 2> may_start_inside_;  // by RayEnd
    SeenPlanes planes_;
    /// The mesh's corners. Orthographic: (x, y) in texels, of which (i, j) is the centre of texel (i, j), and 1. Of a cube
    /// from the centre, in units of its half sides.
    std::vector<glm::dvec3> places_;
    std::uint32_t blocks_;            // of rows, of each face
    std::vector<std::size_t> first_;  // entry of each block of each face, and of one more
    std::vector<Entry> entries_;      // of each block, in ascending order of triangles
};

}  // namespace relief
