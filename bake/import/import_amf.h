// AMF (ISO/ASTM 52915): objects of volumes, and constellations that place them.
#pragma once

#include <cstddef>
#include <span>

#include "bake/import/import_assembly.h"
#include "formats/base/result.h"

namespace relief {

/// An instance of a constellation is turned about x, then y, then z, by degrees, and then moved. The scene is what no
/// instance places.
/// Errors: kInvalidInput, without the file's name.
[[nodiscard]] Result<AssemblyFile> readAmf(std::span<const std::byte> bytes);

}  // namespace relief
