// Texels of a stored map as shaders/collider/collider.glsl wants them.
#pragma once

#include <cstddef>
#include <vector>

#include "formats/depth_map.h"

namespace relief {

/// The map's texels, changed where that spares every particle a test in the shader. No vote changes:
///
/// - a normal index 255, which reads as 254, is 254;
/// - in a front-back map of planes, an end that is empty beside one that is not has the other's plane: two
///   equal votes are one;
/// - texels of a float map are as they were.
///
/// Of a front-back map they are those of its rows' spans (row_spans.h), one after the other, and before them a texel for
/// each row from y = 0: first, end, and the low and the high word of what the index of a texel in this answer is less its
/// x. gpuBytes(map) in all.
[[nodiscard]] std::vector<std::byte> shaderTexels(const DepthMap& map);

}  // namespace relief
