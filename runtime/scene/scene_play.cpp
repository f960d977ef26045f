#include "runtime/scene/scene_play.h"

#include <algorithm>
#include <string>

#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "runtime/collider/animated_collider.h"

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

MeshPose PlayedMesh::poseAt(double time) const {
    const MeshClip& of = mesh->clips[clip];
    const double seconds = double{play.start} + double{play.speed} * time;
    return relief::poseAt(*mesh, of, play.repeat ? repeated(of, seconds) : seconds);
}

Result<void> changeClip(PlayedMesh& played, const SceneCollider& from) {
    const std::optional<std::size_t> clip = findClip(*played.mesh, from.play->clip);
    if (!clip) {
        return invalidInput(from.origin + ": collider.play.clip = '" + cleanUtf8(from.play->clip) +
                            "' is no clip of " + quotedPath(from.path) +
                            (played.mesh->clips.empty() ? ", which has none; bake it with --clips"
                                                        : "; it has " + namesOf(*played.mesh)));
    }
    played.clip = *clip;
    played.play = *from.play;
    return {};
}

Result<PlayedMesh> loadPlayedMesh(const SceneCollider& from, std::shared_ptr<const AnimatedMesh> mesh) {
    PlayedMesh played;
    played.mesh = std::move(mesh);
    RELIEF_TRY(changeClip(played, from));
    played.frames = RELIEF_TRY(inFront(from.origin + ": collider.play",
                                       animatedFrames(poseRoom(*played.mesh), played.play.resolution)));
    played.frames.bounds = clipBounds(*played.mesh, played.mesh->clips[played.clip]);
    return played;
}

}  // namespace relief
