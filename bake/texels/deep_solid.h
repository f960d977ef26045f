// What no texel may call outside: points so deep in the solid that all of their texel is solid about them.
//
// The points that planes are chosen by lie near the surface (refine.h). A steep plane reaches far deeper, and so does a
// plane that was moved by what it gains near one layer of several; nothing that was drawn would tell. So a few lines
// along the texel are asked instead, all of whose crossings are known. A ball about a point deeper than the texel's
// diagonal holds the whole cross-section of the texel there:
//
//     |‾‾|‾‾‾‾‾‾|‾‾|      where one of the lines is not inside,
//     |  |  .P  |  |      some way before and behind P's depth,
//     |__|______|__|      P is not deep: cut it, if that is right for the points near the surface
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

/// The texels of one map, one after the other. Lines are traced when they are needed. Not thread-safe.
class DeepSolid {
  public:
    /// \param query, map  borrowed; must outlive it.
    DeepSolid(const MeshQuery& query, const DepthMap& map) : query_(query), map_(map) {}

    /// \param texel  index: (face · height + y) · width + x
    void setTexel(std::size_t texel) {
        texel_ = texel;
        known_ = false;
    }

    /// Whether the half-space n·(P − O) ≥ offset, with O where the texel's centre ray has depth 0, may hold a point of the
    /// texel that is deeper in the solid than the texel's diagonal there. False positives are rare, false negatives are
    /// none; of an open mesh, whose lines do not add up, it knows nothing.
    /// \param within  depths that count: where another plane of the texel, of a gap, holds nothing does not matter.
    [[nodiscard]] bool cutBy(const glm::dvec3& normal, double offset, const LineSpan& within = kAllDepths);

    /// The depths at which such a half-space has a point of the texel.
    [[nodiscard]] LineSpan depthsOf(const glm::dvec3& normal, double offset);

    static constexpr LineSpan kAllDepths = {-std::numeric_limits<double>::infinity(),
                                            std::numeric_limits<double>::infinity()};

  private:
    static constexpr std::size_t kLines = 5;
    static constexpr std::size_t kCorners = 4;

    /// The lines of texel_.
    void place();
    /// A half-space has points of the texel up to a depth, or from one on, by each corner.
    struct Reach {
        double up_to;
        double from;
    };
    [[nodiscard]] Reach reachOf(const glm::dvec3& normal, double offset);
    /// Keeps of spans_ what is deep by the next line too.
    void narrow();

    const MeshQuery& query_;
    const DepthMap& map_;
    std::size_t texel_ = 0;
    bool known_ = false;  // what follows is of texel_
    std::array<TexelRay, kLines> lines_;
    std::array<TexelRay, kCorners> corners_;
    TexelRay centre_;
    double diagonal_ = 0.0;  // of the cross-section, in units of depth, at depth 1
    std::size_t asked_ = 0;  // lines
    bool any_known_ = false;
    std::vector<LineSpan> spans_;  // that may be deep
    std::vector<LineSpan> of_line_;
    std::vector<LineSpan> both_;
};

}  // namespace relief
