// SPDX-License-Identifier: Apache-2.0
// A mesh that moves as glTF has it: nodes in trees, vertices that joints and morph targets move, and clips of keys. Data
// alone; mesh_pose.h poses it.
//
//     clip ── keys ──▶ nodes' transforms, weights of targets          (MeshPose)
//                          │                   │
//     position + Σ weight · delta  ──▶  Σ weight · joint · that        glTF 2.0, 3.7.2.2 and 3.7.3.1
//
// Nodes that place a mesh without a skin are joints as well, of weight 1, so that machines move as characters do.
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
inline constexpr std::size_t kAnimatedNameMax = 255;  ///< bytes, of nodes, clips and materials
inline constexpr std::size_t kAnimatedVerticesMax = 1'000'000;
inline constexpr std::size_t kVertexInfluencesMax = 16;
inline constexpr float kClipSecondsMax = 86'400.0F;

/// How a value goes from key to key (glTF 2.0, appendix C).
enum class KeyCurve : std::uint8_t {
    kStep = 0,
    kLinear = 1,  ///< of rotations the shorter way on the sphere
    kCubic = 2    ///< Hermite; each key has the tangent that arrives, the value, and the tangent that leaves
};

/// The member of a node that a channel moves.
enum class NodeMember : std::uint8_t { kTranslation = 0, kRotation = 1, kScale = 2, kWeights = 3 };

struct MeshNode {
    std::string name;                            ///< clean UTF-8; may be empty, and that of other nodes too
    std::int32_t parent = -1;                    ///< below the node's own index; -1: none
    glm::vec3 translation{0.0F};                 ///< object units
    glm::vec4 rotation{0.0F, 0.0F, 0.0F, 1.0F};  ///< unit quaternion x, y, z, w
    glm::vec3 scale{1.0F};
    std::optional<Affine> matrix{};  ///< in place of these three; no channel moves such a node
    std::uint32_t first_weight = 0;  ///< of AnimatedMesh::weights: those of the node's mesh
    std::uint32_t weights = 0;
    friend bool operator==(const MeshNode&, const MeshNode&) = default;
};

struct MeshJoint {
    std::uint32_t node = 0;
    Affine bind;  ///< from the space of the positions to the node's (inverseBindMatrices)
    friend bool operator==(const MeshJoint&, const MeshJoint&) = default;
};

/// A joint that moves a vertex.
struct VertexInfluence {
    std::uint32_t joint = 0;
    float weight = 1.0F;  ///< above 0; those of a vertex have the sum 1
    friend bool operator==(const VertexInfluence&, const VertexInfluence&) = default;
};

/// How far a target of weight 1 moves a vertex.
struct MorphDelta {
    std::uint32_t target = 0;  ///< of AnimatedMesh::weights
    glm::vec3 delta{0.0F};     ///< in the space of the positions
    friend bool operator==(const MorphDelta&, const MorphDelta&) = default;
};

struct ClipChannel {
    std::uint32_t node = 0;
    NodeMember member = NodeMember::kTranslation;
    KeyCurve curve = KeyCurve::kLinear;
    std::vector<float> times;  ///< seconds, 0 or more, rising; at least one
    std::vector<float>
        values;  ///< 3 or 4 a key, or as many as the node has weights; thrice as many where cubic
    friend bool operator==(const ClipChannel&, const ClipChannel&) = default;
};

struct MeshClip {
    std::string name;                   ///< clean UTF-8, not that of another clip, not empty
    float seconds = 0.0F;               ///< no key is later; above 0
    std::vector<ClipChannel> channels;  ///< no two of the same member of a node
    friend bool operator==(const MeshClip&, const MeshClip&) = default;
};

struct AnimatedMesh {
    std::vector<glm::vec3> positions;   ///< before any joint moves them
    std::vector<glm::uvec3> triangles;  ///< anticlockwise seen from outside
    /// Those of vertex i: influence_begin[i] up to influence_begin[i + 1]; 1 to kVertexInfluencesMax of them.
    std::vector<std::uint32_t> influence_begin;
    std::vector<VertexInfluence> influences;
    /// The same of targets; a vertex that none moves has none. No target twice.
    std::vector<std::uint32_t> delta_begin;
    std::vector<MorphDelta> deltas;
    std::vector<MeshNode> nodes;  ///< parents before their children; roots are in object space
    std::vector<MeshJoint> joints;
    std::vector<float> weights;  ///< of the morph targets, where no channel says otherwise
    std::vector<MeshClip> clips;
    /// Names: clean UTF-8, no two alike; "" is that of all that have no name. Empty: the file names none.
    std::vector<std::string> materials;
    std::vector<std::uint16_t> triangle_materials;  ///< of each triangle, of `materials`; empty without these
    friend bool operator==(const AnimatedMesh&, const AnimatedMesh&) = default;
};

/// How many numbers a key of the channel has, tangents not counted.
[[nodiscard]] std::size_t keyNumbers(const AnimatedMesh& mesh, const ClipChannel& channel);

/// All that is said above, and that every number is finite. Errors: kInvalidInput, kLimit; a message names the member.
[[nodiscard]] Result<void> validate(const AnimatedMesh& mesh);
/// The same of nodes, weights and clips alone: a mesh for others to take its clips from has no vertices.
[[nodiscard]] Result<void> validateClips(const AnimatedMesh& mesh);

/// The bytes of Collider::animation, by animated_mesh.fbs. \param mesh  valid.
[[nodiscard]] std::vector<std::byte> writeAnimatedMesh(const AnimatedMesh& mesh);

/// Reads untrusted bytes. Errors: kInvalidInput, kLimit.
[[nodiscard]] Result<AnimatedMesh> readAnimatedMesh(std::span<const std::byte> bytes);
/// Reads nodes, weights and clips, as validateClips() wants them, and leaves all else empty.
[[nodiscard]] Result<AnimatedMesh> readAnimatedClips(std::span<const std::byte> bytes);

}  // namespace relief
