// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_pictures.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "formats/base/file_io.h"
#include "formats/base/result.h"
#include "runtime/files/mesh_file.h"
#include "runtime/files/png.h"
#include "runtime/picture/camera_path.h"

namespace relief {
namespace {

constexpr std::uint64_t kAtlasBytesMax = std::uint64_t{256} << 20;

tl::unexpected<Error> failAt(const std::string& origin, const char* key, const Error& error) {
    return fail(error.code, origin + ": " + key + ": " + error.message);
}

Result<RgbaPicture> readAtlas(const Scene& scene) {
    const auto& render = scene.render;
    const std::string origin = render.atlas_origin + ": render.atlas";
    const auto bytes = RELIEF_TRY(withPrefix(origin, readFile(render.atlas, kAtlasBytesMax)));
    return withPrefix(origin, decodePng(bytes, quotedPath(render.atlas)));
}

Result<PictureMesh> readMesh(const Scene& scene, const Bounds& bounds) {
    const auto& render = scene.render;
    auto mesh = RELIEF_TRY(withPrefix(render.mesh_origin + ": render.mesh", loadPictureMesh(render.mesh)));
    Bounds box;
    for (const std::uint32_t v : mesh.triangles) {
        box.add(mesh.positions[v]);
    }
    bool apart = false;
    for (int i = 0; i < 3; ++i) {
        apart = apart || box.min[i] > bounds.max[i] || box.max[i] < bounds.min[i];
    }
    if (apart) {
        return failAt(render.mesh_origin, "render.mesh",
                      {ErrorCode::kInvalidInput,
                       quotedPath(render.mesh) +
                           " does not overlap the collider; use the source mesh of the collider"});
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
    auto atlas = SpriteAtlas::create(picture.rgba, picture.width, picture.height, render.atlas_columns,
                                     render.atlas_rows);
    if (!atlas) {
        // The picture does not match the scene: an error of the file, not of the caller.
        const ErrorCode code =
            atlas.error().code == ErrorCode::kUsage ? ErrorCode::kInvalidInput : atlas.error().code;
        return failAt(render.atlas_origin, "render.atlas", {code, atlas.error().message});
    }
    return std::make_unique<SpriteAtlas>(std::move(*atlas));
}

Result<std::unique_ptr<ColliderMesh>> loadColliderMesh(const Scene& scene, const Bounds& bounds) {
    const auto& render = scene.render;
    if (render.mesh.empty()) {
        return nullptr;
    }
    const auto mesh = RELIEF_TRY(readMesh(scene, bounds));
    auto drawn = RELIEF_TRY(withPrefix(render.mesh_origin + ": render.mesh", ColliderMesh::create(mesh)));
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
    ParticleStyle style;
    style.diameter = *render.point_size;
    style.color = render.color;
    style.opacity = render.opacity;
    style.looks = particleLooks(scene);
    style.sprite = render.sprite;
    style.blend = render.blend;
    style.soft_distance = render.soft_distance;
    style.atlas = atlas;
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
        camera.eye = *given.eye;
        camera.target = *given.target;
        camera.fov = given.fov;
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
