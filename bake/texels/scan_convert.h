// Which triangle each texel's ray of an orthographic view meets, without a ray: triangle by triangle, row by row, as
// GPUs do it, in double precision. The rays of such a view are side by side, so that a triangle knows those that meet it.
// A dozen times as fast as a ray each, for both ends of the view at once, and the same on every processor, as no ray
// tracer's arithmetic takes part.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "bake/plan/view.h"
#include "bake/texels/plane_depth.h"
#include "bake/texels/ray_scene.h"

namespace relief {

/// A mesh as an orthographic view sees it.
class ScanConverter {
  public:
    /// \param scene, view  borrowed; must outlive it.
    ScanConverter(const RayScene& scene, const View& view);

    /// What ViewTracer (raycast.h) promises of rows, on the calling thread. Samples on the edge of two triangles belong to
    /// both, bit by bit: no ray slips through.
    /// \param near, far  (end − begin) · width, row by row; empty: not wanted.
    void scanRows(const RowRange& rows, std::span<Hit> near, std::span<Hit> far) const;

    /// Rows whose triangles are known together: others ask for more than they need.
    static constexpr std::uint32_t kBlockRows = 32;

  private:
    struct Block;
    class Triangle;

    /// The triangles of a block of rows.
    [[nodiscard]] std::span<const std::uint32_t> trianglesOf(std::uint32_t block) const;
    void scan(std::uint32_t triangle, const Block& block) const;
    void meet(std::uint32_t triangle, const PlaneDepth& plane, std::uint32_t x, std::uint32_t y,
              const Block& block) const;
    /// Whether a hit counts more than one of almost the same depth.
    [[nodiscard]] bool isBetter(std::uint32_t triangle, double depth, const Hit& than, RayEnd end,
                                std::uint32_t x, std::uint32_t y) const;
    [[nodiscard]] double depthAt(std::uint32_t triangle, const PlaneDepth& plane, std::uint32_t x,
                                 std::uint32_t y) const;
    [[nodiscard]] bool atEdge(std::uint32_t triangle, std::uint32_t x, std::uint32_t y) const;

    const RayScene& scene_;
    const View& view_;
    PlaneDepths planes_;
    glm::dvec3 direction_;  // of growing depth
    std::vector<glm::dvec2>
        places_;  // of the mesh's corners, in texels: (x, y) is the centre of texel (x, y)
    std::vector<std::size_t> first_;        // of each block of rows, and of one more
    std::vector<std::uint32_t> triangles_;  // of each block, in ascending order
};

}  // namespace relief
