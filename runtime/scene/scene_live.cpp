// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_live.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <string>

#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "runtime/files/mesh_file.h"
#include "runtime/live/animated_collider.h"
#include "runtime/live/live_collider.h"

namespace relief {
namespace {

constexpr std::size_t kListedMax = 20;

std::string namesOf(const AnimatedMesh& mesh) {
    std::string names;
    for (std::size_t i = 0; i < std::min(mesh.clips.size(), kListedMax); ++i) {
        names += (i > 0 ? ", '" : "'") + mesh.clips[i].name + "'";
    }
    return names + (mesh.clips.size() > kListedMax ? ", …" : "");
}

}  // namespace

Result<LiveMesh> loadLiveMesh(const SceneCollider& from) {
    const std::string place = from.origin + ": collider.mesh";
    LiveMesh out;
    out.mesh =
        withNormals(RELIEF_TRY(withPrefix(place, loadPictureMesh(from.path))), std::numbers::pi_v<float>);
    Bounds box;
    for (const glm::vec3& p : out.mesh.positions) {
        box.add(p);
    }
    if (!(box.longestSide() > 0.0F)) {
        return invalidInput(place + ": " + quotedPath(from.path) + " has no extent; use another mesh");
    }
    const SceneLive& live = *from.live;
    out.wobble = {live.amplitude, live.frequency, glm::radians(live.phase),
                  live.wavelength.value_or(0.5F * box.longestSide())};
    box.min -= std::abs(live.amplitude);
    box.max += std::abs(live.amplitude);
    auto frames = liveMaps(box, from.resolution);
    if (!frames) {
        return invalidInput(place + ": " + frames.error().message);
    }
    out.frames = std::move(*frames);
    return out;
}

MeshPose PlayedMesh::poseAt(double time) const {
    if (!clip) {
        return restPose(*mesh);
    }
    const MeshClip& of = mesh->clips[*clip];
    const double seconds = double{play.start} + double{play.speed} * time;
    return relief::poseAt(*mesh, of, play.loop ? repeated(of, seconds) : seconds);
}

double PlayedMesh::run(double time) const {
    const double seconds = double{play.start} + double{play.speed} * time;
    return clip && play.loop ? std::floor(seconds / double{mesh->clips[*clip].seconds}) : 0.0;
}

Result<void> changeClip(PlayedMesh& played, const SceneCollider& from) {
    const AnimatedMesh& mesh = *played.mesh;
    const std::optional<std::size_t> clip = findClip(mesh, from.play->clip);
    if (!clip && !from.play->clip.empty()) {
        return invalidInput(
            from.play->clip_origin.text + ": collider.play.clip = '" + cleanUtf8(from.play->clip) +
            "' is not a clip of " + quotedPath(from.path) +
            (mesh.clips.empty() ? ", which has none; bake it with --clips" : "; it has " + namesOf(mesh)));
    }
    played.clip = clip;
    played.cyclic = clip && isCyclic(mesh, mesh.clips[*clip]);
    played.play = *from.play;
    return {};
}

Result<PlayedMesh> loadPlayedMesh(const SceneCollider& from, std::shared_ptr<const AnimatedMesh> mesh,
                                  const PoseExtent& extent) {
    PlayedMesh played;
    played.mesh = std::move(mesh);
    RELIEF_TRY(changeClip(played, from));
    played.box_size = played.play.bounds_scale * extent.box_size;
    played.frames = RELIEF_TRY(
        withPrefix(from.origin + ": collider.play", animatedMaps(played.box_size, played.play.resolution)));
    played.frames.bounds = extent.box;
    return played;
}

}  // namespace relief
