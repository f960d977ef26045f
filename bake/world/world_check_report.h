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

template <class Visitor, FieldsOf<BodyAccuracy> B>
void fields(Visitor& visit, B& body) {
    visit("node", body.node, {"Name of its node in the level"});
    visit("mesh", body.mesh, {"Name of its mesh"});
    visit("points", body.points, {"Points near its surface", {}, kFromOne});
    fields(visit, body.wrong);
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
                      inner("bodies", accuracy.bodies, {"Bodies, in the order of the level"});
                      inner("warnings", accuracy.warnings, {"Warnings, one line each"});
                      inner("seconds", accuracy.seconds, {"Time of the measurement", "s", kFromZero});
                  }),
          {"The world measured against its level; null without --mesh"});
}

}  // namespace relief
