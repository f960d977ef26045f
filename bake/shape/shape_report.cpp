// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/shape/shape.h"

namespace relief {
namespace {

void append(std::string& text, std::uint64_t count, const char* one, const char* many) {
    if (count > 0) {
        text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + (count == 1 ? one : many);
    }
}

}  // namespace

std::vector<std::string> asOptionWords(const ShapeReport& report) {
    std::vector<std::string> words;
    if (report.as != ShapeAs::kAuto) {
        words.emplace_back(wordOf(report.as));
    }
    for (const NamedTriangles& named : report.named) {
        words.push_back(named.shape.name + "=" + std::string(wordOf(named.shape.as)));
    }
    return words;
}

std::optional<Thickness> thicknessOf(const ShapeReport& report) {
    const bool by_part = report.default_thickness > 0.0;
    const double length = by_part ? report.default_thickness : report.thickness;
    return length > 0.0 ? std::optional(Thickness{length, by_part}) : std::nullopt;
}

std::string ShapeReport::text() const {
    std::string text;
    append(text, solids, "solid", "solids");
    append(text, solids_with_holes, "solid with holes", "solids with holes");
    append(text, sheets, "sheet", "sheets");
    append(text, terrains, "terrain", "terrains");
    append(text, voids, "sealed void, full", "sealed voids, full");
    return text;
}

void fields(FieldVisitor& visit, const NamedTriangles& named) {
    visit("name", named.shape.name,
          {.help = "Name of a node, mesh, group or material of the file", .pattern = "."});
    visit("as", named.shape.as, {"How its triangles are treated"});
    visit("triangles", named.triangles,
          {"Triangles with this name, except those that a later name overrides"});
}

void fields(FieldVisitor& visit, const ShapeReport& report) {
    const auto length = [](double value) { return onlyIf(value > 0.0, static_cast<float>(value)); };
    constexpr FieldRange kAboveZero{.low = 0.0, .low_included = false};
    visit("as", report.as, {"KIND of --as for triangles without a named KIND"});
    visit("named", report.named, {"Each --as NAME=KIND, in the order of the options"});
    visit("solids", report.solids, {"Closed parts"});
    visit("solids_with_holes", report.solids_with_holes,
          {"Open parts whose inside is mostly hidden; their holes are closed"});
    visit("sheets", report.sheets, {"Parts that are visible from both sides; they become shells"});
    visit("unjoined_shells", report.unjoined_shells,
          {"Open shells within another shell, with nearly facing mouths; their inside is filled"});
    visit("closable_sheets", report.closable_sheets,
          {"Sheets of at least a quarter of the mesh's longest side that would be solids with closed holes: "
           "vessels, or bodies for --as solid"});
    visit("ambiguous_walls", report.ambiguous_walls,
          {"Walls of two open shells whose winding does not distinguish a lining from a clothed body"});
    visit("terrains", report.terrains, {"Height fields; they become the ground below them"});
    visit("voids", report.voids,
          {"Voids that sheets and solids seal together; filled, except with --voids keep"});
    visit("coincident_triangles", report.coincident_triangles,
          {"Triangles dropped because they coincide with another triangle"});
    visit("near_copies", report.near_copies,
          {"Closed parts dropped because they lie within a ten-thousandth of their longest side of a larger "
           "one"});
    visit("thickness_max", length(report.thickness),
          {"Thickness of the thickest shell; null without shells", "object units", kAboveZero});
    visit("thickness_min", length(report.thickness_min),
          {"Thickness of the thinnest shell; null without shells", "object units", kAboveZero});
    visit("thickness_given", report.thickness > 0.0 && report.default_thickness == 0.0,
          {"--thickness was given; otherwise each shell's thickness depends on the size of its part"});
}

}  // namespace relief
