// [collider], or [[collider]] as often as wanted.
#include <algorithm>
#include <cmath>

#include "runtime/scene/scene_readers.h"

namespace relief {
namespace {

constexpr std::size_t kMotionKeysMax = 1024;
constexpr double kTimeMax = 1e7;
constexpr double kScaleMin = 1e-6;
constexpr double kScaleMax = 1e6;

/// position, axis and angle of a table; whether any is there.
bool readPlace(SceneTable& table, Pose& pose) {
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
        pose.rotation = glm::normalize(glm::angleAxis(glm::radians(degrees), glm::normalize(axis)));
    }
    return found || has_angle;
}

void readKeys(SceneTable& table, std::string_view file, SceneCollider& collider) {
    for (const toml::table* one : table.tables("key", kMotionKeysMax)) {
        SceneTable key_table(one, "collider.key", file);
        SceneColliderKey key;
        key.pose = collider.pose;
        if (!key_table.number("time", {0.0, kTimeMax}, key.time)) {
            key_table.failAt(one->source().begin, "a [[collider.key]] needs a time, in seconds");
        }
        if (!collider.keys.empty() && !(key.time > collider.keys.back().time)) {
            key_table.failAt(*key_table.find("time"),
                             "collider.key.time does not rise; order the keys by time");
        }
        readPlace(key_table, key.pose);
        key_table.finish();
        collider.keys.push_back(key);
    }
    if (collider.keys.size() == 1) {
        table.failAt(*table.find("key"), "one [[collider.key]] moves nothing; give a second, or a position");
    }
}

/// collider.file
void readFileName(SceneTable& table, const toml::source_position& at, const SceneFolder& folder,
                  SceneCollider& collider) {
    std::string name;
    if (!table.text("file", name) || name.empty()) {
        table.failAt(
            at, "a scene needs collider.file, the .relief file to collide with; bake one with 'relief bake'");
    }
    table.path("file", folder, collider.path, collider.origin);
}

SceneCollider readCollider(SceneTable table, const toml::source_position& at, std::string_view file,
                           const SceneFolder& folder) {
    SceneCollider collider;
    if (!readLive(table, file, folder, collider)) {
        readFileName(table, at, folder, collider);
    }
    collider.posed = readPlace(table, collider.pose);
    collider.posed |= table.number("scale", {kScaleMin, kScaleMax}, collider.pose.scale);
    collider.posed |= table.number("restitution", {0.0, 1.0}, collider.restitution);
    collider.posed |= table.number("friction", {0.0, 1.0}, collider.friction);
    readKeys(table, file, collider);
    collider.posed |= !collider.keys.empty();
    table.finish();
    return collider;
}

}  // namespace

std::vector<SceneCollider> readColliders(SceneTable& top, std::string_view file, const SceneFolder& folder) {
    const toml::node* node = top.find("collider");
    if (node == nullptr || !node->is_array()) {
        const toml::source_position at = node == nullptr ? toml::source_position{1, 1} : node->source().begin;
        return {readCollider(top.sub("collider"), at, file, folder)};
    }
    std::vector<SceneCollider> colliders;
    for (const toml::table* one : top.tables("collider", ColliderTextures::kBodiesMax)) {
        colliders.push_back(readCollider({one, "collider", file}, one->source().begin, file, folder));
    }
    if (colliders.empty()) {
        top.failAt(*node, "a scene needs a [collider]");
    }
    return colliders;
}

}  // namespace relief
