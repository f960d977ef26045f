// Where a collider or an emitter is, and its ways: position, axis and angle, and tables of keys.
#include <algorithm>
#include <cmath>
#include <string>

#include "runtime/scene/scene_readers.h"

namespace relief {
namespace {

constexpr std::size_t kMotionKeysMax = 1024;
constexpr double kTimeMax = 1e7;

}  // namespace

bool readPose(SceneTable& table, Pose& pose) {
    bool found = table.vector("position", symmetric(kLengthMax), pose.position);
    glm::vec3 axis{0.0F, 1.0F, 0.0F};
    float degrees = 0.0F;
    const bool has_axis = table.vector("axis", symmetric(kLengthMax), axis);
    const bool has_angle = table.number("angle", symmetric(1e6), degrees);
    if (has_axis && !has_angle) {
        table.failUseless("axis", "without " + table.full("angle") + "; give the angle too, in degrees");
    }
    // Scaled first: the square of a short axis would vanish.
    const float largest = std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)});
    if (!(largest > 0.0F)) {
        table.failAt(*table.find("axis"), table.full("axis") + " is no direction; choose one that is not 0");
    }
    if (has_angle) {
        axis /= largest;
        // After two turns the quaternion is the same; a small angle is exact to more digits.
        pose.rotation =
            glm::normalize(glm::angleAxis(glm::radians(std::fmod(degrees, 720.0F)), glm::normalize(axis)));
    }
    return found || has_angle;
}

std::vector<PoseKey> readPoseKeys(SceneTable& table, std::string_view file, const Pose& pose,
                                  std::string_view instead) {
    const std::string full = table.full("key");
    std::vector<PoseKey> keys;
    for (const toml::table* one : table.tables("key", kMotionKeysMax)) {
        SceneTable key_table(one, full, file);
        PoseKey key;
        key.pose = pose;
        if (!key_table.number("time", {0.0, kTimeMax}, key.time)) {
            key_table.failAt(one->source().begin, "a [[" + full + "]] needs a time, in seconds");
        }
        if (!keys.empty() && !(key.time > keys.back().time)) {
            key_table.failAt(*key_table.find("time"), full + ".time does not rise; order the keys by time");
        }
        readPose(key_table, key.pose);
        key_table.finish();
        keys.push_back(key);
    }
    if (keys.size() == 1) {
        table.failAt(*table.find("key"),
                     "one [[" + full + "]] moves nothing; give a second, or " + std::string(instead));
    }
    return keys;
}

}  // namespace relief
