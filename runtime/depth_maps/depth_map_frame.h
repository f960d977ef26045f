// The frame of a rendered depth map (depth_map_renderer.h).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "formats/base/result.h"
#include "formats/depth_map.h"

namespace relief {

/// The viewpoint of a map, and the surfaces that it keeps.
struct DepthMapFrame {
    MapFormat format = MapFormat::kFixed8;
    Compare compare = Compare::kLess;  ///< kBoth if and only if isFrontBack(format)
    Decode decode = Decode::kProjected;
    std::uint32_t width = 0;  ///< texels; a cube's faces are width × width
    std::uint32_t height = 0;
    /// Orthographic: the point of map coordinates (0, 0, 0). Cube: the centre. Object space.
    glm::dvec3 origin{0.0};
    /// Object vectors of one unit along each map axis, orthogonal; a cube's along the axes of object space.
    glm::dvec3 axis[3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    /// The volume holds the whole mesh. It never changes a texel; without it cubes look where their volume
    /// ends, which costs time.
    bool encloses = true;
    /// The rays of the near and of the far end start in free space. Where they may not, a surface met from
    /// its inner side leaves the texel empty.
    bool starts_free[2] = {true, true};
};

/// The frame of a map. Its rays start in free space if `encloses` is set.
/// \param map  valid (formats/validate.h); texels may be missing.
[[nodiscard]] DepthMapFrame frameOf(const DepthMap& map);

/// 6 for a cube, otherwise 1.
[[nodiscard]] std::uint32_t faceCount(const DepthMapFrame& frame);

/// Errors: kUsage (a size that no map has, a compare that does not go with the format, axes or an origin that
/// floats cannot hold).
[[nodiscard]] Result<void> checkFrame(const DepthMapFrame& frame);

}  // namespace relief
