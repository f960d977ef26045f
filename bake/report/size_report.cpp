#include "bake/report/size_report.h"

#include <cstdio>

#include "formats/base/text.h"

namespace relief {
namespace {

/// Three digits tell a size; more would be noise.
std::string length(float value) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.3g", double{value});
    return shortest(parseFloat(text).value_or(value));  // 1800 and not 1.8e+03
}

std::string sidesText(const glm::vec3& size) {
    return length(size.x) + " x " + length(size.y) + " x " + length(size.z);
}

std::string vectorText(const glm::vec3& v) {
    return "(" + length(v.x) + ", " + length(v.y) + ", " + length(v.z) + ")";
}

}  // namespace

std::string boxText(const Bounds& bounds, const std::string& unit) {
    return sidesText(bounds.size()) + " " + (unit.empty() ? "object units" : unit) + ", from " +
           vectorText(bounds.min) + " to " + vectorText(bounds.max);
}

std::optional<std::string> forgottenUnit(const Bounds& bounds) {
    if (!(bounds.longestSide() >= kForgottenUnitFrom)) {
        return std::nullopt;
    }
    const glm::vec3 size = bounds.size();
    return std::string(kNoUnit) + ", and the box is " + sidesText(size) + ": with --unit cm " +
           sidesText(size * 0.01F) + " m, with --unit mm " + sidesText(size * 0.001F) +
           " m; say which, or --unit m if these are metres";
}

}  // namespace relief
