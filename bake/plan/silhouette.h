// How many texels the rows of a front-back map will have, before any ray is traced (formats/row_spans.h).
#pragma once

#include <cstdint>
#include <vector>

#include "bake/mesh/mesh.h"
#include "bake/plan/view.h"

namespace relief {

/// Across an image, from 0 to 1; nothing where low > high.
struct RowExtent {
    float low = 1.0F;
    float high = 0.0F;
};

/// The outline of a mesh as an orthographic view shows it, as far as rows ask of it: what each of many strips across the
/// image takes up.
class Silhouette {
  public:
    /// \param view  orthographic, tight round the mesh; its size does not matter.
    Silhouette(const TriangleMesh& mesh, const View& view);
    /// \param rows  what rows of equal height take up of the view's inner rectangle, from below
    explicit Silhouette(const std::vector<RowExtent>& rows);

    /// Of a map of this size: no fewer texels than the spans of its rows have.
    [[nodiscard]] std::uint64_t texels(std::uint32_t width, std::uint32_t height) const;
    /// Bytes on the GPU of a map of this size, as gpuBytes() has it at most.
    [[nodiscard]] std::uint64_t gpuBytes(std::uint32_t width, std::uint32_t height) const;

  private:
    std::vector<RowExtent> strips_;  // of the view's inner rectangle
};

}  // namespace relief
