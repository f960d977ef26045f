// SPDX-License-Identifier: Apache-2.0
// Deep solid: points around which the texel's whole cross-section is solid, and which no plane may cut.
//
// The rays of a footprint end at the surface. A steep plane reaches far deeper without any ray to show it. So a few lines
// along the texel are intersected. A ball about a point deeper than the texel's diagonal holds the cross-section of the texel there:
//
//     |‾‾|‾‾‾‾‾‾|‾‾|      where one of the lines is outside for some way before and behind P's depth, P is not deep and may
//     |  |  .P  |  |      be cut for the sake of the points near the surface
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

/// For one texel of a map after the other. Lines are traced on demand. Not thread-safe.
class DeepSolid {
  public:
    /// \param query, map  borrowed; must outlive it.
    DeepSolid(const MeshQuery& query, const DepthMap& map) : query_(query), map_(map) {}

    /// \param texel  index: (face · height + y) · width + x
    void setTexel(std::size_t texel) {
        texel_ = texel;
        known_ = false;
    }

    /// The half-space n·(P − O) ≥ offset, with O at depth 0 of the texel's centre ray, may hold a point of the texel deeper in
    /// the solid than the texel's diagonal there. False positives are rare, false negatives impossible but for open meshes,
    /// whose lines do not balance.
    [[nodiscard]] bool cutBy(const glm::dvec3& normal, double offset);

  private:
    static constexpr LineSpan kAllDepths = {-std::numeric_limits<double>::infinity(),
                                            std::numeric_limits<double>::infinity()};
    static constexpr std::size_t kLines = 5;
    static constexpr std::size_t kCorners = 4;

    /// Sets up the lines of texel_.
    void place();
    /// Along the corners, a half-space holds points up to a depth, or from a depth on.
    struct Reach {
        double up_to;
        double from;
    };
    [[nodiscard]] Reach reachOf(const glm::dvec3& normal, double offset);
    /// Intersects spans_ with what is deep by the next line.
    void narrow();

    const MeshQuery& query_;
    const DepthMap& map_;
    std::size_t texel_ = 0;
    bool known_ = false;  // the members below are of texel_
    std::array<TexelRay, kLines> lines_;
    std::array<TexelRay, kCorners> corners_;
    TexelRay centre_;
    double diagonal_ = 0.0;  // of the cross-section, in units of depth, at depth 1
    std::size_t asked_ = 0;  // lines
    bool any_known_ = false;
    std::vector<LineSpan> spans_;  // may be deep
    std::vector<LineSpan> of_line_;
    std::vector<LineSpan> both_;
};

}  // namespace relief
