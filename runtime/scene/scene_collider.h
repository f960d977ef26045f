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
#include "formats/collider.h"
#include "runtime/bodies/pose_keys.h"
#include "runtime/bodies/world_textures.h"

namespace relief {

/// A pose as a table gives it.
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

/// Completes what the table leaves open from `rest`. \return it as a pose.
[[nodiscard]] Pose completePose(ScenePose& pose, const Pose& rest);
/// The same of each key.
[[nodiscard]] std::vector<PoseKey> completeKeys(std::vector<SceneKey>& keys, const Pose& rest);
/// One key alone moves nothing, and times rise.
/// \param instead  of a single key, in words.
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
    bool repeat = true;
    float room = 1.0F;
    std::uint32_t resolution = 512;
    friend bool operator==(const ScenePlay&, const ScenePlay&) = default;
};

void fields(FieldVisitor& visit, ScenePlay& play);

/// [[collider.material]]: of an animated mesh.
struct SceneMaterialColor {
    std::string name;
    glm::vec3 color{0.0F};  ///< sRGB
};

void fields(FieldVisitor& visit, SceneMaterialColor& material);

struct SceneCollider {
    std::filesystem::path path;  ///< resolved against the scene's folder
    std::string origin;          ///< "scene.toml:3:8" of that key, for messages; empty without a scene file
    std::string node;            ///< of a body of the scene's world, which completes the rest; empty: none
    /// The number of the collider that named its node, of whose mesh it is another tile: it moves and is met as that one.
    std::optional<std::size_t> tile_of{};
    ScenePose given_pose;
    float scale = 1.0F;
    float restitution = 1.0F;                   ///< factor of the particles' own
    float friction = 0.0F;                      ///< on top of the particles' own
    std::optional<SceneLive> live;              ///< wobbles: `path` is a mesh, not a container
    std::optional<ScenePlay> play;              ///< an animated mesh of the container moves
    std::uint32_t resolution = 256;             ///< of its maps
    std::optional<glm::vec3> color;             ///< of its picture, sRGB
    std::vector<SceneMaterialColor> materials;  ///< that have colours of their own
    std::vector<SceneKey> given_keys;
    // Filled by check() (of a body by placeBodies()), which also completes the pose and the keys above:
    /// Any key of the table but its file is given: else the particles live in the collider's own object space.
    bool posed = false;
    Pose pose;
    std::vector<PoseKey> keys;  ///< by rising time; empty: at rest at `pose`

    /// Its maps are drawn before each step.
    [[nodiscard]] bool deforms() const { return live || play; }
};

void fields(FieldVisitor& visit, SceneCollider& c);
[[nodiscard]] std::optional<FieldFault> check(SceneCollider& collider, const GivenFields& given);

/// Completes the pose and the keys. \param rest  where it is without a pose of its own.
void completePoses(SceneCollider& collider, const Pose& rest);

/// The pose of a collider; before the first key and after the last it rests.
[[nodiscard]] Pose poseAt(const SceneCollider& collider, double time);

/// The box, along the world's axes, of all places that it passes through.
[[nodiscard]] Bounds worldBounds(const SceneCollider& collider, const Bounds& object);

}  // namespace relief
