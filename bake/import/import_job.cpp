// SPDX-License-Identifier: Apache-2.0
#include "bake/import/import_job.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <pugixml.hpp>

#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::size_t kQuotedMax = 40;  // limit for quotes from the file, in bytes

std::string number(double value) {
    return shortest(static_cast<float>(value));
}

/// Parses the whole text, ignoring surrounding white space, as a finite number.
std::optional<double> finiteNumber(std::string_view text) {
    const std::string_view word = takeWord(text);
    const std::optional<double> value = takeWord(text).empty() ? parseDouble(word) : std::nullopt;
    return value && std::isfinite(*value) ? value : std::nullopt;
}

/// Reads the unit of a binary file.
/// \param text  begins after the property's name: type, label and flags, each as 'S', length and bytes; then the letter
/// of the value's type, and the value.
FbxUnit binaryFbxUnit(std::string_view text) {
    const auto take = [&text](auto value) {
        if (text.size() >= sizeof(value)) {
            std::memcpy(&value, text.data(), sizeof(value));
        }
        text.remove_prefix(std::min(text.size(), sizeof(value)));
        return value;
    };
    for (int i = 0; i < 3 && take('\0') == 'S'; ++i) {
        text.remove_prefix(std::min<std::size_t>(take(std::uint32_t{0}), text.size()));
    }
    const char type = take('\0');
    const double value = type == 'D'   ? take(std::nan(""))
                         : type == 'F' ? static_cast<double>(take(0.0F))
                         : type == 'I' ? static_cast<double>(take(std::int32_t{0}))
                         : type == 'Y' ? static_cast<double>(take(std::int16_t{0}))
                         : type == 'L' ? static_cast<double>(take(std::int64_t{0}))
                                       : std::nan("");
    return {number(value), std::isfinite(value) ? std::optional(value) : std::nullopt};
}

}  // namespace

void fields(FieldVisitor& visit, ImportOptions& options) {
    visit("unit", options.unit,
          {.help = "Unit of lengths in the file, converted to metres: m, cm, mm, um, km, in, ft or yd",
           .fallback = "the file's, or no conversion",
           .words = kLengthUnits,
           .value = "UNIT",
           .recorded = true,
           .details = "If neither the option nor the file states a unit, lengths are not converted."});
    visit("up", options.up,
          {.help = "Up axis in the file, turned to +y: +x, -x, +y, -y, +z or -z",
           .fallback = "the file's, or +y",
           .value = "AXIS",
           .recorded = true});
    visit("hidden", options.hidden,
          {.help = "Skip or keep hidden objects and lower levels of detail in the file", .recorded = true});
}

void fields(FieldVisitor& visit, ImportLimits& limits) {
    visit("max_import_memory", limits.memory,
          {.help = "Memory limit for reading the file",
           .unit = "bytes",
           .range = {64e6, 1e12},  // a small mesh needs less
           .must = "64MB to 1000GB"});
    visit("import_timeout", limits.seconds,
          {.help = "Time limit for reading the file, in seconds",
           .unit = "s",
           .range = {1.0, 86'400.0},
           .value = "SECONDS",
           .must = "1 to 86400 seconds"});
    visit("max_triangles", limits.triangles,
          {.help = "Limit on the number of triangles, counting every instance",
           .range = {1.0, double{kTriangleMax}},
           .must = "1 to 100000000 triangles"});
}

std::optional<double> metresPer(std::string_view unit) {
    constexpr std::array<double, kLengthUnits.size()> kMetres{1.0,    0.01,   0.001,  1e-6,
                                                              1000.0, 0.0254, 0.3048, 0.9144};
    const auto found = std::find(kLengthUnits.begin(), kLengthUnits.end(), unit);
    return found == kLengthUnits.end()
               ? std::nullopt
               : std::optional(kMetres.at(static_cast<std::size_t>(found - kLengthUnits.begin())));
}

glm::dmat3 turnUpwards(UpAxis up) {
    // Columns: the images of x, y and z.
    static const glm::dmat3 kTurns[] = {
        {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}, {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
        {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},  {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
        {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}, {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}};
    return kTurns[static_cast<std::size_t>(up)];
}

FrameChange changeOf(const SourceFrame& source, std::string_view unit, std::optional<UpAxis> up) {
    FrameChange change;
    const std::optional<double> given = metresPer(unit);
    if (const std::optional<double> metres = given ? given : source.metres) {
        change.scale = *metres;
        change.unit = "m";
    }
    if (given && source.metres && std::abs(*given / *source.metres - 1.0) > 1e-6) {
        change.warnings.push_back("--unit " + std::string(unit) + " overrides the file's unit, " +
                                  number(*source.metres) + " m");
    }
    // The axis after mirroring.
    const auto now = [&source](UpAxis axis) {
        return !source.mirrored || axis < UpAxis::kPlusZ ? axis
               : axis == UpAxis::kPlusZ                  ? UpAxis::kMinusZ
                                                         : UpAxis::kPlusZ;
    };
    if (up || source.up) {
        change.turn = turnUpwards(now(up ? *up : *source.up));
    }
    if (up && source.up && *up != *source.up) {
        change.warnings.push_back("--up " + std::string(wordOf(*up)) + " overrides the file's up axis, " +
                                  std::string(wordOf(*source.up)));
    }
    return change;
}

Result<void> checkFrame(const SourceFrame& source, std::string_view unit, std::optional<UpAxis> up) {
    if (!source.unit_fault.empty() && unit.empty()) {
        return invalidInput(source.unit_fault + "; state the unit (--unit m, cm, mm, …)");
    }
    if (!source.up_fault.empty() && !up) {
        return invalidInput(source.up_fault + "; state the up axis (--up +y, +z, …)");
    }
    return {};
}

std::optional<FbxUnit> fbxUnit(std::span<const std::byte> document) {
    using namespace std::string_view_literals;
    const std::string_view text(reinterpret_cast<const char*>(document.data()), document.size());
    if (text.starts_with("Kaydara")) {
        constexpr std::string_view kName = "S\x0f\0\0\0UnitScaleFactor"sv;
        const std::size_t at = text.find(kName);
        return at == std::string_view::npos ? std::nullopt
                                            : std::optional(binaryFbxUnit(text.substr(at + kName.size())));
    }
    const std::size_t at = text.find("\"UnitScaleFactor\"");
    if (at == std::string_view::npos) {
        return std::nullopt;
    }
    // P: "name", "type", "label", "flags", value; in older files Property: "name", "type", "flags", value
    const std::size_t begin = text.rfind('\n', at) + 1;  // npos + 1 is 0
    const bool older = trimmed(text.substr(begin, at - begin)).starts_with("Property");
    std::string_view rest = text.substr(at);
    rest = takeLine(rest);
    for (int field = 0; field < (older ? 3 : 4); ++field) {
        rest.remove_prefix(std::min(rest.find(','), rest.size() - 1) + 1);
    }
    return FbxUnit{cleanUtf8(trimmed(rest).substr(0, kQuotedMax)), finiteNumber(rest)};
}

SourceFrame colladaFrame(std::span<const std::byte> document) {
    SourceFrame frame{1.0, UpAxis::kPlusY};
    pugi::xml_document xml;
    xml.load_buffer(document.data(), document.size());
    const pugi::xml_node asset = xml.child("COLLADA").child("asset");
    const std::string meter = asset.child("unit").attribute("meter").as_string("1");
    // Some locales write a comma; assimp reads it as a point.
    std::string point = meter;
    std::replace(point.begin(), point.end(), ',', '.');
    frame.metres = finiteNumber(point);
    if (!frame.metres || !(*frame.metres > 0.0)) {
        frame.metres.reset();
        frame.unit_fault = "its unit is '" + cleanUtf8(std::string_view(meter).substr(0, kQuotedMax)) +
                           "' metres, which is not a length";
    }
    std::string_view rest = asset.child("up_axis").child_value();
    const std::string_view axis = takeWord(rest);
    if (axis == "X_UP" || axis == "Z_UP") {
        frame.up = axis == "X_UP" ? UpAxis::kPlusX : UpAxis::kPlusZ;
    } else if (!axis.empty() && axis != "Y_UP") {
        frame.up.reset();
        frame.up_fault =
            "its up_axis '" + cleanUtf8(axis.substr(0, kQuotedMax)) + "' is not an axis of COLLADA";
    }
    return frame;
}

}  // namespace relief
