// SPDX-License-Identifier: Apache-2.0
#include "bake/report/world_report.h"

#include <algorithm>
#include <utility>

#include "bake/verdict/check_report.h"
#include "formats/base/text.h"
#include "formats/fields/text.h"

namespace relief {
namespace {

std::uint64_t gpuBytesOf(const WorldField& field) {
    std::uint64_t bytes = 0;
    for (const Collider& collider : field.colliders()) {
        bytes += collider.texelBytes();
    }
    return bytes;
}

/// Returns advice in one sentence; empty if the body is good already.
std::string adviceFor(const WorldField& field, const BodyAccuracy& body, WorldCause cause) {
    if (body.wrong.total() <= kGoodPercent) {
        return "";
    }
    switch (cause) {
        case WorldCause::kMoved:
            return "its pose in the world differs from the level: bake the level again";
        case WorldCause::kPrecision:
            return "floats are coarse this far from the origin of its mesh: move the mesh to the origin, and "
                   "its node by the opposite offset";
        case WorldCause::kTexel:
            return "its details are finer than the texels: bake with --budget " +
                   bytesWord(roundBudget(2 * gpuBytesOf(field))) +
                   ", which makes them about 0.7 times as wide";
        case WorldCause::kMesh:
            break;
    }
    return "the error is larger than the texels: its mesh may be open or intersect itself there; repair it, "
           "or set its kind with --as " +
           shellQuoted((body.node.empty() ? body.mesh : body.node) + "=solid") + ", shell or terrain";
}

/// Returns each distinct advice once, after the bodies that it applies to.
std::string adviceLines(const WorldField& field, const WorldAccuracy& accuracy) {
    std::vector<std::pair<std::string, std::string>> lines;  // advice, then bodies
    for (std::size_t i = 0; i < accuracy.places.size(); ++i) {
        const std::string advice =
            adviceFor(field, accuracy.bodies[accuracy.worst[i]], accuracy.places[i].cause);
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
        {"collider", "bodies>", "area>", "scale>", "share>", "size>", "wrong>", "state"}};
    for (const WorldColliderResult& c : result.colliders) {
        rows.push_back({c.mesh + (c.tile.empty() ? "" : " " + c.tile), std::to_string(c.bodies),
                        shortNumber(c.area), shortNumber(c.largest_scale),
                        c.budget ? bytesText(*c.budget) : "-", bytesText(c.gpu_bytes),
                        c.wrong ? percentText(c.wrong->total()) : "-", std::string(wordOf(c.state))});
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
                " referenced only by the previous world\n";
    }
    return text;
}

void fields(FieldVisitor& visit, const WorldColliderResult& c) {
    const bool failed = c.state == WorldColliderState::kFailed;
    visit("mesh", c.mesh, {"Name of its mesh in the level"});
    visit("tile", c.tile, {"Position among the tiles of its mesh, such as 0-1-0; empty for the whole mesh"});
    visit("file", c.file, {"Container, relative to the folder of the world"});
    visit("state", c.state, {"State of the container"});
    visit("bodies", c.bodies, {"Number of its bodies", {}, kFromOne});
    visit("area", c.area, {"Area of the mesh's surface", "object units squared", kFromZero});
    visit("largest_scale", c.largest_scale, {"Largest scale of its bodies", {}, kFromZero});
    visit("budget", c.budget,
          {"Share of the budget for its mesh; null for --texel without --budget", "bytes"});
    visit("bytes", c.bytes, {"Size of the container; 0 if it failed", "bytes"});
    visit("gpu_bytes", c.gpu_bytes, {"Size on the GPU; 0 if it failed", "bytes"});
    visit("coarse", c.coarse,
          {"Coarse version that replaces it until it is on the GPU; null if that would save little"});
    visit("hash", c.hash, {.help = "XXH3-128 of the container; empty if it failed", .pattern = kHashPattern});
    visit("wrong_percent", c.wrong ? std::optional(c.wrong->total()) : std::nullopt,
          {"Points near the mesh's surface that are on the wrong side; null unless it was baked "
           "and measured",
           "%", kPercentRange});
    visit("verdict", c.verdict, {"Summary; null unless it was baked and measured"});
    visit("ignored_parts", c.ignored,
          {"Parts of its mesh that the grade ignores because they are small; sizes in world units"});
    visit("ms", c.ms,
          {"Time to bake its mesh; 0 if it was up to date, and for all tiles except the first", "ms",
           kFromZero});
    visit("warnings", c.warnings, {"Warnings, one line each"});
    visit("error", failed ? std::optional(c.error.message) : std::nullopt,
          {"Error message in one line; null if it did not fail"});
}

void fields(FieldVisitor& visit, const WorldBakeJson& report) {
    const WorldBakeResult& r = report.result;
    toolField(visit);
    visit("output", report.output, {"Folder of the world, as on the command line"});
    visit("written", r.written, {"Whether world.json was written; false if a collider failed"});
    visit("unit", r.world.unit, {"Unit of lengths: m, or empty if unknown"});
    visit("bodies", r.world.bodies.size(), {"Bodies"});
    visit("budget", r.budget,
          {"Budget of all colliders on the GPU; null for --texel without --budget", "bytes"});
    visit("gpu_bytes", r.gpuBytes(), {"Size of all colliders on the GPU", "bytes"});
    visit("baked", r.countOf(WorldColliderState::kBaked), {"Colliders that were baked"});
    visit("up_to_date", r.countOf(WorldColliderState::kUpToDate), {"Colliders that were already up to date"});
    visit("failed", r.countOf(WorldColliderState::kFailed), {"Colliders that failed"});
    folderFields(visit, r.removed, report.ms, r.inputs, r.warnings);
    visit("colliders", r.colliders, {"Colliders, in the order of the world"});
}

Verdict verdictOf(const WorldAccuracy& accuracy, const std::string& unit) {
    const bool lost = !accuracy.lost.empty();
    const std::string grade = lost ? "poor" : accuracy.coarse > 0 ? "fair" : "good";
    const std::string but = countText(lost ? accuracy.lost.size() : accuracy.coarse, "mesh", "meshes") +
                            (lost ? " lost parts" : " with coarse parts");
    return verdictOf(accuracy.all.total(), grade, but, accuracy.ignored, unit);
}

std::string worldCheckText(const WorldField& field, const std::string& name, const WorldAccuracy* accuracy) {
    std::string text = name + ": " + countText(field.world().bodies.size(), "body", "bodies") + " of " +
                       countText(field.world().colliders.size(), "collider") + ", " +
                       bytesText(gpuBytesOf(field));
    if (accuracy == nullptr) {
        return text + "; all containers exist and match the world\n";
    }
    const std::uint64_t points = accuracy->bodies.front().points;
    text += "\n" + percentText(accuracy->all.total()) +
            " of the points near the surface are on the wrong side (" +
            percentText(accuracy->all.false_inside) + " wrongly inside, " +
            percentText(accuracy->all.false_outside) + " wrongly outside), with " +
            countText(points, "point") + " per body\n" + verdictOf(*accuracy, field.world().unit).text + "\n";
    for (const LostParts& mesh : accuracy->lost) {
        text +=
            (&mesh == &accuracy->lost.front() ? "\nLost parts, each measured relative to its own size:\n  "
                                              : "  ") +
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
                        percentText(body.wrong.total()), positionText(body.position),
                        lengthText(place.distance, unit),
                        place.texel > 0.0 ? lengthText(place.texel, unit) : "-"});
    }
    return text + "\n" + table(rows) + adviceLines(field, *accuracy);
}

void fields(FieldVisitor& visit, const LostParts& parts) {
    visit("mesh", parts.mesh, {"Name of the mesh"});
    visit("lost", parts.lost,
          {"Parts that its collider loses, each measured relative to its own size", {}, kFromOne});
    visit("text", parts.text, {"Their number, the largest one, and how to keep it"});
}

void fields(FieldVisitor& visit, const BodyAccuracy& body) {
    visit("node", body.node, {"Name of its node in the level"});
    visit("mesh", body.mesh, {"Name of its mesh"});
    visit("points", body.points, {"Points near its surface", {}, kFromOne});
    fields(visit, body.wrong);
    visit("tiles", body.tiles,
          {"Number of its consecutive bodies in the world: several for a mesh in tiles; 0 for every body if "
           "the nodes of the level differ from the world"});
    visit("position", body.position,
          {"A typical point on the wrong side, world space; the body's position if there is none",
           "[x, y, z]"});
}

namespace {

/// One of the worst places.
struct WorldPlaceReport {
    std::size_t number = 0;  ///< index of the body
    const BodyAccuracy& body = kNone<BodyAccuracy>;
    const WorldPlace& place = kNone<WorldPlace>;
    std::string advice = {};
};

void fields(FieldVisitor& visit, const WorldPlaceReport& report) {
    const auto& [number, body, place, advice] = report;
    visit("body", number, {"Index of the body in bodies"});
    visit("node", body.node, {"Name of its node in the level"});
    visit("mesh", body.mesh, {"Name of its mesh"});
    visit("wrong_percent", body.wrong.total(),
          {"Points near it that are on the wrong side", "%", kPercentRange});
    visit("position", body.position, {"A typical point on the wrong side, world space", "[x, y, z]"});
    visit("normal", place.normal, {"Normal of the nearest surface, outwards", "[x, y, z]"});
    visit("distance", place.distance, {"Distance from that surface", "world units", kFromZero});
    visit("texel", place.texel,
          {"Side of the texels of the body that decides there; 0 if none decides", "world units", kFromZero});
    visit("cause", place.cause,
          {"moved: the node has another pose in the world; texel: the point is less than 1.5 texels from the "
           "surface; mesh: it is farther away"});
    visit("advice", advice, {"Advice in one sentence; empty if at most 1 % is wrong"});
}

std::vector<WorldPlaceReport> placesOf(const WorldCheckJson& report) {
    std::vector<WorldPlaceReport> places;
    for (std::size_t i = 0; report.accuracy != nullptr && i < report.accuracy->places.size(); ++i) {
        const std::size_t number = report.accuracy->worst[i];
        const BodyAccuracy& body = report.accuracy->bodies[number];
        const WorldPlace& place = report.accuracy->places[i];
        places.push_back({number, body, place, adviceFor(*report.field, body, place.cause)});
    }
    return places;
}

}  // namespace

void fields(FieldVisitor& visit, const WorldCheckJson& report) {
    const World& world = report.field != nullptr ? report.field->world() : kNone<World>;
    const WorldAccuracy& accuracy = report.accuracy != nullptr ? *report.accuracy : kNone<WorldAccuracy>;
    toolField(visit);
    visit("file", report.file, {"File of the world"});
    visit("unit", world.unit, {"Unit of lengths: m, or empty if unknown"});
    visit("bodies", world.bodies.size(), {"Bodies"});
    visit("colliders", world.colliders.size(), {"Colliders"});
    visit("gpu_bytes", report.field != nullptr ? gpuBytesOf(*report.field) : std::uint64_t{0},
          {"Size of all colliders on the GPU", "bytes"});
    visit("verdict",
          report.accuracy != nullptr ? std::optional(verdictOf(accuracy, world.unit)) : std::nullopt,
          {"Summary; null without --mesh"});
    visit("accuracy",
          groupIf(report.accuracy != nullptr,
                  [&](FieldVisitor& inner) {
                      fields(inner, accuracy.all);
                      inner("max_error_percent", report.max_error,
                            {"--max-error; null without it", "%", kPercentRange});
                      inner("worst", accuracy.worst, {"Indices of the worst bodies, the worst first"});
                      inner("places", placesOf(report),
                            {"A typical wrong place of each of these bodies, and advice"});
                      inner("lost_parts", accuracy.lost, {"Meshes that lose parts"});
                      inner("ignored_parts", accuracy.ignored,
                            {"Parts that the grade ignores because they are small; sizes in world units"});
                      inner("bodies", accuracy.bodies, {"Bodies, in the order of the level"});
                      inner("warnings", accuracy.warnings, {"Warnings, one line each"});
                      inner("seconds", accuracy.seconds, {"Time of the measurement", "s", kFromZero});
                  }),
          {"Accuracy of the world against its level; null without --mesh"});
}

}  // namespace relief
