// SPDX-License-Identifier: Apache-2.0
#include "runtime/player/scene_picture.h"

#include "runtime/gl/gl_fault.h"
#include "runtime/scene/scene_pictures.h"

namespace relief {

Result<void> ScenePicture::makeCollider(const ColliderView& view) {
    const Scene& scene = loaded_->scene;
    if (!scene.render.mesh.empty() && loaded_->live.front()) {
        const LiveMesh& live = *loaded_->live.front();
        mesh_ = std::make_unique<ColliderMesh>(RELIEF_TRY(ColliderMesh::create(live.mesh)));
        wobble_ = RELIEF_TRY(WobblePass::create(live.wobble, live.mesh.positions, live.mesh.normals,
                                                VertexOutput::kPositionsAndNormals));
    } else {
        mesh_ = RELIEF_TRY(loadColliderMesh(scene, loaded_->bounds));
    }
    collider_ = RELIEF_TRY(ColliderRenderer::create(view, mesh_.get()));
    collider_style_ = {scene.ground.enabled ? scene.ground.height : std::nullopt, scene.render.background,
                       scene.colliders.front().color.value_or(ColliderStyle().clay)};
    return {};
}

Result<ScenePicture> ScenePicture::create(const LoadedScene& loaded, const WorldTextures& textures,
                                          StepPath path) {
    const Scene& scene = loaded.scene;
    const ColliderView view = colliderView(loaded, textures);
    auto frame = RELIEF_TRY(Frame::create(scene.render.width, scene.render.height));
    auto atlas = RELIEF_TRY(loadAtlas(scene));
    auto particles = RELIEF_TRY(ParticleRenderer::create(view, picturePath(path)));
    ScenePicture picture(loaded, std::move(frame), std::move(particles));
    if (scene.render.meshes.empty()) {
        RELIEF_TRY(picture.makeCollider(view));
    } else {
        picture.meshes_ = RELIEF_TRY(MeshPicture::create(loaded));
    }
    if (scene.render.sort_frames > 0) {
        picture.sorter_ = RELIEF_TRY(DepthSorter::create(scene.particles.capacity, path));
    }
    picture.particle_style_ = particleStyle(scene, atlas.get());
    picture.atlas_ = std::move(atlas);
    return picture;
}

Result<const GlTexture*> ScenePicture::drawColliders(const Camera& camera, double seconds) {
    const RenderTarget& target = frame_.target();
    if (meshes_) {
        RELIEF_TRY(meshes_->draw({camera, target.aspect()}, seconds, target));
        return &meshes_->depth();
    }
    if (wobble_) {
        wobble_->run(seconds);
        mesh_->setVertices(wobble_->buffer());
    }
    RELIEF_TRY(collider_->draw(camera, collider_style_, target));
    return &collider_->depth();
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
