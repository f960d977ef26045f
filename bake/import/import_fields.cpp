// SPDX-License-Identifier: Apache-2.0
#include "bake/import/import_fields.h"

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

}  // namespace relief
