// SPDX-License-Identifier: Apache-2.0
#include "bake/world/world_report.h"

#include "bake/report/report_text.h"

namespace relief {
namespace {

std::string wrongText(const WorldColliderResult& collider) {
    return collider.wrong ? percentText(collider.wrong->total()) : "-";
}

}  // namespace

std::string worldBakeText(const WorldBakeResult& result, const std::string& folder, double ms, bool verbose) {
    std::vector<std::vector<std::string>> rows = {
        {"collider", "bodies>", "area>", "scale>", "share>", "taken>", "wrong>", "state"}};
    for (const WorldColliderResult& c : result.colliders) {
        rows.push_back({c.mesh + (c.tile.empty() ? "" : " " + c.tile), std::to_string(c.bodies),
                        shortNumber(c.area), shortNumber(c.largest_scale),
                        c.budget ? bytesText(*c.budget) : "-", bytesText(c.gpu_bytes), wrongText(c),
                        std::string(wordOf(c.state))});
    }
    const std::size_t baked = result.countOf(WorldColliderState::kBaked);
    const std::size_t kept = result.countOf(WorldColliderState::kUpToDate);
    std::string text = verbose ? table(rows) : "";
    text += folder + ": " + countText(result.world.bodies.size(), "body", "bodies") + " of " +
            countText(result.colliders.size(), "collider") + ": " + std::to_string(baked) + " baked, " +
            std::to_string(kept) + " up to date; " + bytesText(result.gpuBytes()) +
            (result.budget ? " of " + bytesText(*result.budget) : "") + "; " + shortNumber(ms / 1000.0) +
            " s\n";
    IgnoredParts ignored;
    for (const WorldColliderResult& c : result.colliders) {
        ignored.add(c.ignored, 1.0);
    }
    if (const std::string parts = ignoredText(ignored, result.world.unit); !parts.empty()) {
        text += parts + "\n";
    }
    if (!result.removed.empty()) {
        text += "removed " + countText(result.removed.size(), "container") +
                " that only the world from before named\n";
    }
    return text;
}

void fields(FieldVisitor& visit, const WorldColliderReport& report) {
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
    visit("verdict", c.verdict, {"Summary; null unless it was baked and measured"});
    visit("ignored_parts", c.ignored,
          {"Parts of its mesh that the grade ignores because they are small; sizes in the world"});
    visit(
        "ms", c.ms,
        {"Time of its mesh's bake; 0 if it was up to date, and of all tiles but the first", "ms", kFromZero});
    visit("warnings", c.warnings, {"Warnings, one line each"});
    visit("error", failed ? std::optional(c.error.message) : std::nullopt,
          {"One line for people; null if it did not fail"});
}

void fields(FieldVisitor& visit, const WorldBakeJson& report) {
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
