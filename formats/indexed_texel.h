// Writing texels whose normals are encoded already.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "formats/texel.h"

namespace relief {

/// A surface with encodeNormal(normal) at hand. kFloat32 ignores the index, the other formats the normal.
struct IndexedSurface {
    Surface surface;
    NormalIndex index;
};
/// The same from surfaces whose normals are encoded already.
void encodeTexel(MapFormat format, const std::optional<IndexedSurface>& front,
                 const std::optional<IndexedSurface>& back, std::span<std::byte> bytes);

}  // namespace relief
