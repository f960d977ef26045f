// SPDX-License-Identifier: Apache-2.0
// An estimate of a map of gaps (bake/texels/gap_map.h) on a coarse grid of lines of sight: enough to choose the maps after
// it, and for the extent of its rows.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "bake/mesh/mesh_query.h"
#include "bake/plan/silhouette.h"
#include "bake/plan/view.h"

namespace relief {

/// True of points of free space that a map sees. Called from many threads.
using IsSeen = std::function<bool(const glm::dvec3&)>;

/// The gap on a line with the greatest unseen length. \return nullopt if all are seen, or there is none.
[[nodiscard]] std::optional<LineGap> keptGap(const MeshQuery& query, const glm::dvec3& origin,
                                             const glm::dvec3& direction, const IsSeen& is_seen);

/// p lies in keptGap(query, p, direction, is_seen) or on its end. Cheaper.
[[nodiscard]] bool isInKeptGap(const MeshQuery& query, const glm::dvec3& p, const glm::dvec3& direction,
                               const IsSeen& is_seen);

class GapGrid {
  public:
    /// \param view  orthographic, tight round the mesh, of any size.
    GapGrid(const MeshQuery& query, View view, const IsSeen& is_seen);

    /// A point of free space lies in a kept gap.
    [[nodiscard]] bool holds(const glm::dvec3& p) const;
    /// The extents of its rows.
    [[nodiscard]] const Silhouette& silhouette() const { return silhouette_; }
    [[nodiscard]] double area() const { return area_; }  ///< of its rows, object units squared

  private:
    [[nodiscard]] std::vector<RowExtent> rows() const;

    View view_;
    std::vector<LineGap> cells_;  // by texel; empty without a gap
    Silhouette silhouette_;
    double area_ = 0.0;
};

}  // namespace relief
