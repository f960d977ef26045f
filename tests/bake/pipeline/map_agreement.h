// How far two maps of one view agree, texel by texel, and where they do not.
#pragma once

#include <cstdint>
#include <vector>

#include "bake/mesh/mesh.h"
#include "bake/plan/view.h"
#include "formats/depth_map.h"

namespace relief::test {

/// One end of a texel about which the maps differ.
struct Disagreement {
    std::uint32_t face;
    std::uint32_t x;
    std::uint32_t y;
    int end;       ///< 0: the front, or the one surface; 1: the back
    double units;  ///< of the last place of the stored depth
};

struct Agreement {
    std::uint64_t both = 0;              ///< surfaces in both maps
    std::vector<Disagreement> depths;    ///< in both, but their depths are more than a unit apart
    std::vector<Disagreement> coverage;  ///< in one alone
    std::uint64_t normals_off = 0;       ///< in both, but their normals are more than `degrees` apart
    double normal_degrees = 0.0;         ///< the farthest apart
};

/// A unit is that of the last place of the code; of halves a neighbour; of floats 1/65535.
/// \param a, b  of one frame.
[[nodiscard]] Agreement compareMaps(const DepthMap& a, const DepthMap& b, double degrees);

/// Distance from a texel's centre to the nearest edge of a triangle as the view sees it, in texels. A cube's
/// edges are cut off at the plane through its centre.
[[nodiscard]] double edgeDistance(const TriangleMesh& mesh, const View& view, std::uint32_t face,
                                  std::uint32_t x, std::uint32_t y);

}  // namespace relief::test
