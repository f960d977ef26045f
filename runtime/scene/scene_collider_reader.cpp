// [collider], or [[collider]] as often as wanted.
#include "runtime/scene/scene_readers.h"

namespace relief {
namespace {

constexpr double kScaleMin = 1e-6;
constexpr double kScaleMax = 1e6;

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
    collider.posed = readPose(table, collider.pose);
    collider.posed |= table.number("scale", {kScaleMin, kScaleMax}, collider.pose.scale);
    collider.posed |= table.number("restitution", {0.0, 1.0}, collider.restitution);
    collider.posed |= table.number("friction", {0.0, 1.0}, collider.friction);
    collider.keys = readPoseKeys(table, file, collider.pose, "a position");
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
