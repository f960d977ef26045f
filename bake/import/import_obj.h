// What of an OBJ file assimp leaves out without a word: vertices that no face names, and free-form surfaces.
#pragma once

#include <cstddef>
#include <span>

#include "bake/import/import_parts.h"

namespace relief {

/// Counts the statements of an OBJ file: `v`, `f`, and the free forms `curv`, `surf`, `bzp`, `bsp`, `cdc`, `cdp`. Whatever
/// is wrong with it, numbers out of range included, is passed over.
/// \return without lines and points.
[[nodiscard]] MeshParts objPartsOf(std::span<const std::byte> bytes);

}  // namespace relief
