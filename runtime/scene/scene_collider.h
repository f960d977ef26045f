// The colliders of a scene: files, places, and ways through the world.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "formats/collider.h"
#include "runtime/collider/deformation.h"
#include "runtime/collider/pose_keys.h"

namespace relief {

/// What [collider] says of `mesh` and `deform`; what is left open depends on the mesh.
struct SceneLive {
    Deformation deformation;
    bool has_center = false;      ///< else the middle of the mesh's box
    bool has_range = false;       ///< else the mesh's whole extent along the axis, or along `along`
    bool has_wavelength = false;  ///< else half of the box's longest side
    std::uint32_t resolution = 256;
};

struct SceneCollider {
    std::filesystem::path path;  ///< resolved against the scene's folder
    std::string origin;          ///< "scene.toml:3:8" of that key, for messages; empty without a scene file
    /// Whether anything below was given: else the particles live in the collider's own object space.
    bool posed = false;
    Pose pose;
    float restitution = 1.0F;       ///< factor of the particles' own
    float friction = 0.0F;          ///< on top of the particles' own
    std::optional<SceneLive> live;  ///< deforms: `path` is a mesh, not a container
    std::vector<PoseKey> keys;      ///< by rising time; empty: at rest at `pose`
};

/// Where a collider is; before the first key and after the last it rests.
[[nodiscard]] Pose poseAt(const SceneCollider& collider, double time);

/// The box, along the world's axes, of all places that it comes through.
[[nodiscard]] Bounds worldBounds(const SceneCollider& collider, const Bounds& object);

}  // namespace relief
