// SPDX-License-Identifier: Apache-2.0
#include "bake/verdict/report_text.h"

#include <algorithm>

#include "bake/maps/budget_search.h"
#include "bake/measure/patch_cells.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// Three digits, without an exponent: 1800, not 1.8e+03.
std::string length(float value) {
    return shortest(parseFloat(formatted("%.3g", double{value})).value_or(value));
}

std::string sidesText(const glm::vec3& size) {
    return length(size.x) + " x " + length(size.y) + " x " + length(size.z);
}

std::string cornerText(const glm::vec3& v) {
    return "(" + length(v.x) + ", " + length(v.y) + ", " + length(v.z) + ")";
}

/// Counts characters, assuming one column each; skips continuation bytes of UTF-8.
std::size_t columns(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80; }));
}

}  // namespace

std::string shortNumber(double value) {
    return formatted("%.4g", value);
}

std::string roughly(double value) {
    return formatted(value >= 99.5 ? "%.3g" : "%.2g", value);
}

std::string percentText(double percent) {
    return roughly(percent) + " %";
}

std::string fractionText(double share) {
    return formatted("%.1f %%", 100.0 * share);
}

std::string countText(std::uint64_t count, std::string_view what, std::string_view plural) {
    std::string text = std::to_string(count) + " ";
    return count == 1 || plural.empty() ? text.append(what).append(count == 1 ? "" : "s")
                                        : text.append(plural);
}

std::string unitText(const std::string& unit) {
    return unit.empty() ? "object units" : unit;
}

std::string lengthText(double value, const std::string& unit) {
    return roughly(value) + (unit.empty() ? "" : " " + unit);
}

std::string positionText(const glm::vec3& p) {
    return "(" + shortNumber(double{p.x}) + ", " + shortNumber(double{p.y}) + ", " +
           shortNumber(double{p.z}) + ")";
}

std::string bytesText(std::uint64_t bytes) {
    constexpr const char* kUnits[] = {" B", " kB", " MB", " GB", " TB"};
    auto value = static_cast<double>(bytes);
    int unit = 0;
    while (value >= 999.5 && unit < 4) {
        value /= 1000.0;
        ++unit;
    }
    return formatted(unit == 0 || value >= 99.95 ? "%.0f" : "%.1f", value) + kUnits[unit];
}

std::uint64_t roundBudget(std::uint64_t bytes) {
    std::uint64_t unit = 1;
    while (bytes / unit >= 100) {
        unit *= 10;
    }
    return std::max((bytes + unit - 1) / unit * unit, kBudgetMin);
}

std::string projectionText(const DepthMap& map) {
    return map.projection() == Projection::kLocal ? "per patch" : projectionName(map.projection());
}

std::string keepsText(const DepthMap& map) {
    return map.projection() == Projection::kLocal ? "-" : compareName(map.compare);
}

std::string sizeText(const DepthMap& map) {
    if (map.format == MapFormat::kPatches) {
        return map.texels.empty() ? "-" : countText(patchCount(map), "patch", "patches");
    }
    return (map.faceCount() == 1 ? "" : std::to_string(map.faceCount()) + "x") + std::to_string(map.width) +
           "x" + std::to_string(map.height);
}

std::string boxText(const Bounds& bounds, const std::string& unit) {
    return sidesText(bounds.size()) + " " + unitText(unit) + ", from " + cornerText(bounds.min) + " to " +
           cornerText(bounds.max);
}

std::optional<std::string> missingUnitText(const Bounds& bounds) {
    if (!(bounds.longestSide() >= kMissingUnitSize)) {
        return std::nullopt;
    }
    const glm::vec3 size = bounds.size();
    return std::string(kNoUnit) + ", and the size is " + sidesText(size) + ": with --unit cm " +
           sidesText(size * 0.01F) + " m, with --unit mm " + sidesText(size * 0.001F) +
           " m; set the right --unit (m if these are metres)";
}

std::string table(const std::vector<std::vector<std::string>>& rows) {
    const std::size_t count = rows.front().size();
    std::vector<bool> right(count);
    std::vector<std::vector<std::string>> cells = rows;
    std::vector<std::size_t> widths(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
        std::string& heading = cells.front()[i];
        right[i] = heading.ends_with('>');
        if (right[i]) {
            heading.pop_back();
        }
        for (const std::vector<std::string>& row : cells) {
            widths[i] = std::max(widths[i], columns(row[i]));
        }
    }
    std::string text;
    for (const std::vector<std::string>& row : cells) {
        std::string line = " ";
        for (std::size_t i = 0; i < count; ++i) {
            const std::string space(widths[i] - columns(row[i]), ' ');
            line += " " + (right[i] ? space + row[i] : row[i] + space) + " ";
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

}  // namespace relief
