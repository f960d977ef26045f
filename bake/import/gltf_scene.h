// SPDX-License-Identifier: Apache-2.0
// Reads the contents of a glTF file: nodes (hierarchy, transforms, visibility), meshes (triangles, positions, joint
// weights, morph targets), skins and animations. Errors name the place in the document, but not the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "bake/import/gltf_data.h"
#include "bake/import/import_scene.h"
#include "formats/animation/animated_mesh.h"
#include "formats/base/result.h"

namespace relief {

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
[[nodiscard]] Result<std::optional<SurfaceResponse>> readSurfaceResponse(const GltfValue& document,
                                                                         const GltfNode& node,
                                                                         std::vector<std::string>& warnings);

/// Checks the version and the required extensions. \param warnings  receives kAnimatedVisibility if animations show or
/// hide nodes. Errors: kInvalidInput, kUnsupported.
[[nodiscard]] Result<void> checkGltf(const GltfValue& document, std::vector<std::string>& warnings);

/// Reads all nodes, in file order. Errors: kInvalidInput, also if the nodes do not form trees or, with
/// HiddenMode::kSkip, if a node is a lower level of detail of itself.
[[nodiscard]] Result<std::vector<GltfNode>> readGltfNodes(const GltfValue& document, HiddenMode hidden);

/// Returns the root nodes of the default scene, or of the first scene if none is the default. Errors: kInvalidInput.
[[nodiscard]] Result<std::vector<std::uint32_t>> gltfRoots(const GltfValue& document,
                                                           const std::vector<GltfNode>& nodes);

/// Returns the nodes without a parent.
[[nodiscard]] std::vector<std::uint32_t> rootsOf(const std::vector<GltfNode>& nodes);

/// Returns the roots and all their descendants in depth-first order, parents first.
[[nodiscard]] std::vector<std::uint32_t> nodesBelow(const std::vector<std::uint32_t>& roots,
                                                    const std::vector<GltfNode>& nodes);

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

/// A joint that moves a vertex, and its weight.
struct GltfInfluence {
    std::uint32_t joint;  ///< index into the skin; not validated
    float weight;         ///< not negative
};

struct GltfInfluences {
    std::size_t per_vertex = 0;
    std::vector<GltfInfluence> all;  ///< per_vertex entries for each vertex; their weights sum to more than 0
};

struct GltfPrimitive {
    ScenePart part;  ///< contains only positions that triangles use
    std::optional<GltfInfluences> influences{};
    /// Per target, an offset for each position; empty if the target does not move positions.
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

class GltfMeshes {
  public:
    /// Borrows `buffers` and `warnings`. \param triangle_max  limit for all meshes together.
    GltfMeshes(std::uint64_t triangle_max, GltfBuffers& buffers, std::vector<std::string>& warnings)
        : triangle_max_(triangle_max), buffers_(buffers), warnings_(warnings) {}

    /// Reads the meshes of the nodes `shown`, in this order. Reads joints only for meshes of skinned nodes, and morph
    /// targets only if `targets`.
    [[nodiscard]] Result<void> read(const std::vector<std::uint32_t>& shown,
                                    const std::vector<GltfNode>& nodes, bool targets);
    /// Returns a mesh that was read.
    [[nodiscard]] const GltfMesh& at(const GltfValue& mesh) const { return meshes_.at(mesh.index()); }

    /// Counts the contents read so far. \param meshes  number of meshes in the file.
    [[nodiscard]] MeshParts counts(std::size_t meshes) const;

  private:
    /// Location of vertex data in the file. Exporters write many accessors for the same bytes, so an accessor does
    /// not identify data.
    using Key = std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t, bool, std::uint64_t>;
    struct Vertices {
        std::vector<glm::vec3> positions;
        std::vector<std::uint8_t> uses;
    };

    struct Needs {
        bool joints = false;
        bool targets = false;
    };
    [[nodiscard]] Result<void> readMesh(const GltfValue& mesh, Needs needs);
    [[nodiscard]] Result<GltfPrimitive> readPrimitive(const GltfValue& place, Needs needs);
    [[nodiscard]] Result<Vertices*> vertices(const GltfValue& accessor);
    [[nodiscard]] Result<void> readTriangles(const GltfValue& place, std::uint64_t mode, Vertices& vertices,
                                             ScenePart& part);
    [[nodiscard]] Result<void> readTargets(const std::vector<GltfValue>& places, std::size_t vertices,
                                           const std::vector<std::uint32_t>& kept, GltfPrimitive& out);

    std::uint64_t triangle_max_;
    GltfBuffers& buffers_;
    std::vector<std::string>& warnings_;
    std::map<std::uint64_t, GltfMesh> meshes_;
    MeshParts counts_;
    std::map<Key, Vertices> vertices_;
    std::uint64_t vertex_count_ = 0;
};

/// Adds every animation that moves a node of the mesh, under a unique name. Skips other animations and animations of
/// zero length, with a warning.
/// \param mesh   its nodes are complete.
/// \param nodes  for each node of the file, the node of the mesh, or nullopt.
/// Errors: kInvalidInput, kLimit, kUnsupported.
[[nodiscard]] Result<void> readGltfClips(const GltfValue& document, GltfBuffers& buffers,
                                         const std::vector<std::optional<std::uint32_t>>& nodes,
                                         AnimatedMesh& mesh, std::vector<std::string>& warnings);

}  // namespace relief
