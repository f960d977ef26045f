// SPDX-License-Identifier: Apache-2.0
// The nodes of a glTF file: the trees that they form, their transforms, and those that its scene shows. Errors name a place in
// the document, and no file.
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

/// Of EXT_mesh_gpu_instancing, in a whole file.
inline constexpr std::uint64_t kGltfInstancesMax = 1'000'000;

/// To the parent: first scaled, then turned, then moved; or a matrix.
struct GltfPlacement {
    glm::vec3 translation{0.0F};
    glm::vec4 rotation{0.0F, 0.0F, 0.0F,
                       1.0F};  ///< x, y, z, w; a unit quaternion, but for the rounding of bytes
    glm::vec3 scale{1.0F};
    bool matrix = false;  ///< in place of these
    Transform transform{};
};

struct GltfNode {
    GltfValue place;
    std::string name{};  ///< as the file has it
    GltfPlacement at{};
    std::optional<std::uint32_t> parent{};
    std::vector<std::uint32_t> children{};
    std::optional<GltfValue> mesh{};
    std::optional<GltfValue> skin{};
    Shown shown = Shown::kYes;  ///< KHR_node_visibility, MSFT_lod
};

/// The response of a node's surface by KHR_physics_rigid_bodies: that of its physics material. A share above 1 counts as 1.
/// \param warnings  receives one line, once, on combine modes. Errors: kInvalidInput.
[[nodiscard]] Result<std::optional<NodeResponse>> gltfResponse(const GltfValue& document,
                                                               const GltfNode& node,
                                                               std::vector<std::string>& warnings);

/// Version and extensions. \param warnings  receives those of optional extensions. Errors: kInvalidInput, kUnsupported.
[[nodiscard]] Result<void> checkGltf(const GltfValue& document, std::vector<std::string>& warnings);

/// All nodes, by their index. Errors: kInvalidInput, also where they form no trees, or where levels of detail lead back to
/// their node and are not kept.
[[nodiscard]] Result<std::vector<GltfNode>> readGltfNodes(const GltfValue& document, HiddenAs hidden);

/// The roots of the scene that the file shows, the first by default. Errors: kInvalidInput.
[[nodiscard]] Result<std::vector<std::uint32_t>> gltfRoots(const GltfValue& document,
                                                           const std::vector<GltfNode>& nodes);

/// The roots and all below them, each before its children, in the order in which the scene shows them.
[[nodiscard]] std::vector<std::uint32_t> nodesBelow(const std::vector<std::uint32_t>& roots,
                                                    const std::vector<GltfNode>& nodes);

/// The transform of a node with all above it.
[[nodiscard]] Transform transformInScene(const std::vector<GltfNode>& nodes, std::uint32_t index);

/// \param m  16 numbers, by columns. \return nullopt if its last row is not 0 0 0 1.
[[nodiscard]] std::optional<Transform> affineOf(const float* m);

/// The places of a node's mesh below the node, in its own place (EXT_mesh_gpu_instancing).
/// \param left  how many there may still be in the file; fewer afterwards. \return nullopt where there are none.
[[nodiscard]] Result<std::optional<std::vector<Transform>>> gltfInstances(const GltfNode& node,
                                                                          GltfBuffers& buffers,
                                                                          std::uint64_t& left);

}  // namespace relief
