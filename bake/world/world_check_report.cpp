#include "bake/world/world_check_report.h"

namespace relief {

std::uint64_t gpuBytesOf(const WorldField& field) {
    std::uint64_t bytes = 0;
    for (const Collider& collider : field.colliders()) {
        bytes += collider.gpuBytes();
    }
    return bytes;
}

std::string worldCheckText(const WorldField& field, const std::string& name, const WorldAccuracy* accuracy) {
    std::string text = name + ": " + countText(field.world().bodies.size(), "body", "bodies") + " of " +
                       countText(field.world().colliders.size(), "collider") + ", " +
                       bytesText(gpuBytesOf(field));
    if (accuracy == nullptr) {
        return text + "; every container is there, and as the world has it\n";
    }
    const std::uint64_t points = accuracy->bodies.front().points;
    text += "\n" + percentText(accuracy->all.total()) +
            " of the points near the surface are on the wrong side (" +
            percentText(accuracy->all.false_inside) + " inside by mistake, " +
            percentText(accuracy->all.false_outside) + " outside), of " + countText(points, "point") +
            " for each body\n";
    if (accuracy->worst.empty()) {
        return text;
    }
    std::vector<std::vector<std::string>> rows = {{"worst body", "node", "mesh", "wrong>", "for example at"}};
    for (const std::size_t i : accuracy->worst) {
        const BodyAccuracy& body = accuracy->bodies[i];
        rows.push_back({std::to_string(i), body.node, body.mesh, percentText(body.wrong.total()),
                        positionText(body.place)});
    }
    return text + "\n" + table(rows);
}

}  // namespace relief
