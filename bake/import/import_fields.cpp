// SPDX-License-Identifier: Apache-2.0
#include "bake/import/import_fields.h"

namespace relief {

void fields(FieldVisitor& visit, ImportOptions& options) {
    visit("unit", options.unit,
          {.help = "Length unit of the mesh: m, cm, mm, um, km, in, ft, yd; the collider is in metres",
           .fallback = "the file's; without one, lengths are unchanged",
           .words = kLengthUnits,
           .value = "UNIT",
           .recorded = true});
    visit("up", options.up,
          {.help = "Up axis of the mesh: +x -x +y -y +z -z; it becomes +y",
           .fallback = "the file's; without one, axes are unchanged",
           .value = "AXIS",
           .recorded = true});
    visit("hidden", options.hidden,
          {.help =
               "skip: omit hidden objects and lower levels of detail of the mesh file; keep: bake them, too",
           .recorded = true});
}

void fields(FieldVisitor& visit, ImportLimits& limits) {
    visit("import_memory", limits.memory,
          {.help = "Memory limit for reading the mesh",
           .unit = "bytes",
           .range = {64e6, 1e12},  // enough for a small mesh
           .must = "64MB to 1000GB"});
    visit("import_time", limits.seconds,
          {.help = "Time limit for reading the mesh, in seconds",
           .unit = "s",
           .range = {1.0, 86'400.0},
           .value = "SECONDS",
           .must = "1 to 86400 seconds"});
    visit("max_triangles", limits.triangles,
          {.help = "Triangle limit of the mesh, counting each instance",
           .range = {1.0, double{kTriangleMax}},
           .must = "1 to 100000000 triangles"});
}

}  // namespace relief
