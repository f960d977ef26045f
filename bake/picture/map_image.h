// Depth maps as float images: what `relief export` writes.
//
// Channels Z and N.X N.Y N.Z: the surface that the map keeps, the front one of front-back maps, whose back
// one is in ZBack and NBack.X NBack.Y NBack.Z. Z is in object units along the ray, from the near plane of an
// orthographic map and from the centre of a cube; +inf, with a zero normal, where there is no surface. The
// top row of an orthographic image is the highest y of the map, that of a cube's face is t = 0, as OpenGL and
// KTX2 have it. String attributes repeat that, with format, projection, compare and face.
#pragma once

#include <cstdint>
#include <string>

#include "bake/picture/exr.h"
#include "formats/collider.h"

namespace relief {

/// "map0_front-back.exr", "map3_cube_+x.exr"
[[nodiscard]] std::string mapImageName(const DepthMap& map, std::size_t index, std::uint32_t face);

/// \param face  < map.faceCount()
/// \param unit  of lengths, for an attribute; "" if not known.
[[nodiscard]] FloatImage mapImage(const DepthMap& map, std::uint32_t face, const std::string& unit);

}  // namespace relief
