// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bake/images/canvas.h"
#include "bake/images/slice.h"
#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::uint32_t kSize = 192;  ///< samples along a side
constexpr double kZoom = 3.0;         ///< pixels per sample
constexpr double kEm = 20.0;          ///< pixels; legible at half size, as shown on the page
constexpr double kPanel = kSize * kZoom;

constexpr std::array<std::pair<Color, const char*>, 4> kLegend = {{{{0.66, 0.69, 0.73}, "inside"},
                                                                   {{0.94, 0.945, 0.95}, "outside"},
                                                                   {{0.84, 0.20, 0.13}, "inside by error"},
                                                                   {{0.13, 0.38, 0.85}, "outside by error"}}};

bool isInside(SideVerdict verdict) {
    return verdict == SideVerdict::kInside || verdict == SideVerdict::kFalseOutside;
}

/// The contour consists of the outermost samples that are truly inside.
Color colorAt(const VerdictSlice& slice, std::uint32_t x, std::uint32_t y) {
    const auto outside = [&](std::uint32_t at_x, std::uint32_t at_y) {
        return at_x < slice.size && at_y < slice.size && !isInside(slice.at(at_x, at_y));
    };
    const SideVerdict verdict = slice.at(x, y);
    const bool contour = isInside(verdict) &&
                         (outside(x - 1, y) || outside(x + 1, y) || outside(x, y - 1) || outside(x, y + 1));
    return contour ? kInk : kLegend[static_cast<std::size_t>(verdict)].first;
}

/// Returns the largest number of the form 1, 2 or 5 times a power of ten that is at most a third of the side.
double scaleOf(double side) {
    const double limit = side / 3.0;
    double length = 1.0;
    while (length > limit) {
        length *= 0.1;
    }
    while (10.0 * length <= limit) {
        length *= 10.0;
    }
    return 5.0 * length <= limit ? 5.0 * length : 2.0 * length <= limit ? 2.0 * length : length;
}

std::string lengthWords(double length, const std::string& unit) {
    return formatted("%.5g", length) + (unit.empty() ? "" : " " + unit);
}

}  // namespace

glm::dvec3 VerdictSlice::point(std::uint32_t x, std::uint32_t y) const {
    glm::dvec3 p(center);
    p[right] += side * ((x + 0.5) / size - 0.5);
    p[up] += side * ((y + 0.5) / size - 0.5);
    return p;
}

VerdictSlice verdictSlice(const glm::vec3& center, const glm::vec3& normal, double side) {
    VerdictSlice slice;
    // In a tie, z wins, then x: these planes have +y up.
    slice.axis = 2;
    for (const int axis : {0, 1}) {
        slice.axis = std::abs(normal[axis]) < std::abs(normal[slice.axis]) ? axis : slice.axis;
    }
    slice.right = slice.axis == 0 ? 2 : 0;
    slice.up = slice.axis == 1 ? 2 : 1;
    slice.center = center;
    slice.side = side;
    slice.size = kSize;
    slice.verdicts.assign(std::size_t{kSize} * kSize, SideVerdict::kOutside);
    return slice;
}

Result<std::vector<std::byte>> drawVerdicts(const VerdictSlice& slice, const std::string& unit) {
    Canvas canvas(kPanel, kPanel + 5.0 * kEm, kEm);
    canvas.image(0.0, 0.0, slice.size, slice.size, kPanel / slice.size,
                 [&](std::uint32_t x, std::uint32_t y) { return colorAt(slice, x, slice.size - 1 - y); });
    canvas.circle(0.5 * kPanel, 0.5 * kPanel, 0.9 * kEm, 5.0, Color(1.0));
    canvas.circle(0.5 * kPanel, 0.5 * kPanel, 0.9 * kEm, 2.0, kInk);

    const double scale = scaleOf(slice.side);
    const double width = scale / slice.side * kPanel;
    const std::string words = lengthWords(scale, unit);
    canvas.fill(0.4 * kEm, kPanel - 2.6 * kEm,
                std::max(width + 0.8 * kEm, canvas.textWidth(words) + 0.8 * kEm), 2.2 * kEm, Color(1.0));
    canvas.text(0.8 * kEm, kPanel - 1.3 * kEm, words);
    canvas.fill(0.8 * kEm, kPanel - 0.9 * kEm, width, 0.25 * kEm, kInk);

    for (std::size_t i = 0; i < kLegend.size(); ++i) {
        const double x = i < 2 ? 0.4 * kEm : 0.34 * kPanel;
        const double y = kPanel + (i % 2 == 0 ? 1.5 : 3.0) * kEm;
        canvas.fill(x, y - 0.8 * kEm, kEm, kEm, Color(0.75));
        canvas.fill(x + 1.0, y - 0.8 * kEm + 1.0, kEm - 2.0, kEm - 2.0, kLegend[i].first);
        canvas.text(x + 1.4 * kEm, y, kLegend[i].second);
    }
    const std::string plane = std::string("plane ") + axisName(slice.axis) + " = " +
                              lengthWords(double{slice.center[slice.axis]}, unit) + ", " +
                              axisName(slice.right) + " to the right, " + axisName(slice.up) + " upwards";
    canvas.text(0.4 * kEm, kPanel + 4.5 * kEm, plane);
    return canvas.png();
}

}  // namespace relief
