// SPDX-License-Identifier: Apache-2.0
// The colliders of a scene: files, poses, and trajectories through the world.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "formats/animation/animated_mesh.h"
#include "formats/base/field.h"
#include "formats/base/scene_limits.h"
#include "formats/base/source_place.h"
#include "formats/collider.h"
#include "runtime/bodies/pose_keys.h"
#include "runtime/bodies/world_textures.h"

namespace relief {

/// A pose as written in a table; missing values are nullopt.
struct ScenePose {
    std::optional<glm::vec3> position;
    std::optional<glm::vec3> axis;
    std::optional<float> angle;  ///< degrees
};

void fields(FieldVisitor& visit, ScenePose& pose);

/// [[collider.key]] and [[emitter.key]].
struct SceneKey : ScenePose {
    double time = 0.0;  ///< seconds
};

void fields(FieldVisitor& visit, SceneKey& key);

inline constexpr std::size_t kPoseKeysMax = 1024;
inline constexpr double kClipStartMax = 86'400.0;
inline constexpr double kClipSpeedMax = 1000.0;

/// Fills missing values from `rest`. \return the complete pose.
[[nodiscard]] Pose completePose(ScenePose& pose, const Pose& rest);
/// Returns the complete pose of each key, and fills the key's missing values.
[[nodiscard]] std::vector<PoseKey> completeKeys(std::vector<SceneKey>& keys, const Pose& rest);
/// Checks that there are no keys or at least two, with ascending times.
/// \param instead  what to use instead of a single key, for the message.
[[nodiscard]] std::optional<FieldFault> checkKeys(const std::vector<SceneKey>& keys, const char* instead);

/// collider.deform.
struct SceneLive {
    float amplitude = 0.0F;
    float frequency = 1.0F;
    float phase = 0.0F;  ///< degrees
    std::optional<float> wavelength;
};

void fields(FieldVisitor& visit, SceneLive& live);

/// collider.play.
struct ScenePlay {
    std::string clip;
    float start = 0.0F;
    float speed = 1.0F;
    bool loop = true;
    float bounds_scale = 1.0F;
    std::uint32_t resolution = 512;
    SourcePlace clip_origin{};
    friend bool operator==(const ScenePlay&, const ScenePlay&) = default;
};

void fields(FieldVisitor& visit, ScenePlay& play);

/// [[collider.material]] of an animated mesh.
struct SceneMaterialColor {
    std::string name;
    glm::vec3 color{0.0F};  ///< sRGB
    std::string origin{};   ///< position of the name
};

void fields(FieldVisitor& visit, SceneMaterialColor& material);

struct SceneCollider {
    std::filesystem::path path;  ///< resolved against the scene's folder
    /// Position of the path, for messages: "scene.toml:3:8"; before placeBodies(), that of the node. Empty without a
    /// scene file.
    std::string origin;
    std::string node;  ///< node of the world's body that provides missing values; empty: none
    /// If this is a further tile of a node's mesh: the index of the collider that names the node. The tile moves and
    /// collides like that collider.
    std::optional<std::size_t> tile_of{};
    ScenePose given_pose;
    float scale = 1.0F;
    float restitution = 1.0F;                   ///< multiplied with that of particles
    float friction = 0.0F;                      ///< 1 − friction multiplies that of particles
    std::optional<SceneLive> live;              ///< deforms in waves: `path` is a mesh, not a container
    std::optional<ScenePlay> play;              ///< plays the animated mesh of the container
    std::uint32_t resolution = 256;             ///< for `live`: texels along each side of its maps
    std::optional<glm::vec3> color;             ///< in pictures, sRGB
    std::vector<SceneMaterialColor> materials;  ///< materials with their own colours
    std::vector<SceneKey> given_keys;
    // Filled by check(), or by placeBodies() for bodies of a world. Both also complete given_pose and given_keys.
    /// Whether the table sets a node, position, angle, scale, restitution, friction or keys. If not, and if this is the
    /// only collider and does not deform, particles are in its object space.
    bool posed = false;
    Pose pose;
    std::vector<PoseKey> keys;  ///< ascending times; empty: fixed at `pose`

    /// Whether its maps are redrawn before each step.
    [[nodiscard]] bool deforms() const { return live || play; }
};

void fields(FieldVisitor& visit, SceneCollider& c);
[[nodiscard]] std::optional<FieldFault> check(SceneCollider& collider, const GivenFields& given);

/// Completes the pose and the keys. \param rest  the pose for missing values.
void completePoses(SceneCollider& collider, const Pose& rest);

/// Returns the pose of a collider; constant before the first and after the last key.
[[nodiscard]] Pose poseAt(const SceneCollider& collider, double time);

/// Returns the world-space bounds of a collider over all its keys.
[[nodiscard]] Bounds worldBounds(const SceneCollider& collider, const Bounds& object);

}  // namespace relief
