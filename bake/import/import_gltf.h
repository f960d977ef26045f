// What assimp does not check in glTF 2.0 files, or reads wrongly without a word: looked at before assimp is.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// Looks through the JSON of a .gltf or .glb file: version, required extensions, compressed and quantised
/// attributes, that every accessor lies in its view and every view in its buffer, that nodes form trees, and
/// that buffers name files relative to the mesh. \param shown  the file's name for messages. \return
/// warnings, without the file's name. Errors: kUnsupported, kInvalidInput, kLimit.
[[nodiscard]] Result<std::vector<std::string>> checkGltf(std::span<const std::byte> bytes,
                                                         const std::string& shown);

}  // namespace relief
