// SPDX-License-Identifier: Apache-2.0
// The meshes that stand for a scene's colliders in its pictures, and the weather that they stand in.
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

/// The origin of a mesh's vertices: a file, the clip that its collider plays, or the waves that deform it.
enum class MeshMotion : std::uint8_t { kNone, kPlayed, kLive };

/// One of them: of a world's mesh, which may be several colliders, it is drawn once.
struct SceneMesh {
    std::uint32_t mesh = 0;    ///< of DrawnMeshes::meshes
    std::size_t collider = 0;  ///< of the scene, whose pose it has
    MeshMotion motion = MeshMotion::kNone;
};

struct DrawnMeshes {
    std::vector<PictureMesh> meshes;
    std::vector<SceneMesh> places;
    std::optional<std::uint32_t> floor;  ///< that of the scene's ground
};

/// The files of render.meshes that the scene's colliders are drawn from, sorted; none is read. That of a world's collider has the storedMeshName of its mesh, that of another one the name of its
/// container; of one that plays a clip it is the container's own.
/// \param loaded  with render.meshes.
/// Errors: kInvalidInput (no such file, or a link out of the folder; a mesh without a name); messages begin with the place in the scene.
[[nodiscard]] Result<std::vector<std::filesystem::path>> drawnFiles(const LoadedScene& loaded);

/// Every file that a scene may read, whatever a run of it reads: those that it names, the containers of its world, fine
/// and coarse, and those of drawnFiles() that are there. No output may replace one. Sorted; without the scene itself.
[[nodiscard]] std::vector<std::filesystem::path> allFilesOf(const LoadedScene& loaded);

/// Reads the drawn files. Fails as drawnFiles() and loadPictureMesh() do.
[[nodiscard]] Result<DrawnMeshes> loadDrawnMeshes(const LoadedScene& loaded);

/// Their places after so many seconds. Those that play a clip press the snow.
[[nodiscard]] std::vector<MeshPlace> meshPlaces(const LoadedScene& loaded, const DrawnMeshes& meshes,
                                                double seconds);

/// The style of their picture after so many seconds.
[[nodiscard]] MeshStyle meshStyle(const Scene& scene, double seconds);

/// The part of the world that has shadows: all of it, or what is within render.shadows of camera.target, along x and z.
[[nodiscard]] Bounds shadowBounds(const LoadedScene& loaded);

}  // namespace relief
