// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_live.h"

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "formats/base/file_io.h"
#include "formats/base/result.h"
#include "runtime/files/mesh_file.h"
#include "runtime/live/live_collider.h"

namespace relief {

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
        return fail(ErrorCode::kInvalidInput,
                    place + ": " + quotedPath(from.path) + " has no extent; use another mesh");
    }
    const SceneLive& live = *from.live;
    out.wobble = {live.amplitude, live.frequency, glm::radians(live.phase),
                  live.wavelength.value_or(0.5F * box.longestSide())};
    box.min -= std::abs(live.amplitude);
    box.max += std::abs(live.amplitude);
    auto frames = liveFrames(box, from.resolution);
    if (!frames) {
        return fail(ErrorCode::kInvalidInput, place + ": " + frames.error().message);
    }
    out.frames = std::move(*frames);
    return out;
}

}  // namespace relief
