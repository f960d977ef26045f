// SPDX-License-Identifier: Apache-2.0
// The meshes that replace colliders in pictures of a scene (render.meshes), and its weather.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "formats/base/result.h"
#include "runtime/picture/mesh_renderer.h"
#include "runtime/scene/loaded_scene.h"

namespace relief {

/// The source of vertices: a file, the collider's clip (ScenePlay), or its waves (SceneLive).
enum class MeshMotion : std::uint8_t { kNone, kPlayed, kLive };

/// An instance of a mesh. A world mesh that was cut into several colliders is drawn once.
struct SceneMesh {
    std::uint32_t mesh = 0;    ///< index in DrawnMeshes::meshes
    std::size_t collider = 0;  ///< index of the scene's collider whose pose it uses
    MeshMotion motion = MeshMotion::kNone;
};

struct DrawnMeshes {
    std::vector<PictureMesh> meshes;
    std::vector<SceneMesh> places;
    std::optional<std::uint32_t> floor;  ///< mesh of the ground
};

/// Returns the files of render.meshes for the colliders of the scene, sorted, without reading them. The file of a world
/// collider has the storedMeshName() of its mesh; the file of any other collider has the name of its container.
/// Colliders that deform or play clips need no file: their own moving mesh is drawn.
/// \param loaded  its scene must set render.meshes.
/// Errors: kInvalidInput (no such file; a link to a file outside the folder; a mesh without a name).
/// Messages start with the place in the scene.
[[nodiscard]] Result<std::vector<std::filesystem::path>> drawnFiles(const LoadedScene& loaded);

/// Returns every file that any run of a scene may read, and that no output may replace: the files that the scene names,
/// all fine and coarse containers of its world, and the existing files of drawnFiles(). Sorted, without the scene.
[[nodiscard]] std::vector<std::filesystem::path> allFilesOf(const LoadedScene& loaded);

/// Reads the drawn files. Errors: those of drawnFiles() and loadPictureMesh().
[[nodiscard]] Result<DrawnMeshes> loadDrawnMeshes(const LoadedScene& loaded);

/// Returns the instances at a time in seconds. Animated instances leave footprints in snow.
[[nodiscard]] std::vector<MeshInstance> meshPlaces(const LoadedScene& loaded, const DrawnMeshes& meshes,
                                                   double seconds);

/// Returns the style at a time in seconds.
[[nodiscard]] MeshStyle meshStyle(const Scene& scene, double seconds);

/// Returns the region with shadows: the whole scene, or the part within render.shadow_distance of camera.target along x
/// and z.
[[nodiscard]] Bounds shadowBounds(const LoadedScene& loaded);

}  // namespace relief
