#include "bake/import/import_units.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "formats/base/text.h"

namespace relief {
namespace {

struct Unit {
    std::string_view name;
    double metres;
};

constexpr std::array<Unit, 8> kUnits = {{{"m", 1.0},
                                         {"cm", 0.01},
                                         {"mm", 0.001},
                                         {"um", 1e-6},
                                         {"km", 1000.0},
                                         {"in", 0.0254},
                                         {"ft", 0.3048},
                                         {"yd", 0.9144}}};

constexpr std::array<std::string_view, 6> kAxes = {"+x", "-x", "+y", "-y", "+z", "-z"};

/// What stands between `begin` and `end`, or "".
std::string_view between(std::string_view text, std::string_view begin, std::string_view end) {
    const std::size_t from = text.find(begin);
    if (from == std::string_view::npos) {
        return {};
    }
    text.remove_prefix(from + begin.size());
    const std::size_t to = text.find(end);
    return to == std::string_view::npos ? std::string_view{} : text.substr(0, to);
}

std::string number(double value) {
    return shortest(static_cast<float>(value));
}

}  // namespace

std::vector<std::string_view> lengthUnits() {
    std::vector<std::string_view> names;
    for (const Unit& unit : kUnits) {
        names.push_back(unit.name);
    }
    return names;
}

std::optional<double> metresPer(std::string_view unit) {
    for (const Unit& known : kUnits) {
        if (known.name == unit) {
            return known.metres;
        }
    }
    return std::nullopt;
}

Result<UpAxis> parseUpAxis(std::string_view text) {
    const auto found = std::find(kAxes.begin(), kAxes.end(), lowerCase(text));
    if (found == kAxes.end()) {
        return fail(ErrorCode::kUsage,
                    "--up is '" + cleanUtf8(text) + "' but must be one of " + listed(kAxes));
    }
    return static_cast<UpAxis>(found - kAxes.begin());
}

std::string_view upAxisName(UpAxis axis) {
    return kAxes.at(static_cast<std::size_t>(axis));
}

glm::dmat3 turnUpwards(UpAxis up) {
    // Columns: where x, y and z go.
    switch (up) {
        case UpAxis::kPlusX:
            return {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
        case UpAxis::kMinusX:
            return {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}};
        case UpAxis::kPlusY:
            break;
        case UpAxis::kMinusY:
            return {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
        case UpAxis::kPlusZ:
            return {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}};
        case UpAxis::kMinusZ:
            return {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
    }
    return glm::dmat3(1.0);
}

FrameChange changeOf(const SourceFrame& source, std::string_view unit, std::optional<UpAxis> up) {
    FrameChange change;
    const std::optional<double> given = metresPer(unit);
    if (const std::optional<double> metres = given ? given : source.metres) {
        change.scale = source.scaled && source.metres ? *metres / *source.metres : *metres;
        change.unit = "m";
    }
    if (given && source.metres && std::abs(*given / *source.metres - 1.0) > 1e-6) {
        change.warnings.push_back("--unit " + std::string(unit) +
                                  " is taken, but the file says that its unit is " + number(*source.metres) +
                                  " m");
    }
    const glm::dmat3 undone =
        source.turned && source.up ? glm::transpose(turnUpwards(*source.up)) : glm::dmat3(1.0);
    if (up || source.up) {
        change.turn = turnUpwards(up ? *up : *source.up) * undone;
    }
    if (up && source.up && *up != *source.up) {
        change.warnings.push_back("--up " + std::string(upAxisName(*up)) +
                                  " is taken, but the file says that " + std::string(upAxisName(*source.up)) +
                                  " points upwards");
    }
    return change;
}

UpAxis colladaUp(std::string_view document) {
    std::string_view up = between(between(document, "<asset>", "</asset>"), "<up_axis>", "</up_axis>");
    constexpr std::string_view kSpace = " \t\r\n";
    up.remove_prefix(std::min(up.find_first_not_of(kSpace), up.size()));
    up = up.substr(0, up.find_first_of(kSpace));
    return up == "X_UP" ? UpAxis::kPlusX : up == "Z_UP" ? UpAxis::kPlusZ : UpAxis::kPlusY;
}

}  // namespace relief
