#include "bake/report/shape_report.h"

#include <nlohmann/json.hpp>

#include "bake/report/accuracy_report.h"
#include "runtime/tool/json_text.h"

namespace relief {

std::string shapeText(const ShapeReport& report, const std::string& unit) {
    std::string text = report.text();
    if (text.empty()) {
        return text;
    }
    if (report.thickness > 0.0) {
        const bool alike = report.thickness_least == report.thickness;
        text += "; sheets are " + (alike ? "" : shortNumber(report.thickness_least) + " to ") +
                shortNumber(report.thickness) + " " + (unit.empty() ? "object units" : unit) + " thick";
    }
    if (report.coincident_triangles > 0) {
        text += "; " + std::to_string(report.coincident_triangles) + " coincident triangles count once";
    }
    for (const auto& [shape, triangles] : report.named) {
        text += "; " + shape.name + " (" + std::to_string(triangles) + " triangles) as " +
                std::string(shapeAsName(shape.as));
    }
    return "shape: " + text + "\n";
}

nlohmann::ordered_json jsonShape(const ShapeReport& report) {
    if (report.text().empty()) {
        return nullptr;
    }
    nlohmann::ordered_json named = nlohmann::ordered_json::array();
    for (const auto& [shape, triangles] : report.named) {
        named.push_back({{"name", shape.name}, {"as", shapeAsName(shape.as)}, {"triangles", triangles}});
    }
    const auto length = [](double value) {
        return value > 0.0 ? jsonNumber(static_cast<float>(value)) : nlohmann::ordered_json(nullptr);
    };
    return {{"as", shapeAsName(report.as)},
            {"named", named},
            {"solids", report.solids},
            {"solids_with_holes", report.solids_with_holes},
            {"sheets", report.sheets},
            {"terrains", report.terrains},
            {"coincident_triangles", report.coincident_triangles},
            {"near_copies", report.near_copies},
            {"thickness", length(report.thickness)},
            {"thickness_least", length(report.thickness_least)},
            {"thickness_asked", report.thickness > 0.0 && report.default_thickness == 0.0}};
}

}  // namespace relief
