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

Result<PlayedMesh> loadPlayedMesh(const SceneCollider& from, std::shared_ptr<const AnimatedMesh> mesh) {
    const ScenePlay& play = *from.play;
    const std::string place = from.origin + ": collider.play.clip = '" + cleanUtf8(play.clip) + "' ";
    const std::optional<std::size_t> clip = findClip(*mesh, play.clip);
    if (!clip) {
        return invalidInput(
            place + "is no clip of " + quotedPath(from.path) +
            (mesh->clips.empty() ? ", which has none; bake it with --clips" : "; it has " + namesOf(*mesh)));
    }
    PlayedMesh played{mesh, *clip, play,
                      RELIEF_TRY(inFront(place, animatedFrames(poseRoom(*mesh), play.resolution)))};
    played.frames.bounds = clipBounds(*mesh, mesh->clips[*clip]);
    return played;
}

}  // namespace relief
