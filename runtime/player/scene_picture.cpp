#include "runtime/player/scene_picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/gl/gl_fault.h"
#include "runtime/scene/scene_pictures.h"

namespace relief {
namespace {

constexpr double kPrintsASecond = 15.0;  // a sole stands for half a second
constexpr double kMostPrints = 256.0;    // between two pictures

ColliderStyle colliderStyle(const Scene& scene) {
    ColliderStyle style;
    style.ground = scene.ground.enabled ? scene.ground.height : std::nullopt;
    style.background = scene.render.background;
    if (!scene.colliders.empty()) {
        style.clay = scene.colliders.front().color.value_or(style.clay);
    }
    return style;
}

Result<WobblePass> wobbleOf(const LiveMesh& live) {
    return WobblePass::create(live.wobble, live.mesh.positions, live.mesh.normals,
                              VertexOutput::kPositionsAndNormals);
}

}  // namespace

Result<void> ScenePicture::makeCollider(const ColliderView& view) {
    const Scene& scene = loaded_->scene;
    if (!scene.render.mesh.empty() && loaded_->live.front()) {
        const LiveMesh& live = *loaded_->live.front();
        mesh_ = std::make_unique<ColliderMesh>(RELIEF_TRY(ColliderMesh::create(live.mesh)));
        wobble_ = RELIEF_TRY(wobbleOf(live));
    } else {
        mesh_ = RELIEF_TRY(loadColliderMesh(scene, loaded_->bounds));
    }
    collider_ = RELIEF_TRY(ColliderRenderer::create(view, mesh_.get()));
    collider_style_ = colliderStyle(scene);
    return {};
}

Result<void> ScenePicture::makeMeshes() {
    drawn_ = RELIEF_TRY(loadDrawnMeshes(*loaded_));
    meshes_ = RELIEF_TRY(MeshRenderer::create(drawn_.meshes));
    for (const SceneMesh& mesh : drawn_.places) {
        if (mesh.motion == MeshMotion::kLive) {
            waves_.push_back({mesh.mesh, RELIEF_TRY(wobbleOf(*loaded_->live[mesh.collider]))});
        }
    }
    return {};
}

Result<ScenePicture> ScenePicture::create(const LoadedScene& loaded, const ColliderTextures& textures,
                                          StepPath path) {
    const Scene& scene = loaded.scene;
    const ColliderView view = colliderView(loaded, textures);
    auto frame = RELIEF_TRY(Frame::create(scene.render.width, scene.render.height));
    auto atlas = RELIEF_TRY(loadAtlas(scene));
    auto particles = RELIEF_TRY(ParticleRenderer::create(view, picturePath(path)));
    ScenePicture picture(loaded, std::move(frame), std::move(particles));
    RELIEF_TRY(scene.render.meshes.empty() ? picture.makeCollider(view) : picture.makeMeshes());
    if (scene.render.sort_frames > 0) {
        picture.sorter_ = RELIEF_TRY(DepthSorter::create(scene.particles.capacity, path));
    }
    picture.particle_style_ = particleStyle(scene, atlas.get());
    picture.atlas_ = std::move(atlas);
    return picture;
}

Result<void> ScenePicture::poseMeshes(double seconds) {
    for (const SceneMesh& mesh : drawn_.places) {
        if (mesh.motion == MeshMotion::kPlayed) {
            const PlayedMesh& played = *loaded_->played[mesh.collider];
            RELIEF_TRY(meshes_->setPositions(mesh.mesh, posed(*played.mesh, played.poseAt(seconds))));
        }
    }
    return {};
}

Result<void> ScenePicture::pressPrints(double seconds) {
    const double since = std::exchange(pressed_, seconds);
    const bool snows =
        std::ranges::any_of(loaded_->scene.render.weather, [](const auto& key) { return key.snow > 0.0F; });
    const bool walks = std::ranges::any_of(
        drawn_.places, [](const SceneMesh& mesh) { return mesh.motion == MeshMotion::kPlayed; });
    if (!snows || !walks || !(since < seconds)) {
        return {};
    }
    const auto steps =
        static_cast<int>(std::clamp(std::ceil((seconds - since) * kPrintsASecond), 1.0, kMostPrints));
    for (int i = 0; i < steps; ++i) {
        const double then = since + (seconds - since) * i / steps;
        RELIEF_TRY(poseMeshes(then));
        RELIEF_TRY(meshes_->press(meshPlaces(*loaded_, drawn_, then), meshStyle(loaded_->scene, then).metre,
                                  shadowBounds(*loaded_)));
    }
    return {};
}

Result<const GlTexture*> ScenePicture::drawColliders(const Camera& camera, double seconds) {
    if (!meshes_) {
        if (wobble_) {
            wobble_->run(seconds);
            mesh_->setVertices(wobble_->buffer());
        }
        RELIEF_TRY(collider_->draw(camera, collider_style_, frame_.target()));
        return &collider_->depth();
    }
    RELIEF_TRY(pressPrints(seconds));
    RELIEF_TRY(poseMeshes(seconds));
    for (auto& [mesh, pass] : waves_) {
        pass.run(seconds);
        meshes_->setVertices(mesh, pass.buffer());
    }
    RELIEF_TRY(meshes_->draw(camera, meshStyle(loaded_->scene, seconds),
                             meshPlaces(*loaded_, drawn_, seconds), shadowBounds(*loaded_), frame_.target()));
    return &meshes_->depth();
}

Result<std::vector<std::uint8_t>> ScenePicture::draw(const ParticleSystem& particles) {
    const Camera camera = sceneCamera(loaded_->scene, loaded_->bounds, particles.time());
    ParticleOrder order;
    if (sorter_) {
        order = sortedFor(loaded_->scene, particles, camera.eye, *sorter_);
    }
    const GlTexture* const depth = RELIEF_TRY(drawColliders(camera, particles.time()));
    RELIEF_TRY(particles_.draw(particles, camera, particle_style_, frame_.target(), order, depth));
    std::vector<std::uint8_t> rgb = frame_.read();
    RELIEF_TRY(checkGpu("drawing a picture"));
    return rgb;
}

}  // namespace relief
