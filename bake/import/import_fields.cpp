// SPDX-License-Identifier: Apache-2.0
#include "bake/import/import_fields.h"

namespace relief {

void fields(FieldVisitor& visit, ImportOptions& options) {
    visit("unit", options.unit,
          {.help = "Unit of the mesh's lengths: m, cm, mm, um, km, in, ft, yd; they become metres",
           .fallback = "the file's; without one, lengths stay as they are",
           .words = kLengthUnits,
           .value = "UNIT",
           .recorded = true});
    visit("up", options.up,
          {.help = "The mesh's axis that points upwards: +x -x +y -y +z -z; it becomes +y",
           .fallback = "the file's; without one, axes stay as they are",
           .value = "AXIS",
           .recorded = true});
    visit(
        "hidden", options.hidden,
        {.help = "skip: leave out hidden objects and lower levels of detail of the mesh file; keep: use all",
         .recorded = true});
}

void fields(FieldVisitor& visit, ImportLimits& limits) {
    visit("import_memory", limits.memory,
          {.help = "Memory that reading the mesh may take",
           .unit = "bytes",
           .range = {64e6, 1e12},  // enough for a small mesh
           .must = "64MB to 1000GB"});
    visit("import_time", limits.seconds,
          {.help = "Seconds that reading the mesh may take",
           .unit = "s",
           .range = {1.0, 86'400.0},
           .value = "SECONDS",
           .must = "1 to 86400 seconds"});
    visit("max_triangles", limits.triangles,
          {.help = "Triangles that the mesh may have, instances counted one by one",
           .range = {1.0, double{kTriangleMax}},
           .must = "1 to 100000000 triangles"});
}

}  // namespace relief
