#include "bake/report/collider_report.h"

namespace relief {

std::string materialsText(const Materials& materials) {
    std::vector<std::vector<std::string>> rows = {
        {"material", "restitution>", "friction>", "lifetime loss>", "area>"}};
    for (const Material& one : materials.list) {
        rows.push_back({one.name.empty() ? "-" : one.name, shortNumber(double{one.restitution}),
                        shortNumber(double{one.friction}), shortNumber(double{one.lifetime_loss}),
                        shortNumber(100.0 * double{one.area_share}) + " %"});
    }
    return countText(materials.list.size(), "material") + " in " + bytesText(materials.bytes()) + "\n" +
           table(rows);
}

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
