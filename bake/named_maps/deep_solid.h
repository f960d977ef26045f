// SPDX-License-Identifier: Apache-2.0
// Deep solid: points around which the whole cross-section of the texel is solid. No plane may cut them off.
//
// The rays that sample a texel (plane_fit.h) end at the surface. A steep plane cuts far deeper, where no ray detects
// the lost solid. This test therefore intersects a few lines along the texel with the solid. A ball around P with the
// texel's diagonal as its radius covers the texel's cross-section:
//
//     |‾‾|‾‾‾‾‾‾|‾‾|      If one of the lines is outside anywhere in the ball, P is not deep, and may be cut off
//     |  |  .P  |  |      to improve the points near the surface.
//     |__|______|__|
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "bake/mesh/mesh_query.h"
#include "formats/depth_map.h"
#include "formats/plane.h"

namespace relief {

/// Tests planes for one texel at a time. Traces lines on demand. Not thread-safe.
class DeepSolid {
  public:
    /// \param query, map  borrowed; must outlive this object.
    DeepSolid(const MeshQuery& query, const DepthMap& map) : query_(query), map_(map) {}

    /// \param texel  index: (face · height + y) · width + x
    void setTexel(std::size_t texel) {
        texel_ = texel;
        known_ = false;
    }

    /// Returns whether the half-space n·(P − O) ≥ offset, with O at depth 0 of the texel's centre ray, may contain deep
    /// solid: a solid point of the texel whose distance to the surface exceeds the texel's diagonal there. False
    /// positives are rare. False negatives occur only for open meshes, where lines enter and leave unequally often.
    [[nodiscard]] bool cutBy(const glm::dvec3& normal, double offset);

  private:
    static constexpr LineSpan kAllDepths = {-std::numeric_limits<double>::infinity(),
                                            std::numeric_limits<double>::infinity()};
    static constexpr std::size_t kLines = 5;
    static constexpr std::size_t kCorners = 4;

    /// Sets up the lines of texel_.
    void place();
    /// Intersects spans_ with the deep spans of the next line.
    void narrow();

    const MeshQuery& query_;
    const DepthMap& map_;
    std::size_t texel_ = 0;
    bool known_ = false;  // the members below are valid for texel_
    std::array<TexelRay, kLines> lines_;
    std::array<TexelRay, kCorners> corners_;
    TexelRay centre_;
    double diagonal_ = 0.0;   // of the cross-section at depth 1, in units of depth
    std::size_t traced_ = 0;  // number of lines traced
    bool any_known_ = false;
    std::vector<LineSpan> spans_;  // candidates for deep solid
    std::vector<LineSpan> of_line_;
    std::vector<LineSpan> both_;
};

}  // namespace relief
