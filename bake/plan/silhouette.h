// SPDX-License-Identifier: Apache-2.0
// The number of texels in the rows of a front-back map (formats/row_spans.h), before any ray is traced.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "bake/mesh/mesh.h"
#include "bake/plan/view.h"

namespace relief {

/// An interval across an image, from 0 to 1; empty where low > high.
struct RowExtent {
    float low = 1.0F;
    float high = 0.0F;

    void add(const RowExtent& other) {
        low = std::min(low, other.low);
        high = std::max(high, other.high);
    }
};

/// The outline of a mesh in an orthographic view: the extent of each of many strips across the image.
class Silhouette {
  public:
    /// \param view  orthographic, tight round the mesh, of any size.
    Silhouette(const TriangleMesh& mesh, const View& view);
    /// \param rows  extents of rows of equal height in the view's inner rectangle, from below
    explicit Silhouette(const std::vector<RowExtent>& rows);

    /// For a map of this size, an upper bound of the texels in its row spans.
    [[nodiscard]] std::uint64_t texels(std::uint32_t width, std::uint32_t height) const;
    /// For a map of this size, an upper bound of gpuBytes().
    [[nodiscard]] std::uint64_t gpuBytes(std::uint32_t width, std::uint32_t height) const;

  private:
    std::vector<RowExtent> strips_;  // of the view's inner rectangle
};

}  // namespace relief
