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
#include "runtime/collider/collider_textures.h"
#include "runtime/collider/pose_keys.h"

namespace relief {

/// A pose as a table gives it.
struct ScenePose {
    std::optional<glm::vec3> position;
    std::optional<glm::vec3> axis;
    std::optional<float> angle;  ///< degrees
};

template <class Visitor, FieldsOf<ScenePose> P>
void fields(Visitor& visit, P& pose) {
    visit(
        "position", pose.position,
        leftOut({"Place of the origin", "[x, y, z]", kPointRange, "[0, 0, 0]; of a key that of its table"}));
    visit("axis", pose.axis,
          leftOut({"Axis of rotation, of any length",
                   "[x, y, z]",
                   kPointRange,
                   "[0, 1, 0]",
                   {.needs = "angle", .unit_length = true}}));
    visit("angle", pose.angle,
          leftOut({"Rotation about the axis, right-handed", "degrees", within(kAngleMax),
                   "0; of a key that of its table"}));
}

/// [[collider.key]] and [[emitter.key]].
struct SceneKey : ScenePose {
    double time = 0.0;  ///< seconds
};

template <class Visitor, FieldsOf<SceneKey> K>
void fields(Visitor& visit, K& key) {
    visit("time", key.time, {"Time since the beginning, rising", "s", {0.0, kKeySecondsMax}, {}, kRequired});
    fields(visit, baseOf<ScenePose>(key));
}

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

template <class Visitor, FieldsOf<SceneLive> L>
void fields(Visitor& visit, L& live) {
    visit("amplitude", live.amplitude, {"Height of the waves", "object units", kPointRange, {}, kRequired});
    visit("frequency", live.frequency, {"Oscillations a second", "1/s", {0.0, 1000.0}, {}, kRequired});
    visit("phase", live.phase, {"Phase at time 0", "degrees", within(kAngleMax)});
    visit("wavelength", live.wavelength,
          leftOut({"Length of the waves", "object units", kSizeRange, "half the longest side"}));
}

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

template <class Visitor, FieldsOf<ScenePlay> P>
void fields(Visitor& visit, P& play) {
    visit("clip", play.clip,
          leftOut({"Name of a clip of the container, baked with --animated", {}, {}, "its first"}));
    visit("start", play.start, {"Place in the clip at time 0", "s", within(kClipStartMax)});
    visit("speed", play.speed,
          {"Seconds of the clip a second; below 0 it runs backwards", "1", within(kClipSpeedMax)});
    visit("repeat", play.repeat, {"The clip begins again where it ends"});
    visit("room", play.room,
          {"Factor of the space that its clips take up, for poses of a program", {}, {1.0, 100.0}});
    visit("resolution", play.resolution, {"Texels of its maps along its longest side", {}, {16.0, 4096.0}});
}

/// [[collider.material]]: of an animated mesh.
struct SceneMaterialColor {
    std::string name;
    glm::vec3 color{0.0F};  ///< sRGB
};

template <class Visitor, FieldsOf<SceneMaterialColor> M>
void fields(Visitor& visit, M& material) {
    visit("name", material.name,
          {"Name of a material of the animated mesh, as in relief info", {}, {}, {}, kRequired});
    visit("color", material.color, {"Its colour in pictures", "[r, g, b]", kShareRange, {}, kRequired});
}

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

template <class Visitor, FieldsOf<SceneCollider> C>
void fields(Visitor& visit, C& c) {
    const FieldFile path{c.path, c.origin};
    bool live = c.live.has_value();
    bool baked = !live;
    visit("file", FieldMaybe{path, baked},
          leftOut({"The .relief file to collide with", {}, {}, "required, or mesh"}));
    visit(
        "mesh", FieldMaybe{path, live},
        leftOut(
            {"An .obj or .ply file that deforms; it is not baked", {}, {}, "none", {.instead_of = "file"}}));
    visit("node", c.node,
          leftOut({"Name of a node of the scene's world, to place or move it; needs world",
                   {},
                   {},
                   "none",
                   {.instead_of = "file mesh"}}));
    visit("deform", c.live, leftOut({"How the mesh wobbles", {}, {}, "required by mesh", {.needs = "mesh"}}));
    visit(
        "resolution", c.resolution,
        leftOut(
            {"Texels along a side of the deforming mesh's maps", {}, {16.0, 4096.0}, {}, {.needs = "mesh"}}));
    visit("play", c.play,
          leftOut({"How the container's animated mesh moves", {}, {}, "not at all", {.needs = "file"}}));
    fields(visit, c.given_pose);
    visit("scale", FieldMaybe{c.scale, c.posed}, leftOut({"World units of an object unit", {}, {1e-6, 1e6}}));
    visit("restitution", FieldMaybe{c.restitution, c.posed},
          leftOut({"Factor of the particles' own", {}, {0.0, 1.0}}));
    visit("friction", FieldMaybe{c.friction, c.posed},
          leftOut({"1 − friction is a factor of the particles' own 1 − friction", {}, {0.0, 1.0}}));
    visit("color", c.color,
          leftOut({"Colour in pictures; of a mesh without colours of its own. Where maps are drawn, that of "
                   "the first "
                   "collider is all colliders'",
                   "[r, g, b]",
                   {0.0, 1.0},
                   "clay"}));
    visit("material", c.materials,
          leftOut({"Colours of materials of an animated mesh",
                   {},
                   {},
                   {},
                   {.needs = "play", .most = kMeshMaterialsMax}}));
    visit("key", c.given_keys, leftOut({"Poses at times, two or more", {}, {}, {}, {.most = kPoseKeysMax}}));
}
[[nodiscard]] std::optional<FieldFault> check(SceneCollider& collider, const GivenFields& given);

/// Completes the pose and the keys. \param rest  where it is without a pose of its own.
void completePoses(SceneCollider& collider, const Pose& rest);

/// The pose of a collider; before the first key and after the last it rests.
[[nodiscard]] Pose poseAt(const SceneCollider& collider, double time);

/// The box, along the world's axes, of all places that it passes through.
[[nodiscard]] Bounds worldBounds(const SceneCollider& collider, const Bounds& object);

}  // namespace relief
