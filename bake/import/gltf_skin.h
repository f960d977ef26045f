// Skins of a glTF file: where the vertices of a mesh stand in the pose that the file's nodes have. Errors name a place in
// the document, and no file.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "bake/import/gltf_buffers.h"
#include "bake/import/gltf_json.h"
#include "bake/import/gltf_nodes.h"
#include "bake/import/import_instances.h"
#include "formats/base/result.h"

namespace relief {

/// A joint that moves a vertex.
struct GltfInfluence {
    std::uint32_t joint = 0;  ///< of the skin
    float weight = 0.0F;      ///< 0 or more
};

/// The joints of a primitive's vertices.
struct GltfInfluences {
    std::size_t per_vertex = 0;
    std::vector<GltfInfluence>
        all;  ///< per_vertex for each vertex; the weights of each are more than 0 in sum
};

/// Reads JOINTS_0, WEIGHTS_0, JOINTS_1, … \param attributes  of a primitive. \param vertices  as many as it has.
/// \return nullopt where there are none. Errors: kInvalidInput, kUnsupported, kLimit.
[[nodiscard]] Result<std::optional<GltfInfluences>> readInfluences(const GltfValue& document,
                                                                   const GltfValue& attributes,
                                                                   GltfBuffers& buffers,
                                                                   std::uint64_t vertices);

/// What each joint of a skin does to vertices as they are modelled.
/// \param index  of a skin that exists. Errors: kInvalidInput, kUnsupported, kLimit.
[[nodiscard]] Result<std::vector<Transform>> readSkin(const GltfValue& document, std::uint64_t index,
                                                      const std::vector<GltfNode>& nodes,
                                                      GltfBuffers& buffers);

/// The positions in that pose. \param influences  of these positions, of joints that exist.
/// \return also whether most of them are mirrored.
struct GltfPose {
    std::vector<glm::vec3> positions;
    bool mirrored = false;
};
[[nodiscard]] GltfPose posed(const std::vector<glm::vec3>& positions, const GltfInfluences& influences,
                             const std::vector<Transform>& joints);

}  // namespace relief
