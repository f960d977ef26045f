// SPDX-License-Identifier: Apache-2.0
// Scan conversion in double precision: finds the triangles that the rays of all texels hit, triangle by triangle and
// row by row. The rays of an orthographic view are parallel, and those of a cube's face start at one point. Scan
// conversion is several times as fast as tracing, handles both ends of the view at once, and does not depend on the
// arithmetic of a ray tracer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "bake/mesh/loops.h"
#include "bake/named_maps/projected_plane.h"
#include "bake/named_maps/ray_scene.h"
#include "bake/views/view.h"

namespace relief {

/// The hits of a view's rays.
///
/// Depths are those of the triangles' planes in double precision. A ray through the edge of two triangles hits both,
/// exactly: it cannot slip through. If triangles meet there or coincide, the one that faces the ray most wins; among
/// equals, the lowest index. For a ray that starts in the solid, triangles that face away win over those that face it,
/// because the ray may leave one solid and enter another at an edge where they touch.
class ScanConverter {
  public:
    /// \param scene, view  borrowed; must outlive this object.
    ScanConverter(const RayScene& scene, const View& view);

    /// Computes the hits of some rows from both ends of the rays. Runs on the calling thread; thread-safe.
    /// \param near, far  receive (end − begin) · width hits, row by row; each may be empty.
    void scan(const RowRange& rows, std::span<Hit> near, std::span<Hit> far) const;

  private:
    /// Number of rows that share a list of triangles.
    static constexpr std::uint32_t kBlockRows = 32;

    /// A triangle that may cover texels of a block.
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
    /// Prefetches the triangles after the i-th: they are scattered in memory, and waiting for them took half of the
    /// time.
    void prefetch(std::span<const Entry> entries, std::size_t i) const;
    /// Draws the rows [begin, end) of a triangle within a block.
    void draw(std::uint32_t triangle, std::uint32_t begin, std::uint32_t end, const Block& block) const;
    inline void meet(const ProjectedPlane& plane, std::uint32_t x, std::uint32_t y, const Block& block) const;
    [[nodiscard]] inline bool isInView(double depth, std::uint32_t face, std::uint32_t x,
                                       std::uint32_t y) const;
    /// Whether a hit replaces another one. Resolves ties of almost equal depth.
    [[nodiscard]] bool isBetter(std::uint32_t triangle, double depth, const Hit& than, RayEnd end,
                                std::uint32_t face, std::uint32_t x, std::uint32_t y) const;
    [[nodiscard]] bool atEdge(std::uint32_t triangle, std::uint32_t face, std::uint32_t x,
                              std::uint32_t y) const;
    /// Whether a ray runs through the solid up to its first surface, at `depth`.
    [[nodiscard]] bool startsInside(double depth, RayEnd end, std::uint32_t face, std::uint32_t x,
                                    std::uint32_t y) const;

    const RayScene& scene_;
    const View& view_;
    bool cube_;
    std::array<bool, 2> may_start_inside_;  // by RayEnd
    ProjectedPlanes planes_;
    /// The vertices of the mesh. Orthographic: (x, y, 1) in texels, with the centre of texel (i, j) at (i, j). Cube:
    /// relative to the cube's centre, in units of half its sides.
    std::vector<glm::dvec3> places_;
    std::uint32_t blocks_;                 // of rows, per face
    Buckets<Entry, std::size_t> entries_;  // by face and block, ascending by triangle
};

}  // namespace relief
