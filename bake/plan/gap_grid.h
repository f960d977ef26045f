// What a map of gaps would hold (bake/texels/gap_map.h), on a coarse grid of lines of sight: enough to choose the maps
// after it, and to know how much its rows take up.
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

/// Says of a point of free space whether a map sees it. Called from many threads.
using IsSeen = std::function<bool(const glm::dvec3&)>;

/// Of the gaps on a line the one that counts most: the longest, as far as it is not seen.
/// \return nullopt if all are seen, or there is none.
[[nodiscard]] std::optional<LineGap> keptGap(const MeshQuery& query, const glm::dvec3& origin,
                                             const glm::dvec3& direction, const IsSeen& is_seen);

/// keptGap(query, p, direction, is_seen) is a gap that p lies in or on the end of. Asks less.
[[nodiscard]] bool isInKeptGap(const MeshQuery& query, const glm::dvec3& p, const glm::dvec3& direction,
                               const IsSeen& is_seen);

class GapGrid {
  public:
    /// \param view  orthographic, tight round the mesh; its size does not matter.
    GapGrid(const MeshQuery& query, View view, const IsSeen& is_seen);

    /// A point of free space lies in a gap that the map holds.
    [[nodiscard]] bool holds(const glm::dvec3& p) const;
    /// What its rows take up.
    [[nodiscard]] const Silhouette& silhouette() const { return silhouette_; }
    [[nodiscard]] double area() const { return area_; }  ///< of its rows, object units squared

  private:
    [[nodiscard]] std::vector<RowExtent> rows() const;

    View view_;
    std::vector<LineGap> cells_;  // of each texel; empty where it has none
    Silhouette silhouette_;
    double area_ = 0.0;
};

}  // namespace relief
