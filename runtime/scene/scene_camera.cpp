// [[camera.key]]: the camera's path.
#include <cmath>

#include "runtime/scene/scene_readers.h"

namespace relief {
namespace {

constexpr std::size_t kCameraKeysMax = 10'000;

}  // namespace

void readCameraPath(SceneTable& camera, std::string_view file, Scene& scene) {
    auto& out = scene.camera;
    double before = -1.0;
    for (const toml::table* one : camera.tables("key", kCameraKeysMax)) {
        SceneTable table(one, "camera.key", file);
        SceneCameraKey key;
        const bool time = table.number("time", {0.0, kSecondsMax * 10.0}, key.time);
        const bool eye = table.vector("eye", symmetric(kLengthMax), key.eye);
        table.vector("target", symmetric(kLengthMax), key.target);
        table.number("fov", {1.0, 170.0}, key.fov);
        table.finish();
        if (!time || !eye) {
            table.failAt(*one, "a [[camera.key]] needs " + table.full(time ? "eye" : "time"));
        }
        if (key.time <= before) {
            table.failAt(*table.find("time"), "camera.key.time = " + numberText(key.time) +
                                                  " does not rise; sort the keys by time");
        }
        before = key.time;
        const glm::vec3 target =
            key.target.value_or(out.target.value_or(key.eye + glm::vec3(0.0F, 0.0F, 1.0F)));
        const glm::vec3 d = key.eye - target;
        if (!(std::hypot(d.x, d.z) > 1e-4F * std::abs(d.y))) {
            table.failAt(*table.find("eye"),
                         "camera.key.eye is straight above or below its target, or in it; move "
                         "it aside");
        }
        out.keys.push_back(key);
    }
    const bool path = camera.word("path", {"smooth", "linear"}, out.curve);
    if (path && out.keys.empty()) {
        camera.failUseless("path", "without [[camera.key]]; add keys, or remove it");
    }
    if (!out.keys.empty() && out.eye) {
        camera.failUseless("eye", "beside [[camera.key]], which has its own; remove one of them");
    }
}

}  // namespace relief
