// SPDX-License-Identifier: Apache-2.0
// Converts maps to images, for `relief export`.
//
// Channels Z and N.X N.Y N.Z contain the surface of the map, or the front surface of a front-back map. ZBack and
// NBack.X NBack.Y NBack.Z contain the back surface. Z is in object units along the ray, from the near plane of an
// orthographic map or from the centre of a cube. It is +inf, with a zero normal, if there is no surface. The top row is
// the highest y of an orthographic map, and t = 0 of a cube's face, as in OpenGL and KTX2. String attributes document
// these rules and the map's format, projection, `compare` and face. Patches have no view; view_image.h draws them.
#pragma once

#include <cstdint>
#include <string>

#include "bake/images/exr.h"
#include "formats/collider.h"

namespace relief {

/// "map0_front-back.exr", "map3_cube_+x.exr"
[[nodiscard]] std::string mapImageName(const DepthMap& map, std::size_t index, std::uint32_t face);

/// Converts one face of a map.
/// \param map   any format except patches. \param face  < map.faceCount()
/// \param unit  of lengths, for an attribute; "" if unknown.
[[nodiscard]] ExrImage mapImage(const DepthMap& map, std::uint32_t face, const std::string& unit);

}  // namespace relief
