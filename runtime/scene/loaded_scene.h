// SPDX-License-Identifier: Apache-2.0
// A scene with every file that it names, read and complete.
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
#include "runtime/scene/scene_play.h"
#include "runtime/scene/scene_sweep.h"

namespace relief {

/// Values that replace the scene's own.
struct SceneOverrides {
    std::optional<std::uint32_t> steps;
    std::optional<std::uint32_t> width;  ///< of pictures, pixels, as is the next
    std::optional<std::uint32_t> height;
    std::optional<std::uint64_t> seed;         ///< of every emitter
    std::optional<std::uint32_t> first_frame;  ///< render.first, and so on
    std::optional<std::uint32_t> last_frame;
    std::optional<std::uint32_t> frame_every;
    /// A folder whose files the scene may name beside those of its own; empty: none.
    std::filesystem::path root;
    ContainerLimits limits;  ///< of each collider, and of those of a world together
};

/// A scene and everything it names, read and complete: all that a Simulation plays.
struct LoadedScene {
    Scene scene;  ///< overridden by the options, every default filled in
    World world;  ///< without bodies: the scene has none
    /// Those of the world, coarse ones if the scene streams it.
    std::vector<std::shared_ptr<const Collider>> world_colliders;
    ContainerLimits limits;  ///< of each collider that is read later
    /// Those of the scene, in its order; a file that it names several times, once.
    std::vector<std::shared_ptr<const Collider>> colliders;
    /// As many: the meshes of those that deform, whose colliders have maps without texels.
    std::vector<std::optional<LiveMesh>> live;
    /// As many: of those that play a clip, whose colliders have maps without texels, too.
    std::vector<std::optional<PlayedMesh>> played;
    Bounds bounds;                  ///< of what they occupy in the course of time, in the particles' space
    std::vector<Emitter> emitters;  ///< those of the scene, which have given no birth yet
    SceneSweep sweep;
    std::vector<std::string>
        warnings;  ///< of settings that are valid but probably errors: those of the sweep

    [[nodiscard]] SceneMeshes meshes() const { return {scene.colliders, colliders, live, played}; }
};

/// Whether every material that a scene names is one of the colliders of a scene that is loaded.
/// Errors: kInvalidInput, with the place in the scene and the names that there are.
[[nodiscard]] Result<void> checkMaterials(const Scene& scene, const LoadedScene& of);

/// Bodies that may overlap at one place: a particle there is tested against each of them.
inline constexpr std::size_t kOverlapMax = 1024;

/// Whether no more bodies than that have their boxes around the centre of one body, as they stand at first. Tries 64 of the
/// bodies. A collider that has no insideBox() is everywhere.
/// Errors: kLimit, with the number and the place.
[[nodiscard]] Result<void> checkOverlap(const LoadedScene& loaded);

/// Every file that a scene names, sorted; without the scene itself.
[[nodiscard]] std::vector<std::filesystem::path> filesOf(const Scene& scene);

/// Reads a scene (.toml), or a collider (.relief) or a world (.json), for which the default scene is made, and every file
/// that it names. Needs no context.
/// Fails as the readers of these files and makeEmitters() do; errors of files that a scene names begin with its line and column.
[[nodiscard]] Result<LoadedScene> loadAll(const std::filesystem::path& input,
                                          const SceneOverrides& overrides);
/// The same of a scene that has been read. \param input  names it in messages.
[[nodiscard]] Result<LoadedScene> loadAll(Scene scene, const std::filesystem::path& input,
                                          const SceneOverrides& overrides);

}  // namespace relief
