// The nodes of a glTF file: which are shown, and where each stands. Errors name a place in the document, and no file.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
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
    /// Exists; only beside a mesh, which stands where its skeleton does then, not where the node does.
    std::optional<std::uint64_t> skin;
    Transform transform;  ///< to its parent
};

/// \param m  16 numbers, by columns. \return nullopt if its last row is not 0 0 0 1.
[[nodiscard]] std::optional<Transform> affine(std::span<const float> m);

/// All nodes. They form trees, whatever the file says. Errors: kInvalidInput.
[[nodiscard]] Result<std::vector<GltfNode>> readGltfNodes(const GltfValue& document);

/// Where a node stands, apart from what its mesh is in.
[[nodiscard]] Transform placeOf(const std::vector<GltfNode>& nodes, std::uint64_t node);

/// The roots of the scene that the file shows: of its first one if it names none.
/// \param nodes  of the document. Errors: kInvalidInput.
[[nodiscard]] Result<std::vector<std::uint64_t>> gltfRoots(const GltfValue& document,
                                                           const std::vector<GltfNode>& nodes);

}  // namespace relief
