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
    bool inside_out = false;  ///< the triangles are clockwise seen from outside
    /// Decides by the triangles themselves which texels' centres they hold, and which is the nearest, to
    /// float precision: for baking. Otherwise texels whose centre lies within 1/256 of a texel of an edge may
    /// take the triangle beside it, or what lies behind a silhouette. Takes three vertices a triangle and a
    /// test a fragment more; not with motion.
    bool exact = false;
    /// Plane alone: a standing plane that leaves no more free space behind it than this is kept, in units of
    /// map depth.
    double good_enough = 0.0;
};

/// The frame of a map. Its rays start in free space if `encloses` is set.
/// \param map  valid (formats/validate.h); texels may be missing.
[[nodiscard]] DepthMapFrame frameOf(const DepthMap& map);

/// 6 for a cube, otherwise 1.
[[nodiscard]] std::uint32_t faceCount(const DepthMapFrame& frame);

/// Errors: kUsage (a size that no map has, a compare that does not go with the format, axes or an origin that
/// floats cannot hold).
[[nodiscard]] Result<void> checkFrame(const DepthMapFrame& frame);

/// A rectangle of texels of one face of a map.
struct TexelWindow {
    std::uint32_t face = 0;
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
};

}  // namespace relief
