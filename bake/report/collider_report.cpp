#include "bake/report/collider_report.h"

namespace relief {

std::string animationText(const AnimatedMesh& mesh) {
    std::string text = countText(mesh.positions.size(), "vertex", "vertices") + " moved by " +
                       countText(mesh.joints.size(), "joint") + " and " +
                       countText(mesh.weights.size(), "morph target") + "\n";
    for (const auto& [head, names] :
         {std::pair("groups   ", groupNames(mesh)), {"material ", mesh.materials}}) {
        if (const std::string list = listedNames(names); !list.empty()) {
            text += head + list + "\n";
        }
    }
    if (mesh.clips.empty()) {
        return text;
    }
    std::vector<std::vector<std::string>> rows = {{"clip", "seconds>"}};
    for (const MeshClip& clip : mesh.clips) {
        rows.push_back({clip.name, shortNumber(double{clip.seconds})});
    }
    return text + table(rows);
}

}  // namespace relief
