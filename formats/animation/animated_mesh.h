// SPDX-License-Identifier: Apache-2.0
// An animated mesh in glTF's terms: a node hierarchy, joints and morph targets that move vertices, and keyframe clips.
// This header only declares the data; mesh_pose.h evaluates poses.
//
//     clip ── keys ──▶ nodes' transforms, weights of targets          (MeshPose)
//                          │                   │
//     position + Σ weight · delta  ──▶  Σ weight · joint · position     glTF 2.0, 3.7.2.2 and 3.7.3.1
//
// Nodes that place a mesh without a skin count as joints of weight 1, so machines and characters share one code path.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "formats/depth_map.h"

namespace relief {

inline constexpr std::size_t kMeshNodesMax = 8192;
inline constexpr std::size_t kMeshJointsMax = 4096;
inline constexpr std::size_t kMorphTargetsMax = 1024;
inline constexpr std::size_t kMeshClipsMax = 1024;
inline constexpr std::size_t kMeshMaterialsMax = 4096;
inline constexpr std::size_t kAnimatedNameMax = 255;  ///< bytes, for names of nodes, clips and materials
inline constexpr std::size_t kAnimatedVerticesMax = 1'000'000;
inline constexpr std::size_t kVertexInfluencesMax = 16;
inline constexpr float kClipSecondsMax = 86'400.0F;

/// Interpolation between keys (glTF 2.0, appendix C).
enum class KeyCurve : std::uint8_t {
    kStep = 0,
    kLinear = 1,  ///< rotations take the shorter arc
    kCubic = 2    ///< Hermite; each key stores in-tangent, value, out-tangent
};

/// The node property that a channel animates.
enum class NodeMember : std::uint8_t { kTranslation = 0, kRotation = 1, kScale = 2, kWeights = 3 };

struct MeshNode {
    std::string name;                            ///< clean UTF-8; may be empty, need not be unique
    std::int32_t parent = -1;                    ///< less than the node's own index; -1: none
    glm::vec3 translation{0.0F};                 ///< object units
    glm::vec4 rotation{0.0F, 0.0F, 0.0F, 1.0F};  ///< unit quaternion x, y, z, w
    glm::vec3 scale{1.0F};
    std::optional<Affine> matrix{};  ///< replaces the three members above, which no channel may then animate
    std::uint32_t first_weight = 0;  ///< index into AnimatedMesh::weights of the node's first morph weight
    std::uint32_t weights = 0;
    friend bool operator==(const MeshNode&, const MeshNode&) = default;
};

struct MeshJoint {
    std::uint32_t node = 0;
    Affine bind;  ///< from the space of the positions to the node's space (glTF's inverseBindMatrices)
    friend bool operator==(const MeshJoint&, const MeshJoint&) = default;
};

struct VertexInfluence {
    std::uint32_t joint = 0;
    float weight = 1.0F;  ///< above 0; the weights of a vertex sum to 1
    friend bool operator==(const VertexInfluence&, const VertexInfluence&) = default;
};

/// The displacement of a vertex by a morph target at weight 1.
struct MorphDelta {
    std::uint32_t target = 0;  ///< index into AnimatedMesh::weights
    glm::vec3 delta{0.0F};     ///< in the space of the positions
    friend bool operator==(const MorphDelta&, const MorphDelta&) = default;
};

struct ClipChannel {
    std::uint32_t node = 0;
    NodeMember member = NodeMember::kTranslation;
    KeyCurve curve = KeyCurve::kLinear;
    std::vector<float> times;   ///< seconds, 0 or more, ascending; at least one
    std::vector<float> values;  ///< keyNumbers() per key; three times as many for kCubic
    friend bool operator==(const ClipChannel&, const ClipChannel&) = default;
};

struct MeshClip {
    std::string name;                   ///< clean UTF-8, unique, not empty
    float seconds = 0.0F;               ///< duration, above 0; no key is later
    std::vector<ClipChannel> channels;  ///< at most one for each member of a node
    friend bool operator==(const MeshClip&, const MeshClip&) = default;
};

struct AnimatedMesh {
    std::vector<glm::vec3> positions;   ///< before deformation
    std::vector<glm::uvec3> triangles;  ///< counter-clockwise seen from outside
    /// Vertex i has the influences [influence_begin[i], influence_begin[i + 1]): 1 to kVertexInfluencesMax.
    std::vector<std::uint32_t> influence_begin;
    std::vector<VertexInfluence> influences;
    /// Likewise for deltas; a vertex may have none, and at most one for each target.
    std::vector<std::uint32_t> delta_begin;
    std::vector<MorphDelta> deltas;
    std::vector<MeshNode> nodes;  ///< parents before children; roots are in object space
    std::vector<MeshJoint> joints;
    std::vector<float> weights;  ///< default weights of the morph targets, used if no channel animates them
    std::vector<MeshClip> clips;
    /// Names: clean UTF-8, unique; "" stands for all unnamed materials. Empty if the file has no materials.
    std::vector<std::string> materials;
    /// Index into `materials` for each triangle; empty if `materials` is.
    std::vector<std::uint16_t> triangle_materials;
    friend bool operator==(const AnimatedMesh&, const AnimatedMesh&) = default;
};

/// Returns the number of values in one key of the channel, excluding tangents.
[[nodiscard]] std::size_t keyNumbers(const AnimatedMesh& mesh, const ClipChannel& channel);

/// Checks the invariants above and that every number is finite. Errors: kInvalidInput, kLimit; messages name the
/// member.
[[nodiscard]] Result<void> validate(const AnimatedMesh& mesh);
/// Checks only nodes, weights and clips. A mesh that only supplies clips to other meshes has no vertices.
[[nodiscard]] Result<void> validateClips(const AnimatedMesh& mesh);

/// Encodes the mesh as animated_mesh.fbs, for Collider::animation. \param mesh  valid.
[[nodiscard]] std::vector<std::byte> writeAnimatedMesh(const AnimatedMesh& mesh);

/// Decodes untrusted bytes. Errors: kInvalidInput, kLimit.
[[nodiscard]] Result<AnimatedMesh> readAnimatedMesh(std::span<const std::byte> bytes);
/// Decodes and checks (validateClips()) only nodes, weights and clips; the other members stay empty.
[[nodiscard]] Result<AnimatedMesh> readAnimatedClips(std::span<const std::byte> bytes);

}  // namespace relief
