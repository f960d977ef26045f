// SPDX-License-Identifier: Apache-2.0
// Decompresses buffer views of a glTF file that use EXT_meshopt_compression.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/import/gltf_json.h"
#include "formats/base/result.h"

namespace relief {

/// Decompresses a buffer view.
/// \param extension  the extension object of the buffer view.
/// \param packed     the bytes that it references; untrusted.
/// \param size       bytes of the unpacked view.
/// Errors: kInvalidInput, kUnsupported (a mode or filter).
[[nodiscard]] Result<std::vector<std::byte>> unpackMeshopt(const GltfValue& extension,
                                                           std::span<const std::byte> packed,
                                                           std::uint64_t size);

}  // namespace relief
