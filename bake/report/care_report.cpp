#include "bake/report/care_report.h"

#include <nlohmann/json.hpp>

#include "bake/report/report.h"
#include "formats/base/text.h"
#include "runtime/tool/json_text.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

Json jsonHealth(const std::optional<MeshHealth>& health) {
    if (!health) {
        return nullptr;
    }
    Json json = {{"solid", health->isSolid()},
                 {"closed", health->closed},
                 {"inside_out", health->inside_out},
                 {"triangles", health->triangles},
                 {"degenerate_triangles", health->degenerate_triangles},
                 {"duplicate_triangles", health->duplicate_triangles},
                 {"boundary_edges", health->boundary_edges},
                 {"nonmanifold_edges", health->nonmanifold_edges},
                 {"nonmanifold_vertices", health->nonmanifold_vertices},
                 {"inconsistent_edges", health->inconsistent_edges},
                 {"components", health->components},
                 {"closed_components", health->closed_components},
                 {"self_intersections",
                  health->self_intersections ? Json(*health->self_intersections) : Json(nullptr)},
                 {"first_fault", nullptr}};
    if (const std::optional<MeshFault>& fault = health->first_fault) {
        json["first_fault"] = {{"what", fault->what}, {"at", jsonVector(fault->at)}};
    }
    return json;
}

std::string healthLine(const MeshHealth& health) {
    std::string text = health.isSolid() ? "a closed solid" : faultsText(health);
    text +=
        "; " + std::to_string(health.components) + (health.components == 1 ? " component" : " components");
    if (health.closed_components != health.components) {
        text += ", " + std::to_string(health.closed_components) + " closed";
    }
    return text;
}

std::string detailLines(const MeshHealth& health) {
    const auto line = [](const char* what, const std::string& value) {
        return std::string("  ") + what + ": " + value + "\n";
    };
    const auto count = [&](const char* what, std::uint64_t value) {
        return line(what, std::to_string(value));
    };
    std::string text =
        count("boundary edges", health.boundary_edges) +
        count("non-manifold edges", health.nonmanifold_edges) +
        count("non-manifold vertices", health.nonmanifold_vertices) +
        count("edges wound inconsistently", health.inconsistent_edges) +
        count("duplicate triangles", health.duplicate_triangles) +
        count("triangles without area, left out", health.degenerate_triangles) +
        line("closed", health.closed ? "yes" : "no") + line("inside out", health.inside_out ? "yes" : "no") +
        line("pairs of triangles that intersect", health.self_intersections
                                                      ? std::to_string(*health.self_intersections)
                                                      : "not counted, see --check-intersections");
    if (const std::optional<MeshFault>& fault = health.first_fault) {
        text += line("first fault", fault->what + " at " + shortest(fault->at));
    }
    return text;
}

}  // namespace

std::string careText(const MeshCare& care, bool verbose) {
    if (!care.health) {
        return "";
    }
    std::string text =
        "mesh: " + (care.repaired ? std::to_string(care.health->triangles) + " triangles as it came; " : "") +
        healthLine(*care.health) + "\n";
    text += verbose ? detailLines(*care.health) : "";
    if (care.repaired) {
        text += "after --repair " + care.repair + ": " + std::to_string(care.repaired->triangles) +
                " triangles; " + healthLine(*care.repaired);
        if (care.filled_holes + care.holes_left > 0) {
            text += "; " + std::to_string(care.filled_holes) + " holes filled, " +
                    std::to_string(care.holes_left) + " left";
        }
        text += "\n" + (verbose ? detailLines(*care.repaired) : "");
    } else if (care.turned > 0) {
        text += "turned " + std::to_string(care.turned) + (care.turned == 1 ? " triangle" : " triangles") +
                " to look outwards\n";
    }
    return text;
}

void addCareJson(const MeshCare& care, Json& json) {
    json["mesh_health"] = jsonHealth(care.health);
    json["repair"] = nullptr;
    if (!care.repair.empty()) {
        json["repair"] = {{"method", care.repair},
                          {"mesh_health", jsonHealth(care.repaired)},
                          {"filled_holes", care.filled_holes},
                          {"holes_left", care.holes_left}};
    }
    json["turned_triangles"] = care.turned;
}

}  // namespace relief
