#include "bake/world/world_check_report.h"

#include <algorithm>
#include <utility>

#include "bake/report/check_report.h"
#include "formats/base/text.h"
#include "formats/fields/text.h"

namespace relief {

std::uint64_t gpuBytesOf(const WorldField& field) {
    std::uint64_t bytes = 0;
    for (const Collider& collider : field.colliders()) {
        bytes += collider.gpuBytes();
    }
    return bytes;
}

std::string WorldPlaceReport::advice() const {
    if (body().wrong.total() <= kGoodPercent) {
        return "";
    }
    switch (place().cause) {
        case WorldCause::kMoved:
            return "the world has it elsewhere than the level: bake the level again";
        case WorldCause::kTexel:
            return "it is finer than the texels: bake with --budget " +
                   bytesWord(roundBudget(2 * gpuBytesOf(*field))) +
                   ", which makes them about 0.7 times as wide";
        case WorldCause::kMesh:
            break;
    }
    return "more than texels are wide: its mesh may be open there, or faces cross; mend it, or name what it "
           "is by "
           "--as " +
           shellQuoted((body().node.empty() ? body().mesh : body().node) + "=solid") + ", shell or terrain";
}

namespace {

/// Advice, each sentence once, behind the bodies that it is for.
std::string adviceLines(const WorldField& field, const WorldAccuracy& accuracy) {
    std::vector<std::pair<std::string, std::string>> lines;  // advice, bodies
    for (std::size_t i = 0; i < accuracy.places.size(); ++i) {
        const std::string advice = WorldPlaceReport{&field, accuracy, i}.advice();
        if (advice.empty()) {
            continue;
        }
        const std::string body = std::to_string(accuracy.worst[i]);
        const auto line = std::ranges::find(lines, advice, &std::pair<std::string, std::string>::first);
        if (line == lines.end()) {
            lines.emplace_back(advice, body);
        } else {
            line->second += ", " + body;
        }
    }
    std::string text;
    for (const auto& [advice, bodies] : lines) {
        text += (text.empty() ? "\n" : "") + bodies + ": " + advice + "\n";
    }
    return text;
}

}  // namespace

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
    std::vector<std::vector<std::string>> rows = {
        {"worst body", "node", "mesh", "wrong>", "for example at", "off by>", "texels>"}};
    const std::string& unit = field.world().unit;
    for (std::size_t i = 0; i < accuracy->worst.size(); ++i) {
        const BodyAccuracy& body = accuracy->bodies[accuracy->worst[i]];
        const WorldPlace& place = accuracy->places[i];
        rows.push_back({std::to_string(accuracy->worst[i]), body.node, body.mesh,
                        percentText(body.wrong.total()), positionText(body.place),
                        lengthText(place.distance, unit),
                        place.texel > 0.0 ? lengthText(place.texel, unit) : "-"});
    }
    return text + "\n" + table(rows) + adviceLines(field, *accuracy);
}

}  // namespace relief
