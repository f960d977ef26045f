// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_meshes.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "formats/animation/mesh_parts.h"
#include "formats/base/file_io.h"
#include "formats/config/confined_path.h"
#include "formats/validate.h"
#include "runtime/files/mesh_file.h"
#include "runtime/scene/scene_world.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::uint8_t, 4> kFloorColor{148, 150, 146, 255};  // sRGB

Result<fs::path> fileOf(const fs::path& folder, const std::string& mesh) {
    if (mesh.empty()) {
        return invalidInput("a mesh of the world has no name; name it in the level");
    }
    const std::string name = storedMeshName(mesh);
    for (const char* extension : {".ply", ".obj"}) {
        const fs::path file = folder / (name + extension);
        std::error_code error;
        if (fs::is_regular_file(file, error)) {
            return resolveInside(folder, name + extension)
                       ? Result<fs::path>(file)
                       : invalidInput(quotedPath(file) +
                                      " is a link to a file outside its folder; replace it with the file");
        }
    }
    return invalidInput(quotedPath(folder) + " has no mesh '" + name + ".ply' or '" + name +
                        ".obj' for a collider; add one");
}

/// Returns the place of render.meshes, for messages.
std::string originOf(const Scene& scene) {
    return scene.render.meshes_origin + ": render.meshes";
}

/// Returns the drawn file of each collider; empty if there is none.
std::vector<Result<fs::path>> findFiles(const LoadedScene& loaded) {
    const Scene& scene = loaded.scene;
    std::map<fs::path, std::string> of_world;  // mesh name of each container
    for (const WorldCollider& collider : loaded.world.colliders) {
        of_world[containerOf(scene, collider)] = collider.mesh;
    }
    std::vector<Result<fs::path>> files(scene.colliders.size());
    for (std::size_t i = 0; i < files.size(); ++i) {
        const SceneCollider& collider = scene.colliders[i];
        if (collider.tile_of || loaded.played[i] || loaded.live[i]) {
            continue;
        }
        const auto named = of_world.find(collider.path);
        const std::string name = named != of_world.end() ? named->second : collider.path.stem().string();
        files[i] = withPrefix(originOf(scene), fileOf(scene.render.meshes, name));
    }
    return files;
}

Result<std::vector<fs::path>> fileOfEach(const LoadedScene& loaded) {
    std::vector<fs::path> files;
    for (Result<fs::path>& file : findFiles(loaded)) {
        files.push_back(RELIEF_TRY(std::move(file)));
    }
    return files;
}

/// Returns the files sorted, without duplicates and empty paths.
std::vector<fs::path> sorted(std::vector<fs::path> files) {
    std::sort(files.begin(), files.end());
    files.erase(std::unique(files.begin(), files.end()), files.end());
    files.erase(std::remove(files.begin(), files.end(), fs::path()), files.end());
    return files;
}

std::array<std::uint8_t, 4> vertexColor(const glm::vec3& color) {
    const glm::vec3 bytes = glm::round(255.0F * color);
    return {static_cast<std::uint8_t>(bytes.r), static_cast<std::uint8_t>(bytes.g),
            static_cast<std::uint8_t>(bytes.b), 255};
}

/// Gives a mesh without colours the colour of its collider, if any.
PictureMesh colored(PictureMesh mesh, const SceneCollider& collider) {
    if (mesh.colors.empty() && collider.color) {
        mesh.colors.assign(mesh.positions.size(), vertexColor(*collider.color));
    }
    return mesh;
}

/// Returns a square around the scene, 100 times its size.
PictureMesh floorMesh(const LoadedScene& loaded) {
    const glm::vec3 center = loaded.bounds.center();
    const float half = 50.0F * std::max(loaded.bounds.longestSide(), 1e-3F);
    const float y = *loaded.scene.ground.height;
    PictureMesh mesh;
    mesh.positions = {{center.x - half, y, center.z - half},
                      {center.x + half, y, center.z - half},
                      {center.x + half, y, center.z + half},
                      {center.x - half, y, center.z + half}};
    mesh.triangles = {0, 2, 1, 0, 3, 2};
    mesh.colors.assign(4, kFloorColor);
    return mesh;
}

/// Returns the mesh with the colours of its materials; other triangles have the colour of the collider.
Result<PictureMesh> animatedMesh(const PlayedMesh& played, const SceneCollider& collider) {
    PictureMesh mesh;
    mesh.positions = posed(*played.mesh, played.poseAt(0.0));
    for (const glm::uvec3& triangle : played.mesh->triangles) {
        mesh.triangles.insert(mesh.triangles.end(), {triangle.x, triangle.y, triangle.z});
    }
    if (!collider.materials.empty()) {
        mesh.colors.assign(mesh.positions.size(), vertexColor(collider.color.value_or(MeshStyle().clay)));
    }
    for (const SceneMaterialColor& material : collider.materials) {
        const std::vector<glm::uvec3> triangles = RELIEF_TRY(materialTriangles(*played.mesh, material.name));
        for (const glm::uvec3& triangle : triangles) {
            for (int i = 0; i < 3; ++i) {
                mesh.colors[triangle[i]] = vertexColor(material.color);
            }
        }
    }
    return mesh;
}

}  // namespace

Result<std::vector<fs::path>> drawnFiles(const LoadedScene& loaded) {
    return sorted(RELIEF_TRY(fileOfEach(loaded)));
}

std::vector<fs::path> allFilesOf(const LoadedScene& loaded) {
    std::vector<fs::path> files = filesOf(loaded.scene);
    for (const WorldCollider& collider : loaded.world.colliders) {
        files.push_back(containerOf(loaded.scene, collider));
        if (collider.coarse) {
            files.push_back(containerOf(loaded.scene, *collider.coarse));
        }
    }
    if (!loaded.scene.render.meshes.empty()) {
        for (const Result<fs::path>& file : findFiles(loaded)) {
            files.push_back(file.value_or(fs::path()));
        }
    }
    return sorted(std::move(files));
}

Result<DrawnMeshes> loadDrawnMeshes(const LoadedScene& loaded) {
    const Scene& scene = loaded.scene;
    const std::vector<fs::path> files = RELIEF_TRY(fileOfEach(loaded));
    DrawnMeshes out;
    std::map<std::pair<fs::path, std::vector<float>>, std::uint32_t> known;  // by file and colour
    // A world mesh that was cut into tiles appears as several colliders with the same pose.
    std::map<std::tuple<std::string, std::uint32_t>, std::vector<Pose>> drawn;
    for (std::size_t i = 0; i < scene.colliders.size(); ++i) {
        const SceneCollider& collider = scene.colliders[i];
        if (collider.tile_of) {
            continue;
        }
        if (loaded.played[i] || loaded.live[i]) {
            const MeshMotion motion = loaded.played[i] ? MeshMotion::kPlayed : MeshMotion::kLive;
            out.places.push_back({static_cast<std::uint32_t>(out.meshes.size()), i, motion});
            PictureMesh mesh = loaded.played[i] ? RELIEF_TRY(animatedMesh(*loaded.played[i], collider))
                                                : loaded.live[i]->mesh;
            out.meshes.push_back(colored(std::move(mesh), collider));
            continue;
        }
        const fs::path& file = files[i];
        std::vector<float> color;
        if (collider.color) {
            color = {collider.color->r, collider.color->g, collider.color->b};
        }
        const auto [entry, is_new] =
            known.try_emplace({file, color}, static_cast<std::uint32_t>(out.meshes.size()));
        if (is_new) {
            out.meshes.push_back(
                colored(RELIEF_TRY(withPrefix(originOf(scene), loadPictureMesh(file))), collider));
        }
        if (collider.keys.empty()) {
            std::vector<Pose>& there = drawn[{collider.node, entry->second}];
            if (std::find(there.begin(), there.end(), collider.pose) != there.end()) {
                continue;
            }
            there.push_back(collider.pose);
        }
        out.places.push_back({entry->second, i, MeshMotion::kNone});
    }
    if (scene.ground.enabled) {
        out.floor = static_cast<std::uint32_t>(out.meshes.size());
        out.meshes.push_back(floorMesh(loaded));
    }
    return out;
}

std::vector<MeshInstance> meshPlaces(const LoadedScene& loaded, const DrawnMeshes& meshes, double seconds) {
    std::vector<MeshInstance> places;
    for (const SceneMesh& mesh : meshes.places) {
        places.push_back({mesh.mesh, poseAt(loaded.scene.colliders[mesh.collider], seconds),
                          mesh.motion == MeshMotion::kPlayed});
    }
    if (meshes.floor) {
        places.push_back({*meshes.floor, {}, false});
    }
    return places;
}

MeshStyle meshStyle(const Scene& scene, double seconds) {
    MeshStyle style;
    style.background = scene.render.background;
    style.fog_distance = scene.render.fog_distance;
    style.units_per_meter = scene.render.units_per_meter;
    const std::vector<SceneWeather>& keys = scene.render.weather;
    if (keys.empty()) {
        return style;
    }
    const auto after =
        std::find_if(keys.begin(), keys.end(), [&](const SceneWeather& key) { return key.time > seconds; });
    const SceneWeather& from = after == keys.begin() ? *after : *(after - 1);
    const SceneWeather& to = after == keys.end() ? keys.back() : *after;
    const double fraction =
        to.time > from.time ? std::clamp((seconds - from.time) / (to.time - from.time), 0.0, 1.0) : 0.0;
    const auto between = [&](float a, float b) { return a + static_cast<float>(fraction) * (b - a); };
    style.sun = between(from.sun, to.sun);
    style.wet = between(from.wet, to.wet);
    style.snow = between(from.snow, to.snow);
    return style;
}

Bounds shadowBounds(const LoadedScene& loaded) {
    Bounds around = loaded.bounds;
    if (loaded.scene.ground.enabled) {
        around.min.y = std::min(around.min.y, *loaded.scene.ground.height);
        // Include shadows on the floor beside the colliders.
        const float height = around.max.y - around.min.y;
        around.min -= glm::vec3(height, 0.0F, height);
        around.max += glm::vec3(height, 0.0F, height);
    }
    if (loaded.scene.render.shadow_distance) {
        const float reach = *loaded.scene.render.shadow_distance;
        const glm::vec3 target = *loaded.scene.camera.target;
        for (const int i : {0, 2}) {
            around.min[i] = std::max(around.min[i], target[i] - reach);
            around.max[i] = std::min(around.max[i], target[i] + reach);
        }
    }
    return around;
}

}  // namespace relief
