// SPDX-License-Identifier: Apache-2.0
// Reads the animations of a glTF file as clips of an animated mesh. Errors name the place in the document, not the
// file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/import/gltf_data.h"
#include "bake/import/gltf_json.h"
#include "formats/animation/animated_mesh.h"
#include "formats/base/result.h"

namespace relief {

/// Adds every animation that moves a node of the mesh, under a unique name. Skips animations of zero length and
/// animations that move none of its nodes, with a warning.
/// \param mesh   its nodes are complete.
/// \param nodes  for each node of the file, the node of the mesh, or nullopt.
/// Errors: kInvalidInput, kLimit, kUnsupported.
[[nodiscard]] Result<void> readGltfClips(const GltfValue& document, GltfBuffers& buffers,
                                         const std::vector<std::optional<std::uint32_t>>& nodes,
                                         AnimatedMesh& mesh, std::vector<std::string>& warnings);

}  // namespace relief
