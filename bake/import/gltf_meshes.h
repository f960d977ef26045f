// SPDX-License-Identifier: Apache-2.0
// Reads the meshes and skins of a glTF file: triangles, positions, joint weights and morph targets. Errors name the
// place in the document, not the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "bake/import/gltf_data.h"
#include "bake/import/gltf_json.h"
#include "bake/import/gltf_nodes.h"
#include "bake/import/import_scene.h"
#include "formats/base/result.h"

namespace relief {

/// A joint that moves a vertex, and its weight.
struct GltfInfluence {
    std::uint32_t joint;  ///< index into the skin; not validated
    float weight;         ///< not negative
};

/// The joint influences of a primitive's vertices.
struct GltfInfluences {
    std::size_t per_vertex = 0;
    std::vector<GltfInfluence> all;  ///< per_vertex entries for each vertex; their weights sum to more than 0
};

struct GltfPrimitive {
    ScenePart part;  ///< contains only positions that triangles use
    std::optional<GltfInfluences> influences{};
    /// Per target, an offset for each position; empty if the target moves none.
    std::vector<std::vector<glm::vec3>> targets{};
};

struct GltfMesh {
    std::vector<GltfPrimitive> primitives;  ///< only those with triangles
};

struct GltfSkin {
    std::vector<std::uint32_t> nodes;
    std::vector<Transform> binds;  ///< inverseBindMatrices, one per node
};

/// Reads a skin and checks that its nodes exist. Errors: kInvalidInput, kLimit, kUnsupported.
[[nodiscard]] Result<GltfSkin> readGltfSkin(const GltfValue& skin, GltfBuffers& buffers);

/// Checks that the skin has every joint that moves a vertex. \param mesh, skin  for messages. Errors: kInvalidInput.
[[nodiscard]] Result<void> checkJoints(const GltfInfluences& influences, const GltfSkin& joints,
                                       const GltfValue& mesh, const GltfValue& skin);

/// Reads each mesh once.
class GltfMeshes {
  public:
    /// Borrows `buffers` and `warnings`. \param triangle_max  limit for all meshes together.
    GltfMeshes(std::uint64_t triangle_max, GltfBuffers& buffers, std::vector<std::string>& warnings)
        : triangle_max_(triangle_max), buffers_(buffers), warnings_(warnings) {}

    struct Needs {
        bool joints = false;
        bool targets = false;
    };
    /// Reads a mesh. \return borrowed; repeated calls return the first result and ignore `needs`.
    [[nodiscard]] Result<const GltfMesh*> read(const GltfValue& mesh, Needs needs);

    /// Counts the contents read so far. \param meshes  number of meshes in the file.
    [[nodiscard]] MeshParts counts(std::size_t meshes) const;

  private:
    /// Identifies vertex data by its place, because exporters write many accessors for the same bytes.
    using Key = std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t, bool, std::uint64_t>;
    struct Vertices {
        std::vector<glm::vec3> positions;
        std::vector<std::uint8_t> uses;
    };

    [[nodiscard]] Result<GltfPrimitive> readPrimitive(const GltfValue& place, Needs needs);
    [[nodiscard]] Result<Vertices*> vertices(const GltfValue& accessor);
    [[nodiscard]] Result<void> readTriangles(const GltfValue& place, std::uint64_t mode, Vertices& vertices,
                                             ScenePart& part);
    [[nodiscard]] Result<void> readTargets(const std::vector<GltfValue>& places, std::size_t vertices,
                                           const std::vector<std::uint32_t>& kept, GltfPrimitive& out);
    void warn(const std::string& text);

    std::uint64_t triangle_max_;
    GltfBuffers& buffers_;
    std::vector<std::string>& warnings_;
    std::map<std::uint64_t, GltfMesh> meshes_;
    MeshParts counts_;
    std::map<Key, Vertices> vertices_;
    std::uint64_t vertex_count_ = 0;
};

}  // namespace relief
