// SPDX-License-Identifier: Apache-2.0
// Reads the nodes of a glTF file: hierarchy, transforms and visibility. Errors name the place in the document, not the
// file.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bake/import/gltf_data.h"
#include "bake/import/gltf_json.h"
#include "bake/import/import_scene.h"
#include "formats/base/result.h"

namespace relief {

/// Limit of EXT_mesh_gpu_instancing instances in a file.
inline constexpr std::uint64_t kGltfInstancesMax = 1'000'000;

/// A transform to the parent: scale, then rotation, then translation; or a matrix.
struct GltfPlacement {
    glm::vec3 translation{0.0F};
    glm::vec4 rotation{0.0F, 0.0F, 0.0F,
                       1.0F};  ///< x, y, z, w; a unit quaternion, up to rounding of normalized integers
    glm::vec3 scale{1.0F};
    bool matrix = false;  ///< `transform` replaces the members above
    Transform transform{};
};

struct GltfNode {
    GltfValue place;
    std::string name{};  ///< as stored in the file
    GltfPlacement at{};
    std::optional<std::uint32_t> parent{};
    std::vector<std::uint32_t> children{};
    std::optional<GltfValue> mesh{};
    std::optional<GltfValue> skin{};
    Shown shown = Shown::kYes;  ///< from KHR_node_visibility and MSFT_lod
};

/// Returns the surface response of a node: its physics material in KHR_physics_rigid_bodies. Values above 1 are clamped
/// to 1.
/// \param warnings  receives at most one line about combine modes.
/// Errors: kInvalidInput.
[[nodiscard]] Result<std::optional<NodeResponse>> gltfResponse(const GltfValue& document,
                                                               const GltfNode& node,
                                                               std::vector<std::string>& warnings);

/// Checks version and extensions. \param warnings  receives unsupported optional extensions. Errors: kInvalidInput,
/// kUnsupported.
[[nodiscard]] Result<void> checkGltf(const GltfValue& document, std::vector<std::string>& warnings);

/// Reads all nodes, in file order. Errors: kInvalidInput, also if the nodes do not form trees, or if skipped levels of
/// detail lead back to their node.
[[nodiscard]] Result<std::vector<GltfNode>> readGltfNodes(const GltfValue& document, HiddenAs hidden);

/// Returns the root nodes of the default scene, or of the first one. Errors: kInvalidInput.
[[nodiscard]] Result<std::vector<std::uint32_t>> gltfRoots(const GltfValue& document,
                                                           const std::vector<GltfNode>& nodes);

/// Returns the roots and all their descendants in depth-first order, parents first.
[[nodiscard]] std::vector<std::uint32_t> nodesBelow(const std::vector<std::uint32_t>& roots,
                                                    const std::vector<GltfNode>& nodes);

/// The node's transform to scene space.
[[nodiscard]] Transform transformInScene(const std::vector<GltfNode>& nodes, std::uint32_t index);

/// Converts a matrix.
/// \param m  16 numbers, column-major.
/// \return nullopt if the last row is not 0 0 0 1.
[[nodiscard]] std::optional<Transform> affineOf(const float* m);

/// Reads the transforms of a node's instances, relative to the node (EXT_mesh_gpu_instancing).
/// \param left  instances still allowed in the file; decremented.
/// \return nullopt if the node is not instanced.
[[nodiscard]] Result<std::optional<std::vector<Transform>>> gltfInstances(const GltfNode& node,
                                                                          GltfBuffers& buffers,
                                                                          std::uint64_t& left);

}  // namespace relief
