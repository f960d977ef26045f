// SPDX-License-Identifier: Apache-2.0
// Loads a scene with every file that it names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/container_limits.h"
#include "formats/world/world.h"
#include "runtime/scene/scene.h"
#include "runtime/scene/scene_births.h"
#include "runtime/scene/scene_live.h"
#include "runtime/scene/scene_sweep.h"

namespace relief {

/// Values that override those of the scene.
struct SceneOverrides {
    std::optional<std::uint32_t> steps;
    std::optional<std::uint32_t> width;            ///< of pictures, pixels
    std::optional<std::uint32_t> height;           ///< of pictures, pixels
    std::optional<std::uint64_t> seed;             ///< of every emitter
    std::optional<std::uint32_t> first_frame;      ///< render.first_frame
    std::optional<std::uint32_t> last_frame;       ///< render.last_frame
    std::optional<std::uint32_t> steps_per_frame;  ///< render.steps_per_frame
    /// A folder whose files the scene may name, besides its own folder; empty: none.
    std::filesystem::path root;
    ContainerLimits limits;  ///< per collider, and for all colliders of a world together
};

/// A complete scene with all its data: the input of a Simulation.
struct LoadedScene {
    Scene scene;  ///< with overrides and all defaults
    World world;  ///< without bodies if the scene has no world
    /// Colliders of the world, in its order; coarse colliders if the scene has a [stream].
    std::vector<std::shared_ptr<const Collider>> world_colliders;
    ContainerLimits limits;  ///< for colliders that are read later
    /// Colliders of the scene, in its order. Entries of the same file share one Collider, except colliders that deform
    /// or play clips; with a [stream], a [[collider]] with a file does not share a Collider with the world.
    std::vector<std::shared_ptr<const Collider>> colliders;
    /// Per collider: its mesh if it deforms; its entry in `colliders` then has maps without texels.
    std::vector<std::optional<LiveMesh>> live;
    /// Per collider: its clip if it is animated; its entry in `colliders` then has maps without texels.
    std::vector<std::optional<PlayedMesh>> played;
    Bounds bounds;                  ///< of all colliders at all times, in the space of the particles
    std::vector<Emitter> emitters;  ///< emitters of the scene before their first birth
    SceneSweep sweep;
    std::vector<std::string> warnings;  ///< valid but probably unintended settings, from SceneSweep

    [[nodiscard]] SceneMeshes meshes() const { return {scene.colliders, colliders, live, played}; }
};

/// Checks that the loaded colliders have every material that a scene names.
/// Errors: kInvalidInput, with the place in the scene and the available names.
[[nodiscard]] Result<void> checkMaterials(const Scene& scene, const LoadedScene& of);

/// Maximum number of bodies that may overlap at a place; a particle is tested against each of them.
inline constexpr std::size_t kOverlapMax = 1024;

/// Checks that at most kOverlapMax bodies overlap at the centres of 64 sampled bodies, in their initial poses. A body
/// overlaps a centre that is in its insideBox(), and every centre if insideBox() returns nullopt.
/// Errors: kLimit, with the number of bodies and the centre.
[[nodiscard]] Result<void> checkOverlap(const LoadedScene& loaded);

/// Returns every file that a scene names, sorted, without the scene itself.
[[nodiscard]] std::vector<std::filesystem::path> filesOf(const Scene& scene);

/// Reads a scene (.toml) and every file that it names, or a collider (.relief) or world (.json), which gets the default
/// scene. Needs no context.
/// Errors: those of the readers and of makeEmitters(). Errors of files that a scene names start with the line and
/// column in the scene.
[[nodiscard]] Result<LoadedScene> loadAll(const std::filesystem::path& input,
                                          const SceneOverrides& overrides);
/// Loads the files of a parsed scene. \param input  name of the scene in messages.
[[nodiscard]] Result<LoadedScene> loadAll(Scene scene, const std::filesystem::path& input,
                                          const SceneOverrides& overrides);

}  // namespace relief
