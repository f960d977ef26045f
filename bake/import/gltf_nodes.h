// The nodes of a glTF file: which are shown, and where each stands. Errors name a place in the document, and no file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/import/gltf_json.h"
#include "bake/import/import_instances.h"
#include "formats/base/result.h"

namespace relief {

struct GltfNode {
    std::string name;  ///< "" for none
    std::vector<std::uint64_t> children;
    std::optional<std::uint64_t> parent;
    std::optional<std::uint64_t> mesh;  ///< exists
    bool skinned = false;               ///< its mesh stands where its skeleton does, not where the node does
    Transform transform;                ///< to its parent
};

/// All nodes. They form trees, whatever the file says. Errors: kInvalidInput.
[[nodiscard]] Result<std::vector<GltfNode>> readGltfNodes(const GltfValue& document);

/// The roots of the scene that the file shows: of its first one if it names none.
/// \param nodes  of the document. Errors: kInvalidInput.
[[nodiscard]] Result<std::vector<std::uint64_t>> gltfRoots(const GltfValue& document,
                                                           const std::vector<GltfNode>& nodes);

}  // namespace relief
