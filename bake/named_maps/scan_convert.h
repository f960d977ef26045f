// SPDX-License-Identifier: Apache-2.0
// Scan conversion in double precision: the triangles that the rays of all texels meet, triangle by triangle and row by row.
// The rays of an orthographic view are parallel and those of a cube's face start in one point. Several times as fast as
// tracing, for both ends of the view at once, and independent of a ray tracer's arithmetic.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "bake/mesh/loops.h"
#include "bake/named_maps/ray_scene.h"
#include "bake/named_maps/seen_plane.h"
#include "bake/views/view.h"

namespace relief {

/// The hits of a view's rays.
///
/// Depths are those of the triangles' planes in double precision. A ray through the edge of two triangles meets both, bit by
/// bit: none slips through. Of the triangles that meet there or coincide, those that face the ray count first, of these the
/// one that faces it most, and of equals the lowest index. But a ray that started in the solid counts where it leaves it: two
/// solids that touch at an edge are left and entered there at once.
class ScanConverter {
  public:
    /// \param scene, view  borrowed; must outlive it.
    ScanConverter(const RayScene& scene, const View& view);

    /// The hits of some rows from either end of the rays. Runs on the calling thread; thread-safe.
    /// \param near, far  receive (end − begin) · width hits, row by row; may be empty.
    void scan(const RowRange& rows, std::span<Hit> near, std::span<Hit> far) const;

  private:
    /// Rows that share a list of triangles.
    static constexpr std::uint32_t kBlockRows = 32;

    /// A triangle that may have texels in a block.
    struct Entry {
        std::uint32_t triangle;
        std::uint8_t begin;  ///< its rows within the block: [begin, end)
        std::uint8_t end;
    };
    struct Block;
    class Edge;
    class Shape;

    void place();
    void sortIntoBlocks();
    /// The triangles after the i-th are scattered in memory: waiting for them took half of the time.
    void prefetch(std::span<const Entry> entries, std::size_t i) const;
    /// Draws the rows [begin, end) of a triangle within a block.
    void draw(std::uint32_t triangle, std::uint32_t begin, std::uint32_t end, const Block& block) const;
    inline void meet(const SeenPlane& plane, std::uint32_t x, std::uint32_t y, const Block& block) const;
    [[nodiscard]] inline bool isInView(double depth, std::uint32_t face, std::uint32_t x,
                                       std::uint32_t y) const;
    /// A hit counts before one of almost the same depth.
    [[nodiscard]] bool isBetter(std::uint32_t triangle, double depth, const Hit& than, RayEnd end,
                                std::uint32_t face, std::uint32_t x, std::uint32_t y) const;
    [[nodiscard]] bool atEdge(std::uint32_t triangle, std::uint32_t face, std::uint32_t x,
                              std::uint32_t y) const;
    /// A ray runs through the solid up to its first surface, at `depth`.
    [[nodiscard]] bool startsInside(double depth, RayEnd end, std::uint32_t face, std::uint32_t x,
                                    std::uint32_t y) const;

    const RayScene& scene_;
    const View& view_;
    bool cube_;
    std::array<bool, 2> may_start_inside_;  // by RayEnd
    SeenPlanes planes_;
    /// The mesh's vertices. Orthographic: (x, y, 1) in texels, with the centre of texel (i, j) at (i, j). Cube: from the
    /// centre, in units of its half sides.
    std::vector<glm::dvec3> places_;
    std::uint32_t blocks_;                 // of rows, per face
    Buckets<Entry, std::size_t> entries_;  // by face and block, ascending by triangle
};

}  // namespace relief
