// The report of relief check of a world.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/report/report_text.h"
#include "bake/world/world_check.h"
#include "formats/fields/field.h"

namespace relief {

/// The contents of the world, and how wrong it is. \param accuracy  null without a level.
[[nodiscard]] std::string worldCheckText(const WorldField& field, const std::string& name,
                                         const WorldAccuracy* accuracy);

[[nodiscard]] std::uint64_t gpuBytesOf(const WorldField& field);

/// One of the worst places, and what to do about it.
struct WorldPlaceReport {
    const WorldField* field = nullptr;
    const WorldAccuracy& accuracy = kNone<WorldAccuracy>;
    std::size_t number = 0;  ///< in accuracy.places

    [[nodiscard]] const BodyAccuracy& body() const { return accuracy.bodies[accuracy.worst[number]]; }
    [[nodiscard]] const WorldPlace& place() const { return accuracy.places[number]; }
    /// One sentence; empty of a body that is good all the same.
    [[nodiscard]] std::string advice() const;
};

template <class Visitor, FieldsOf<WorldPlaceReport> R>
void fields(Visitor& visit, R& report) {
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

template <class Visitor, FieldsOf<BodyAccuracy> B>
void fields(Visitor& visit, B& body) {
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

/// `relief check world.json --json`
struct WorldCheckJson {
    std::string file{};
    const WorldField* field = nullptr;
    const WorldAccuracy* accuracy = nullptr;  ///< null without --mesh
    std::optional<float> max_error{};
};

[[nodiscard]] inline std::vector<WorldPlaceReport> placesOf(const WorldCheckJson& report) {
    std::vector<WorldPlaceReport> places;
    for (std::size_t i = 0; report.accuracy != nullptr && i < report.accuracy->places.size(); ++i) {
        places.push_back({report.field, *report.accuracy, i});
    }
    return places;
}

template <class Visitor, FieldsOf<WorldCheckJson> R>
void fields(Visitor& visit, R& report) {
    const World& world = report.field != nullptr ? report.field->world() : kNone<World>;
    const WorldAccuracy& accuracy = report.accuracy != nullptr ? *report.accuracy : kNone<WorldAccuracy>;
    visit("tool", std::string("relief ") + RELIEF_VERSION, {"Name and version of the program"});
    visit("file", report.file, {"File of the world"});
    visit("unit", world.unit, {"Unit of lengths: m, or empty"});
    visit("bodies", world.bodies.size(), {"Bodies"});
    visit("colliders", world.colliders.size(), {"Colliders"});
    visit("gpu_bytes", report.field != nullptr ? gpuBytesOf(*report.field) : std::uint64_t{0},
          {"Bytes that the colliders take on the GPU", "bytes"});
    visit("accuracy",
          groupIf(report.accuracy != nullptr,
                  [&](auto& inner) {
                      fields(inner, accuracy.all);
                      inner("max_error_percent", report.max_error,
                            {"--max-error; null without it", "%", kPercentRange});
                      inner("worst", accuracy.worst,
                            {"Indices of the bodies that are most often wrong, the worst first"});
                      inner("places", placesOf(report),
                            {"Of those the place where each is typically wrong, and what to do"});
                      inner("bodies", accuracy.bodies, {"Bodies, in the order of the level"});
                      inner("warnings", accuracy.warnings, {"Warnings, one line each"});
                      inner("seconds", accuracy.seconds, {"Time of the measurement", "s", kFromZero});
                  }),
          {"The world measured against its level; null without --mesh"});
}

}  // namespace relief
