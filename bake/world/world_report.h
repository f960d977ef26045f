// The report of a bake of a level, for people and for programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/report/bake_report.h"
#include "bake/report/collider_report.h"
#include "bake/world/world_bake.h"
#include "formats/fields/field.h"

namespace relief {

/// The table of colliders with verbose, and a last line for all.
[[nodiscard]] std::string worldBakeText(const WorldBakeResult& result, const std::string& folder, double ms,
                                        bool verbose);

struct WorldColliderReport {
    const WorldColliderResult& collider = kNone<WorldColliderResult>;
};

template <class Visitor, FieldsOf<WorldColliderReport> R>
void fields(Visitor& visit, R& report) {
    const WorldColliderResult& c = report.collider;
    const bool failed = c.state == WorldColliderState::kFailed;
    visit("mesh", c.mesh, {"Name of its mesh in the level"});
    visit("tile", c.tile,
          {"Its place among the tiles of its mesh, such as 0-1-0; empty if it is all of the mesh"});
    visit("file", c.file, {"Its container, in the folder of the world"});
    visit("state", c.state, {"State of the container"});
    visit("bodies", c.bodies, {"Nodes that place it", {}, kFromOne});
    visit("area", c.area, {"Area of its mesh's surface", "object units squared", kFromZero});
    visit("largest_scale", c.largest_scale, {"Largest scale of its bodies", {}, kFromZero});
    visit("budget", c.budget, {"Its mesh's share of the budget; null of --texel alone", "bytes"});
    visit("bytes", c.bytes, {"Size of the container; 0 if it failed", "bytes"});
    visit("gpu_bytes", c.gpu_bytes, {"Bytes that it takes on the GPU; 0 if it failed", "bytes"});
    visit("coarse", c.coarse,
          {"Container that stands in for it while it is not on the GPU; null where that would save little"});
    visit("hash", c.hash, {.help = "XXH3-128 of the container; empty if it failed", .pattern = kHashPattern});
    visit("wrong_percent", c.wrong ? std::optional(c.wrong->total()) : std::nullopt,
          {"Share of the points near its mesh's surface that are on the wrong side; null unless it was baked "
           "and "
           "measured",
           "%", kPercentRange});
    visit(
        "ms", c.ms,
        {"Time of its mesh's bake; 0 if it was up to date, and of all tiles but the first", "ms", kFromZero});
    visit("warnings", c.warnings, {"Warnings, one line each"});
    visit("error", failed ? std::optional(c.error.message) : std::nullopt,
          {"One line for people; null if it did not fail"});
}

/// `relief bake --world --json`
struct WorldBakeJson {
    const WorldBakeResult& result = kNone<WorldBakeResult>;
    std::string output{};
    double ms = 0.0;
};

template <class Visitor, FieldsOf<WorldBakeJson> R>
void fields(Visitor& visit, R& report) {
    const WorldBakeResult& r = report.result;
    visit("tool", std::string("relief ") + RELIEF_VERSION, {"Name and version of the program"});
    visit("output", report.output, {"Folder of the world as given"});
    visit("written", r.written, {"Whether its world.json is there; false if a collider failed"});
    visit("unit", r.world.unit, {"Unit of lengths: m, or empty"});
    visit("bodies", r.world.bodies.size(), {"Bodies"});
    visit("budget", r.budget,
          {"Bytes that all colliders may take on the GPU; null of --texel alone", "bytes"});
    visit("gpu_bytes", r.gpuBytes(), {"Bytes that they take", "bytes"});
    visit("baked", r.countOf(WorldColliderState::kBaked), {"Colliders that were baked"});
    visit("up_to_date", r.countOf(WorldColliderState::kUpToDate), {"Colliders that were left as they were"});
    visit("failed", r.countOf(WorldColliderState::kFailed), {"Colliders that failed"});
    visit("removed", r.removed, {"Containers that only the world from before named, and that are gone now"});
    visit("ms", report.ms, {"Time of the whole run", "ms", kFromZero});
    visit("inputs", r.inputs, {.help = "All files that it was made from", .items = kFromOne});
    visit("warnings", r.warnings, {"Warnings of the level, one line each"});
    visit("colliders", viewsOf<WorldColliderReport>(r.colliders), {"Colliders, in the order of the world"});
}

}  // namespace relief
