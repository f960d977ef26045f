// SPDX-License-Identifier: Apache-2.0
#include "runtime/player/mesh_picture.h"

#include <algorithm>
#include <cmath>

namespace relief {
namespace {

constexpr double kPrintsPerSecond = 15.0;  // a foot is on the ground for about half a second
constexpr double kPrintsMax = 256.0;       // maximum between two pictures

}  // namespace

Result<MeshPicture> MeshPicture::create(const LoadedScene& loaded) {
    DrawnMeshes drawn = RELIEF_TRY(loadDrawnMeshes(loaded));
    MeshRenderer renderer = RELIEF_TRY(MeshRenderer::create(drawn.meshes));
    MeshPicture picture(loaded, std::move(drawn), std::move(renderer));
    for (const SceneMesh& mesh : picture.drawn_.places) {
        if (mesh.motion == MeshMotion::kLive) {
            const LiveMesh& live = *loaded.live[mesh.collider];
            picture.waves_.push_back(
                {mesh.mesh, RELIEF_TRY(WobblePass::create(live.wobble, live.mesh.positions, live.mesh.normals,
                                                          VertexOutput::kPositionsAndNormals))});
        }
    }
    return picture;
}

Result<void> MeshPicture::pose(double seconds) {
    for (const SceneMesh& mesh : drawn_.places) {
        if (mesh.motion == MeshMotion::kPlayed) {
            const PlayedMesh& played = *loaded_->played[mesh.collider];
            RELIEF_TRY(renderer_.setPositions(mesh.mesh, posed(*played.mesh, played.poseAt(seconds))));
        }
    }
    return {};
}

Result<void> MeshPicture::press(double seconds) {
    const double since = std::exchange(pressed_, seconds);
    const std::vector<SceneWeather>& weather = loaded_->scene.render.weather;
    const bool snows =
        std::any_of(weather.begin(), weather.end(), [](const SceneWeather& key) { return key.snow > 0.0F; });
    const bool walks = std::any_of(drawn_.places.begin(), drawn_.places.end(),
                                   [](const SceneMesh& mesh) { return mesh.motion == MeshMotion::kPlayed; });
    if (!snows || !walks || !(since < seconds)) {
        return {};
    }
    const float units_per_meter = loaded_->scene.render.units_per_meter;
    const Bounds around = shadowBounds(*loaded_);
    const auto steps =
        static_cast<int>(std::clamp(std::ceil((seconds - since) * kPrintsPerSecond), 1.0, kPrintsMax));
    // The previous picture already added the footprints at its own time.
    for (int i = drawn_before_ ? 1 : 0; i < steps; ++i) {
        const double then = since + (seconds - since) * i / steps;
        RELIEF_TRY(pose(then));
        RELIEF_TRY(renderer_.press(meshPlaces(*loaded_, drawn_, then), units_per_meter, around));
    }
    return {};
}

Result<void> MeshPicture::draw(const CameraMatrices& camera, double seconds, const RenderTarget& target) {
    RELIEF_TRY(press(seconds));
    drawn_before_ = true;
    RELIEF_TRY(pose(seconds));
    for (auto& [mesh, pass] : waves_) {
        pass.run(seconds);
        renderer_.setVertices(mesh, pass.buffer());
    }
    return renderer_.draw(camera, meshStyle(loaded_->scene, seconds), meshPlaces(*loaded_, drawn_, seconds),
                          shadowBounds(*loaded_), target);
}

}  // namespace relief
