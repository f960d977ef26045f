#include "bake/report/places_report.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "bake/report/accuracy_report.h"
#include "formats/base/text.h"
#include "runtime/tool/json_text.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

std::string percentText(double value) {
    return roughly(value) + " %";
}

std::string sideText(double inside_percent) {
    if (inside_percent >= 95.0) {
        return "called inside";
    }
    return inside_percent <= 5.0 ? "called outside" : percentText(inside_percent) + " of them called inside";
}

}  // namespace

std::string gradeOf(double wrong_percent) {
    return wrong_percent <= kGoodPercent ? "good" : wrong_percent <= kFairPercent ? "fair" : "poor";
}

std::string verdictText(double wrong_percent) {
    return percentText(wrong_percent) + " wrong near the surface: " + gradeOf(wrong_percent);
}

std::string positionText(const glm::vec3& p) {
    return "(" + shortNumber(double{p.x}) + ", " + shortNumber(double{p.y}) + ", " +
           shortNumber(double{p.z}) + ")";
}

std::string placeText(const WorstPlace& place, const std::string& unit) {
    return lengthText(place.size(), unit) + " across: " + percentText(place.share_percent) +
           " of the wrong points, " + sideText(place.inside_percent);
}

std::string mapWords(const Collider& collider, int map) {
    if (map < 0) {
        return "no map";
    }
    const DepthMap& of = collider.maps[static_cast<std::size_t>(map)];
    const std::string name = "map " + std::to_string(map) + " (" + mapFormatName(of.format);
    const auto row = [&](int i) { return glm::dvec3(of.object_to_map.row[i]); };
    if (of.projection() == Projection::kOrthographic) {
        const glm::dvec3 d = row(2) / glm::length(row(2)) + 0.0;
        return name + " along " + roughly(d.x) + "/" + roughly(d.y) + "/" + roughly(d.z) + ")";
    }
    // Rows of a cube are along the axes.
    glm::vec3 center;
    for (int i = 0; i < 3; ++i) {
        center[i] = -of.object_to_map.row[i].w / of.object_to_map.row[i][i] + 0.0F;
    }
    return name + " round " + positionText(center) + ")";
}

std::string causeText(const WorstPlace& place, const Collider& collider) {
    const std::string map = mapWords(collider, place.map);
    const std::string decides = place.map < 0 ? "no map votes" : map + " decides";
    const std::string texels = "texels are " + lengthText(place.texel, collider.unit) + " wide";
    switch (place.cause) {
        case WrongCause::kSheet:
            return "a sheet: the surface has no inside there; " + decides;
        case WrongCause::kOpen:
            return "an open mesh: " + (place.map < 0 ? "a map" : map) + " looks in where the surface ends";
        case WrongCause::kUnseen:
            return "unseen by any map; " + decides;
        case WrongCause::kSilhouette:
            return "behind a silhouette: " + decides + ", for which another part lies before it";
        case WrongCause::kOther:
            return map + " decides, and holds another surface; was it baked from this mesh?";
        case WrongCause::kTexel:
            break;
    }
    return "below the texel size: " + decides + ", whose " + texels;
}

std::string placesText(std::span<const WorstPlace> places, const Collider& collider) {
    if (places.empty()) {
        return "";
    }
    std::string text = places.size() == 1 ? "The worst place:\n" : "The worst places:\n";
    for (std::size_t i = 0; i < places.size(); ++i) {
        const WorstPlace& place = places[i];
        text += "  " + std::to_string(i + 1) + "  " + positionText(place.position) + ", " +
                placeText(place, collider.unit) + "\n     " + causeText(place, collider) + "\n";
    }
    return text;
}

std::string adviceText(std::span<const Advice> advice, double wrong_percent) {
    std::string commands;
    std::string vain;
    for (const Advice& one : advice) {
        if (one.wrong_percent && !one.helps) {
            vain += (vain.empty() ? "" : ", ") + one.about + " (" + percentText(*one.wrong_percent) + ")";
            continue;
        }
        commands += "  " + one.command + "\n     " + one.about + "; ";
        commands += one.wrong_percent ? "tried: " + percentText(*one.wrong_percent) + " wrong instead of " +
                                            percentText(wrong_percent)
                                      : "not tried: " + one.untried;
        commands += "\n";
    }
    return (commands.empty() ? "" : "What to do:\n" + commands) +
           (vain.empty() ? "" : "Tried, and of no help: " + vain + "\n");
}

Json jsonPlaces(std::span<const WorstPlace> places, const Collider& collider) {
    Json list = Json::array();
    for (const WorstPlace& place : places) {
        list.push_back(
            {{"position",
              {jsonNumber(place.position.x), jsonNumber(place.position.y), jsonNumber(place.position.z)}},
             {"size", place.size()},
             {"points", place.points},
             {"share_percent", place.share_percent},
             {"false_inside_percent", place.inside_percent},
             {"map", place.map < 0 ? Json(nullptr) : Json(place.map)},
             {"map_percent", place.map_percent},
             {"cause", wrongCauseName(place.cause)},
             {"cause_percent", place.cause_percent},
             {"texel", place.map < 0 ? Json(nullptr) : Json(place.texel)},
             {"why", causeText(place, collider)}});
    }
    return list;
}

Json jsonAdvice(std::span<const Advice> advice) {
    Json list = Json::array();
    for (const Advice& one : advice) {
        list.push_back({{"command", one.command},
                        {"about", one.about},
                        {"tried", one.wrong_percent.has_value()},
                        {"wrong_percent", one.wrong_percent ? Json(*one.wrong_percent) : Json(nullptr)},
                        {"helps", one.helps},
                        {"untried", one.untried.empty() ? Json(nullptr) : Json(one.untried)}});
    }
    return list;
}

}  // namespace relief
