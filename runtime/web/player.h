// SPDX-License-Identifier: Apache-2.0
// Creates, changes and draws a scene that runs in a page, and describes the scene as JSON.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/fields/json_value.h"
#include "runtime/events/event_recorder.h"
#include "runtime/picture/depth_sort.h"
#include "runtime/picture/particle_renderer.h"
#include "runtime/player/mesh_picture.h"
#include "runtime/player/simulation.h"
#include "runtime/scene/loaded_scene.h"
#include "runtime/scene/scene_pictures.h"
#include "runtime/web/fetched_source.h"

namespace relief {

/// A running scene with its renderers.
struct Player {
    LoadedScene loaded;
    std::optional<Simulation> simulation;
    std::unique_ptr<SpriteAtlas> atlas;
    std::optional<ParticleRenderer> renderer;
    std::optional<DepthSorter> sorter;
    std::optional<MeshPicture> meshes;  // created by the first drawPlayerMeshes()
    ParticleStyle style;
    std::vector<ParticleState> read;  // reused buffer
    FetchedSource* source = nullptr;  // owned by the simulation; null unless the page fetches colliders
    std::optional<glm::vec3> eye;     // camera position of the last picture
    std::vector<PointOfInterest> near;
    std::vector<std::string> warnings;  // not returned yet
    std::deque<StepEvents> hits;        // not returned yet

    /// Sets the points around which a world is streamed, besides the emitters.
    void setPoints() {
        std::vector<PointOfInterest> points = near;
        if (eye && loaded.scene.stream) {
            points.push_back({*eye, loaded.scene.stream->radius});
        }
        simulation->setPoints(std::move(points));
    }
    /// Appends the simulation's warnings to `warnings`. \return the size of `warnings`.
    int takeWarnings() {
        for (std::string& line : simulation->takeWarnings()) {
            warnings.push_back(std::move(line));
        }
        return static_cast<int>(warnings.size());
    }

    Result<void> makeSorter(const Scene& scene) {
        if (scene.render.sort_frames > 0 && !sorter) {
            sorter.emplace(RELIEF_TRY(DepthSorter::create(scene.particles.capacity, StepPath::kFragment)));
        }
        return {};
    }
};

/// Parameters as for relief_player_create().
[[nodiscard]] Result<Player*> createPlayer(const char* text, const char* path, bool shaded, bool fetches);

/// Applies the changes of a scene. Ignores changes of flow and render.atlas, and of the deform settings, resolution and
/// colours of colliders.
/// \param emitters  whether the emitters restart.
/// Errors: kUsage if the world, number of colliders, capacity, integrator, materials, stream.memory or the presence of
/// [stream] change; if a collider changes in more than position, axis, angle and clip playback; or if the position,
/// axis or angle changes for a collider with keys, or for a single collider that neither had a pose nor deforms.
[[nodiscard]] Result<int> changePlayer(Player& player, const char* text, const char* path, bool emitters);

[[nodiscard]] Result<int> drawPlayer(Player& player, const CameraMatrices& camera,
                                     const RenderTarget& target);
[[nodiscard]] Result<int> drawPlayerMeshes(Player& player, const CameraMatrices& camera,
                                           const RenderTarget& target);

/// Returns the value of relief_player_info().
[[nodiscard]] Json describePlayer(const Player& player);

}  // namespace relief
