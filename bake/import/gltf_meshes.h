// SPDX-License-Identifier: Apache-2.0
// The meshes and skins of a glTF file: triangles, positions, joints and morph targets. Errors name a place in the document, and
// no file.
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

/// A joint that moves a vertex.
struct GltfInfluence {
    std::uint32_t joint;  ///< of the skin; not checked
    float weight;         ///< 0 or more
};

/// The joints of a primitive's vertices.
struct GltfInfluences {
    std::size_t per_vertex = 0;
    std::vector<GltfInfluence> all;  ///< per_vertex for each vertex, whose weights have a sum above 0
};

struct GltfPrimitive {
    ScenePart part;  ///< of positions that triangles use
    std::optional<GltfInfluences> influences{};
    std::vector<std::vector<glm::vec3>> targets{};  ///< how far each moves a position; empty: it moves none
};

struct GltfMesh {
    std::vector<GltfPrimitive> primitives;  ///< those with triangles
};

struct GltfSkin {
    std::vector<std::uint32_t> nodes;
    std::vector<Transform> binds;  ///< inverseBindMatrices, one a node
};

/// Errors: kInvalidInput, kLimit, kUnsupported. \param document  whose nodes exist.
[[nodiscard]] Result<GltfSkin> readGltfSkin(const GltfValue& skin, GltfBuffers& buffers);

/// Whether the skin has every joint that moves a vertex. Errors: kInvalidInput. \param mesh, skin  for messages.
[[nodiscard]] Result<void> checkJoints(const GltfInfluences& influences, const GltfSkin& joints,
                                       const GltfValue& mesh, const GltfValue& skin);

/// Meshes, each read once.
class GltfMeshes {
  public:
    /// \param triangle_max  of all meshes together. \param buffers, warnings  borrowed.
    GltfMeshes(std::uint64_t triangle_max, GltfBuffers& buffers, std::vector<std::string>& warnings)
        : triangle_max_(triangle_max), buffers_(buffers), warnings_(warnings) {}

    struct Needs {
        bool joints = false;
        bool targets = false;
    };
    /// \return borrowed; the same for every call with that mesh, whatever it needs then.
    [[nodiscard]] Result<const GltfMesh*> read(const GltfValue& mesh, Needs needs);

    /// Of what was read, of all `meshes` of the file.
    [[nodiscard]] MeshParts counts(std::size_t meshes) const;

  private:
    /// Identifies the vertices of an accessor: exporters make many accessors of one view.
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
