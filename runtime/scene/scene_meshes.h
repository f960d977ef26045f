// The meshes that stand for a scene's colliders in its pictures, and the weather that they stand in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "formats/base/result.h"
#include "runtime/picture/mesh_renderer.h"
#include "runtime/scene/loaded_scene.h"

namespace relief {

/// One of them: of a world's mesh, which may be several colliders, it is drawn once.
struct SceneMesh {
    std::uint32_t mesh = 0;    ///< of SceneMeshes::meshes
    std::size_t collider = 0;  ///< of the scene, whose pose it has
    bool posed = false;        ///< its vertices are those of the clip that the collider plays
};

struct SceneMeshes {
    std::vector<PictureMesh> meshes;
    std::vector<std::filesystem::path> files;  ///< that were read, sorted
    std::vector<SceneMesh> places;
};

/// Reads render.meshes. That of a world's collider has the name of its mesh there, that of another one the name of its
/// container; of one that plays a clip it is the container's own.
/// \param loaded  with render.meshes.
/// Errors: kInvalidInput (no such file; a name that leaves the folder), and as loadPictureMesh() fails; messages begin with the
/// place in the scene.
[[nodiscard]] Result<SceneMeshes> loadSceneMeshes(const LoadedScene& loaded);

/// Where they are after so many seconds. Those that play a clip press the snow.
[[nodiscard]] std::vector<MeshPlace> meshPlaces(const LoadedScene& loaded, const SceneMeshes& meshes,
                                                double seconds);

/// The style of their picture after so many seconds.
[[nodiscard]] MeshStyle meshStyle(const Scene& scene, double seconds);

/// The part of the world that has shadows: all of it, or what is within render.shadows of camera.target, along x and z.
[[nodiscard]] Bounds shadowBounds(const LoadedScene& loaded);

}  // namespace relief
