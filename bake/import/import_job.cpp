// SPDX-License-Identifier: Apache-2.0
#include "bake/import/import_job.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "formats/base/text.h"

namespace relief {

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
    const auto found = std::ranges::find(kLengthUnits, unit);
    return found == kLengthUnits.end()
               ? std::nullopt
               : std::optional(kMetres.at(static_cast<std::size_t>(found - kLengthUnits.begin())));
}

glm::dmat3 rotationToUp(UpAxis up) {
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
                                  shortest(static_cast<float>(*source.metres)) + " m");
    }
    // The axis after mirroring.
    const auto now = [&source](UpAxis axis) {
        return !source.mirrored || axis < UpAxis::kPlusZ ? axis
               : axis == UpAxis::kPlusZ                  ? UpAxis::kMinusZ
                                                         : UpAxis::kPlusZ;
    };
    if (up || source.up) {
        change.turn = rotationToUp(now(up ? *up : *source.up));
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

}  // namespace relief
