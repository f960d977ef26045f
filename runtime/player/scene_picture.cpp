#include "runtime/player/scene_picture.h"

#include "runtime/gl/gl_fault.h"
#include "runtime/scene/scene_pictures.h"

namespace relief {
namespace {

ColliderStyle colliderStyle(const Scene& scene) {
    ColliderStyle style;
    style.ground = scene.ground.enabled ? scene.ground.height : std::nullopt;
    style.background = scene.render.background;
    return style;
}

}  // namespace

Result<ScenePicture> ScenePicture::create(const LoadedScene& loaded, const ColliderTextures& textures,
                                          StepPath path) {
    const Scene& scene = loaded.scene;
    const ColliderView view = colliderView(loaded, textures);
    auto frame = RELIEF_TRY(Frame::create(scene.render.width, scene.render.height));
    auto atlas = RELIEF_TRY(loadAtlas(scene));
    std::optional<WobblePass> wobble;
    std::unique_ptr<ColliderMesh> mesh;
    if (!scene.render.mesh.empty() && loaded.live.front()) {
        const LiveMesh& live = *loaded.live.front();
        mesh = std::make_unique<ColliderMesh>(RELIEF_TRY(ColliderMesh::create(live.mesh)));
        wobble = RELIEF_TRY(WobblePass::create(live.wobble, live.mesh.positions, live.mesh.normals,
                                               VertexOutput::kPositionsAndNormals));
    } else {
        mesh = RELIEF_TRY(loadColliderMesh(scene, loaded.bounds));
    }
    auto collider = RELIEF_TRY(ColliderRenderer::create(view, mesh.get()));
    auto particles = RELIEF_TRY(ParticleRenderer::create(view, picturePath(path)));
    ScenePicture picture(loaded, std::move(frame), std::move(collider), std::move(particles));
    if (scene.render.sort_frames > 0) {
        picture.sorter_ = RELIEF_TRY(DepthSorter::create(scene.particles.capacity, path));
    }
    picture.collider_style_ = colliderStyle(scene);
    picture.particle_style_ = particleStyle(scene, atlas.get());
    picture.atlas_ = std::move(atlas);
    picture.mesh_ = std::move(mesh);
    picture.wobble_ = std::move(wobble);
    return picture;
}

Result<std::vector<std::uint8_t>> ScenePicture::draw(const ParticleSystem& particles) {
    const Camera camera = sceneCamera(loaded_->scene, loaded_->bounds, particles.time());
    ParticleOrder order;
    if (sorter_) {
        order = sortedFor(loaded_->scene, particles, camera.eye, *sorter_);
    }
    if (wobble_) {
        wobble_->run(particles.time());
        mesh_->setVertices(wobble_->buffer());
    }
    RELIEF_TRY(collider_.draw(camera, collider_style_, frame_.target()));
    RELIEF_TRY(
        particles_.draw(particles, camera, particle_style_, frame_.target(), order, &collider_.depth()));
    std::vector<std::uint8_t> rgb = frame_.read();
    RELIEF_TRY(checkGpu("drawing a picture"));
    return rgb;
}

}  // namespace relief
