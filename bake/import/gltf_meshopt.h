// SPDX-License-Identifier: Apache-2.0
// EXT_meshopt_compression: what a buffer view of a glTF file holds, unpacked by meshoptimizer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/import/gltf_json.h"
#include "formats/base/result.h"

namespace relief {

/// \param extension  of a buffer view. \param packed  the bytes that it names; may be hostile.
/// \param size  bytes of the buffer view.
/// Errors: kInvalidInput, kUnsupported (a mode or a filter).
[[nodiscard]] Result<std::vector<std::byte>> unpackMeshopt(const GltfValue& extension,
                                                           std::span<const std::byte> packed,
                                                           std::uint64_t size);

}  // namespace relief
