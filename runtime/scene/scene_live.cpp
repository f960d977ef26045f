#include "runtime/scene/scene_live.h"

#include <algorithm>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>

#include "formats/base/file_io.h"
#include "runtime/collider/live_collider.h"
#include "runtime/files/mesh_file.h"

namespace relief {
namespace {

tl::unexpected<Error> failAt(const SceneCollider& from, const Error& error) {
    return fail(error.code, from.origin + ": collider.mesh: " + error.message);
}

/// With the fields that the scene leaves open.
Deformation complete(const SceneLive& live, const PictureMesh& mesh, const Bounds& box) {
    Deformation d = deformationOf(live);
    if (!live.has_center) {
        d.center = box.center();
    }
    if (!live.has_wavelength) {
        d.wavelength = 0.5F * box.longestSide();
    }
    if (!live.has_range) {
        const glm::vec3 line = d.kind == DeformKind::kBend ? d.along : d.axis;
        d.range_low = std::numeric_limits<float>::max();
        d.range_high = std::numeric_limits<float>::lowest();
        for (const glm::vec3& p : mesh.positions) {
            d.range_low = std::min(d.range_low, glm::dot(p - d.center, line));
            d.range_high = std::max(d.range_high, glm::dot(p - d.center, line));
        }
    }
    return d;
}

}  // namespace

Deformation deformationOf(const SceneLive& live) {
    constexpr float kTurn = 2.0F * std::numbers::pi_v<float>;
    Deformation d = live.deformation;
    d.phase = glm::radians(d.phase);
    if (d.kind != DeformKind::kWobble) {
        d.amplitude = std::clamp(glm::radians(d.amplitude), -kTurn, kTurn);
    }
    return d;
}

Result<LiveMesh> loadLiveMesh(const SceneCollider& from) {
    auto read = loadPictureMesh(from.path);
    if (!read) {
        return failAt(from, read.error());
    }
    LiveMesh out;
    out.mesh = withNormals(*read, std::numbers::pi_v<float>);
    Bounds box;
    for (const glm::vec3& p : out.mesh.positions) {
        box.add(p);
    }
    if (!(box.longestSide() > 0.0F)) {
        return failAt(
            from, {ErrorCode::kInvalidInput, quotedPath(from.path) + " has no extent; name another mesh"});
    }
    out.deformation = complete(*from.live, out.mesh, box);
    if (auto good = checkDeformation(out.deformation); !good) {
        // The scene's numbers are in range; flat meshes have no extent along the axis.
        return fail(ErrorCode::kInvalidInput, from.origin + ": collider.deform does not suit " +
                                                  quotedPath(from.path) + ": " + good.error().message +
                                                  "; give collider.deform.range");
    }
    auto frames = liveFrames(deformedBounds(out.deformation, out.mesh.positions), from.resolution);
    if (!frames) {
        return failAt(from, {ErrorCode::kInvalidInput, frames.error().message});
    }
    out.frames = std::move(*frames);
    return out;
}

}  // namespace relief
