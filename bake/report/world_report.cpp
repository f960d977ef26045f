// SPDX-License-Identifier: Apache-2.0
#include "bake/report/world_report.h"

#include <algorithm>
#include <utility>

#include "bake/verdict/check_report.h"
#include "formats/base/text.h"
#include "formats/fields/text.h"

namespace relief {
namespace {

std::string wrongText(const WorldColliderResult& collider) {
    return collider.wrong ? percentText(collider.wrong->total()) : "-";
}

/// Returns each distinct advice once, after the bodies that it applies to.
std::string adviceLines(const WorldField& field, const WorldAccuracy& accuracy) {
    std::vector<std::pair<std::string, std::string>> lines;  // advice, then bodies
    for (std::size_t i = 0; i < accuracy.places.size(); ++i) {
        const std::string advice = WorldPlaceReport{&field, accuracy, i}.advice();
        if (advice.empty()) {
            continue;
        }
        const std::string body = std::to_string(accuracy.worst[i]);
        const auto line = std::ranges::find(lines, advice, &std::pair<std::string, std::string>::first);
        if (line == lines.end()) {
            lines.emplace_back(advice, body);
        } else {
            line->second += ", " + body;
        }
    }
    std::string text;
    for (const auto& [advice, bodies] : lines) {
        text += (text.empty() ? "\n" : "") + bodies + ": " + advice + "\n";
    }
    return text;
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
    toolField(visit);
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
    folderFields(visit, r.removed, report.ms, r.inputs, r.warnings);
    visit("colliders", viewsOf<WorldColliderReport>(r.colliders), {"Colliders, in the order of the world"});
}

std::uint64_t gpuBytesOf(const WorldField& field) {
    std::uint64_t bytes = 0;
    for (const Collider& collider : field.colliders()) {
        bytes += collider.texelBytes();
    }
    return bytes;
}

Verdict verdictOf(const WorldAccuracy& accuracy, const std::string& unit) {
    const bool lost = !accuracy.lost.empty();
    const std::string grade = lost ? "poor" : accuracy.coarse > 0 ? "fair" : "good";
    const std::string but = countText(lost ? accuracy.lost.size() : accuracy.coarse, "mesh", "meshes") +
                            (lost ? " lost parts" : " with coarse parts");
    return verdictOf(accuracy.all.total(), grade, but, accuracy.ignored, unit);
}

std::string WorldPlaceReport::advice() const {
    if (body().wrong.total() <= kGoodPercent) {
        return "";
    }
    switch (place().cause) {
        case WorldCause::kMoved:
            return "the world has it elsewhere than the level: bake the level again";
        case WorldCause::kFloats:
            return "floats are coarse so far from the origin of its mesh: move the mesh there, and its node "
                   "back";
        case WorldCause::kTexel:
            return "it is finer than the texels: bake with --budget " +
                   bytesWord(roundBudget(2 * gpuBytesOf(*field))) +
                   ", which makes them about 0.7 times as wide";
        case WorldCause::kMesh:
            break;
    }
    return "more than texels are wide: its mesh may be open there, or faces cross; mend it, or name what it "
           "is by "
           "--as " +
           shellQuoted((body().node.empty() ? body().mesh : body().node) + "=solid") + ", shell or terrain";
}

std::string worldCheckText(const WorldField& field, const std::string& name, const WorldAccuracy* accuracy) {
    std::string text = name + ": " + countText(field.world().bodies.size(), "body", "bodies") + " of " +
                       countText(field.world().colliders.size(), "collider") + ", " +
                       bytesText(gpuBytesOf(field));
    if (accuracy == nullptr) {
        return text + "; every container is there, and as the world has it\n";
    }
    const std::uint64_t points = accuracy->bodies.front().points;
    text += "\n" + percentText(accuracy->all.total()) +
            " of the points near the surface are on the wrong side (" +
            percentText(accuracy->all.false_inside) + " inside by error, " +
            percentText(accuracy->all.false_outside) + " outside), of " + countText(points, "point") +
            " for each body\n" + verdictOf(*accuracy, field.world().unit).text + "\n";
    for (const LostParts& mesh : accuracy->lost) {
        text += (&mesh == &accuracy->lost.front() ? "\nLost parts, each by its own size:\n  " : "  ") +
                mesh.mesh + ": " + mesh.text + "\n";
    }
    if (accuracy->worst.empty()) {
        return text;
    }
    std::vector<std::vector<std::string>> rows = {
        {"worst body", "node", "mesh", "wrong>", "for example at", "off by>", "texels>"}};
    const std::string& unit = field.world().unit;
    for (std::size_t i = 0; i < accuracy->worst.size(); ++i) {
        const BodyAccuracy& body = accuracy->bodies[accuracy->worst[i]];
        const WorldPlace& place = accuracy->places[i];
        rows.push_back({std::to_string(accuracy->worst[i]), body.node, body.mesh,
                        percentText(body.wrong.total()), positionText(body.place),
                        lengthText(place.distance, unit),
                        place.texel > 0.0 ? lengthText(place.texel, unit) : "-"});
    }
    return text + "\n" + table(rows) + adviceLines(field, *accuracy);
}

void fields(FieldVisitor& visit, const WorldPlaceReport& report) {
    const bool schema = report.field == nullptr;
    const WorldPlace& place = schema ? kNone<WorldPlace> : report.place();
    const BodyAccuracy& body = schema ? kNone<BodyAccuracy> : report.body();
    visit("body", schema ? std::size_t{0} : report.accuracy.worst[report.number],
          {"Index of the body in bodies"});
    visit("node", body.node, {"Name of its node in the level"});
    visit("mesh", body.mesh, {"Name of its mesh"});
    visit("wrong_percent", body.wrong.total(),
          {"Share of the points near it that are on the wrong side", "%", kPercentRange});
    visit("position", body.place, {"A typical point on the wrong side, in the world", "[x, y, z]"});
    visit("normal", place.normal, {"Of the surface beside it, outwards", "[x, y, z]"});
    visit("distance", place.distance, {"From that surface", "world units", kFromZero});
    visit("texel", place.texel,
          {"Side of the texels of the body that decides there; 0: none does", "world units", kFromZero});
    visit(
        "cause", place.cause,
        {"moved: the world has the node elsewhere; texel: the point is less than a texel and a half from the "
         "surface; mesh: it is farther"});
    visit("advice", schema ? std::string() : report.advice(),
          {"What to do, one sentence; empty of a body with at most 1 % wrong"});
}

void fields(FieldVisitor& visit, const LostParts& parts) {
    visit("mesh", parts.mesh, {"Name of the mesh"});
    visit("lost", parts.lost, {"Parts that its collider loses, each judged by its own size", {}, kFromOne});
    visit("text", parts.text, {"How many of how many, the largest, and what would keep it"});
}

void fields(FieldVisitor& visit, const BodyAccuracy& body) {
    visit("node", body.node, {"Name of its node in the level"});
    visit("mesh", body.mesh, {"Name of its mesh"});
    visit("points", body.points, {"Points near its surface", {}, kFromOne});
    fields(visit, body.wrong);
    visit("tiles", body.tiles,
          {"Bodies of the world that follow those of the body before: several of a mesh in tiles; 0 of all "
           "if the level has other nodes"});
    visit("place", body.place,
          {"A typical point on the wrong side, in the world; the body's position without any", "[x, y, z]"});
}

void fields(FieldVisitor& visit, const WorldCheckJson& report) {
    const World& world = report.field != nullptr ? report.field->world() : kNone<World>;
    const WorldAccuracy& accuracy = report.accuracy != nullptr ? *report.accuracy : kNone<WorldAccuracy>;
    toolField(visit);
    visit("file", report.file, {"File of the world"});
    visit("unit", world.unit, {"Unit of lengths: m, or empty"});
    visit("bodies", world.bodies.size(), {"Bodies"});
    visit("colliders", world.colliders.size(), {"Colliders"});
    visit("gpu_bytes", report.field != nullptr ? gpuBytesOf(*report.field) : std::uint64_t{0},
          {"Bytes that the colliders take on the GPU", "bytes"});
    visit("verdict",
          report.accuracy != nullptr ? std::optional(verdictOf(accuracy, world.unit)) : std::nullopt,
          {"Summary; null without --mesh"});
    visit("accuracy",
          groupIf(report.accuracy != nullptr,
                  [&](FieldVisitor& inner) {
                      fields(inner, accuracy.all);
                      inner("max_error_percent", report.max_error,
                            {"--max-error; null without it", "%", kPercentRange});
                      inner("worst", accuracy.worst,
                            {"Indices of the bodies that are most often wrong, the worst first"});
                      inner("places", placesOf(report),
                            {"Of those the place where each is typically wrong, and what to do"});
                      inner("lost_parts", accuracy.lost, {"Meshes that lose parts"});
                      inner("ignored_parts", accuracy.ignored,
                            {"Parts that the grade ignores because they are small; sizes in the world"});
                      inner("bodies", accuracy.bodies, {"Bodies, in the order of the level"});
                      inner("warnings", accuracy.warnings, {"Warnings, one line each"});
                      inner("seconds", accuracy.seconds, {"Time of the measurement", "s", kFromZero});
                  }),
          {"The world measured against its level; null without --mesh"});
}

}  // namespace relief
