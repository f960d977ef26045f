// Checks of glTF 2.0 files that assimp does not make, and refusals of what it reads wrongly without a word. They run
// before assimp does.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// Looks through the JSON of a .gltf or .glb file: version, required extensions, compressed and quantised
/// attributes, that every accessor lies in its view and every view in its buffer, that nodes form trees, and
/// that buffers name files relative to the mesh.
/// \param shown  the file's name for messages.
/// \return warnings, without the file's name.
/// Errors: kUnsupported, kInvalidInput, kLimit.
[[nodiscard]] Result<std::vector<std::string>> checkGltf(std::span<const std::byte> bytes,
                                                         const std::string& shown);

}  // namespace relief
