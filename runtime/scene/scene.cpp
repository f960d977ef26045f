#include "runtime/scene/scene.h"

#include <algorithm>
#include <cmath>

#include "runtime/picture/camera.h"
#include "runtime/scene/scene_table.h"

namespace relief {

std::uint32_t prewarmSteps(const Scene& scene) {
    // What is a whole number of steps but for rounding takes no further one.
    return static_cast<std::uint32_t>(std::ceil(scene.prewarm / static_cast<double>(scene.dt) - 1e-6));
}

std::uint32_t firstFrame(const Scene& scene) {
    return std::min(scene.render.first.value_or(scene.render.every), lastFrame(scene));
}

std::uint32_t lastFrame(const Scene& scene) {
    return std::min(scene.render.last.value_or(scene.steps), scene.steps);
}

std::uint32_t frameCount(const Scene& scene) {
    const std::uint32_t first = firstFrame(scene);
    const std::uint32_t span = lastFrame(scene) - first;  // first is at most last
    return 1 + span / scene.render.every + (span % scene.render.every == 0 ? 0 : 1);
}

bool frameDue(const Scene& scene, std::uint32_t step) {
    const std::uint32_t first = firstFrame(scene);
    const std::uint32_t last = lastFrame(scene);
    return step >= first && step <= last && ((step - first) % scene.render.every == 0 || step == last);
}

std::string_view cameraProblem(const glm::vec3& eye, const glm::vec3& target) {
    const glm::vec3 d = eye - target;
    const float flat = std::hypot(d.x, d.z);
    if (!(glm::length(d) > 0.0F)) {
        return "camera.eye is at camera.target; move one of them";
    }
    if (flat <= 1e-4F * std::abs(d.y)) {
        return "camera.eye is straight above or below camera.target, where no side is up; move it aside";
    }
    return {};
}

Result<Scene> withDefaults(Scene scene, const Bounds& bounds) {
    for (int i = 0; i < 3; ++i) {
        if (!(bounds.min[i] >= -kLengthMax && bounds.min[i] <= bounds.max[i] &&
              bounds.max[i] <= kLengthMax)) {
            return fail(ErrorCode::kInvalidInput, "the collider's bounds are empty, or reach beyond " +
                                                      numberText(kLengthMax) +
                                                      "; bake the mesh again, scaled");
        }
    }
    // A collider without extent still gets a scene of some size, one that floats can resolve where it lies.
    const glm::vec3 center = bounds.center();
    const float away = std::max({std::abs(center.x), std::abs(center.y), std::abs(center.z)});
    const float scale = std::max({bounds.longestSide(), 1e-3F * away, 1e-6F});
    const double run = static_cast<double>(scene.dt) *
                       (static_cast<double>(scene.steps) + static_cast<double>(prewarmSteps(scene)));
    RELIEF_TRY(completeEmitters(scene.emitters, bounds, scale, run, scene.capacity));
    if (!scene.forces.gravity) {
        scene.forces.gravity = glm::vec3(0.0F, -3.0F * scale, 0.0F);
    }
    if (scene.ground.enabled && !scene.ground.height) {
        scene.ground.height = bounds.min.y;
    }
    if (!scene.camera.target) {
        scene.camera.target = center + glm::vec3(0.0F, 0.04F * scale, 0.0F);
    }
    if (!scene.camera.eye) {
        scene.camera.eye =
            defaultEye(*scene.camera.target, std::max(0.5F * glm::length(bounds.size()), 0.5F * scale),
                       scene.camera.fov);
    }
    if (const std::string_view problem = cameraProblem(*scene.camera.eye, *scene.camera.target);
        !problem.empty()) {
        return fail(ErrorCode::kInvalidInput, std::string(problem));
    }
    if (!scene.render.point_size) {
        scene.render.point_size = 0.0065F * scale;
    }
    return scene;
}

}  // namespace relief
