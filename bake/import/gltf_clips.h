// SPDX-License-Identifier: Apache-2.0
// The animations of a glTF file as clips of an animated mesh. Errors name a place in the document, and no file.
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

/// Adds every animation that moves a node of the mesh, with a name that no other clip has. Left out with a warning: those of
/// no length, or that move none of its nodes.
/// \param mesh   its nodes are complete. \param nodes  the mesh's node of each node of the file, if it has one.
/// Errors: kInvalidInput, kLimit, kUnsupported.
[[nodiscard]] Result<void> readGltfClips(const GltfValue& document, GltfBuffers& buffers,
                                         const std::vector<std::optional<std::uint32_t>>& nodes,
                                         AnimatedMesh& mesh, std::vector<std::string>& warnings);

}  // namespace relief
