// SPDX-License-Identifier: Apache-2.0
// Maps as images, for `relief export`.
//
// Channels Z and N.X N.Y N.Z: the surface of the map, or the front one of a front-back map, with the back one in ZBack and
// NBack.X NBack.Y NBack.Z. Z is in object units along the ray, from the near plane of an orthographic map or the centre of a
// cube; +inf, with a zero normal, without a surface. The top row of an orthographic image is the highest y of the map, that
// of a cube's face is t = 0, as in OpenGL and KTX2. String attributes repeat this, with format, projection, compare and face.
// Patches have no view of their own; view_image.h draws them.
#pragma once

#include <cstdint>
#include <string>

#include "bake/images/exr.h"
#include "formats/collider.h"

namespace relief {

/// "map0_front-back.exr", "map3_cube_+x.exr"
[[nodiscard]] std::string mapImageName(const DepthMap& map, std::size_t index, std::uint32_t face);

/// \param map   not of patches. \param face  < map.faceCount()
/// \param unit  of lengths, for an attribute; "" if not known.
[[nodiscard]] ExrImage mapImage(const DepthMap& map, std::uint32_t face, const std::string& unit);

}  // namespace relief
