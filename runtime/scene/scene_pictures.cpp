// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_pictures.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "formats/base/file_io.h"
#include "runtime/files/mesh_file.h"
#include "runtime/files/png.h"
#include "runtime/picture/camera_path.h"

namespace relief {
namespace {

constexpr std::uint64_t kAtlasBytesMax = std::uint64_t{256} << 20;

std::string atlasOrigin(const Scene& scene) {
    return scene.render.atlas_origin + ": render.atlas";
}

std::string meshOrigin(const Scene& scene) {
    return scene.render.mesh_origin + ": render.mesh";
}

Result<RgbaPicture> readAtlas(const Scene& scene) {
    const auto& render = scene.render;
    const std::string origin = atlasOrigin(scene);
    const auto bytes = RELIEF_TRY(withPrefix(origin, readFile(render.atlas, kAtlasBytesMax)));
    return withPrefix(origin, decodePng(bytes, quotedPath(render.atlas)));
}

Result<PictureMesh> readMesh(const Scene& scene, const Bounds& bounds) {
    const auto& render = scene.render;
    auto mesh = RELIEF_TRY(withPrefix(meshOrigin(scene), loadPictureMesh(render.mesh)));
    Bounds box;
    for (const std::uint32_t v : mesh.triangles) {
        box.add(mesh.positions[v]);
    }
    if (!box.meets(bounds)) {
        return invalidInput(meshOrigin(scene) + ": " + quotedPath(render.mesh) +
                            " does not overlap the collider; use the source mesh of the collider");
    }
    return mesh;
}

}  // namespace

Result<void> checkPictures(const Scene& scene, const Bounds& bounds) {
    if (!scene.render.atlas.empty()) {
        RELIEF_TRY(readAtlas(scene));
    }
    if (!scene.render.mesh.empty()) {
        RELIEF_TRY(readMesh(scene, bounds));
    }
    return {};
}

Result<std::unique_ptr<SpriteAtlas>> loadAtlas(const Scene& scene) {
    const auto& render = scene.render;
    if (render.atlas.empty()) {
        return nullptr;
    }
    const auto picture = RELIEF_TRY(readAtlas(scene));
    auto atlas =
        withPrefix(atlasOrigin(scene), SpriteAtlas::create(picture.rgba, picture.width, picture.height,
                                                           render.atlas_columns, render.atlas_rows));
    if (!atlas && atlas.error().code == ErrorCode::kUsage) {
        atlas.error().code = ErrorCode::kInvalidInput;  // the picture does not match the scene
    }
    return std::make_unique<SpriteAtlas>(RELIEF_TRY(std::move(atlas)));
}

Result<std::unique_ptr<ColliderMesh>> loadColliderMesh(const Scene& scene, const Bounds& bounds) {
    if (scene.render.mesh.empty()) {
        return nullptr;
    }
    const auto mesh = RELIEF_TRY(readMesh(scene, bounds));
    auto drawn = RELIEF_TRY(withPrefix(meshOrigin(scene), ColliderMesh::create(mesh)));
    return std::make_unique<ColliderMesh>(std::move(drawn));
}

ColliderView colliderView(const LoadedScene& loaded, const WorldTextures& textures) {
    float texel = std::numeric_limits<float>::max();
    for (std::size_t i = 0; i < loaded.colliders.size(); ++i) {
        texel = std::min(texel, loaded.scene.colliders[i].pose.scale * finestTexel(*loaded.colliders[i]));
    }
    // Coarse colliders have 1/16 of the bytes, so full colliders have about 1/4 of the texel size.
    return {&textures, loaded.bounds, loaded.scene.stream ? 0.25F * texel : texel};
}

ParticleStyle particleStyle(const Scene& scene, const SpriteAtlas* atlas) {
    const auto& render = scene.render;
    ParticleStyle style{.diameter = *render.point_size,
                        .color = render.color,
                        .opacity = render.opacity,
                        .sprite = render.sprite,
                        .blend = render.blend,
                        .soft_distance = render.soft_distance,
                        .atlas = atlas};
    for (const SceneType& type : scene.types) {
        style.looks.push_back(type.look);
    }
    return style;
}

ParticleOrder sortedFor(const Scene& scene, const ParticleSystem& particles, const glm::vec3& eye,
                        DepthSorter& sorter) {
    sorter.update(particles.positions(), particles.textureWidth(), particles.extent(), eye,
                  DepthSorter::passesPerFrame(particles.extent(), scene.render.sort_frames));
    return {&sorter.order(), sorter.count()};
}

Camera sceneCamera(const Scene& scene, const Bounds& bounds, double seconds) {
    const auto& given = scene.camera;
    Camera camera;
    if (given.keys.empty()) {
        camera = {*given.eye, *given.target, given.fov};
    } else {
        std::vector<CameraKey> keys;
        for (const SceneCameraKey& key : given.keys) {
            keys.push_back({key.time, key.eye, *key.target, *key.fov});
        }
        camera = cameraAt(keys, seconds);
    }
    setClipPlanes(camera, bounds);
    return camera;
}

}  // namespace relief
