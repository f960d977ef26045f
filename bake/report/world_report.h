// SPDX-License-Identifier: Apache-2.0
// Reports of a bake of a level and of a check of a world, for people and programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/report/bake_report.h"
#include "bake/report/collider_report.h"
#include "bake/verdict/parts_report.h"
#include "bake/verdict/report_text.h"
#include "bake/world/world_bake.h"
#include "bake/world/world_check.h"
#include "formats/fields/field.h"

namespace relief {

/// Returns a table of the colliders if `verbose`, and a summary line.
[[nodiscard]] std::string worldBakeText(const WorldBakeResult& result, const std::string& folder, double ms,
                                        bool verbose);

struct WorldColliderReport {
    const WorldColliderResult& collider = kNone<WorldColliderResult>;
};

void fields(FieldVisitor& visit, const WorldColliderReport& report);

/// The report of `relief bake --world --json`.
struct WorldBakeJson {
    const WorldBakeResult& result = kNone<WorldBakeResult>;
    std::string output{};
    double ms = 0.0;
};

void fields(FieldVisitor& visit, const WorldBakeJson& report);

// --- Check.

/// Returns the worse of gradeOf(accuracy.all) and the grades of the parts of its meshes.
[[nodiscard]] Verdict verdictOf(const WorldAccuracy& accuracy, const std::string& unit);

/// Returns the contents of the world, and its accuracy. \param accuracy  null without a level.
[[nodiscard]] std::string worldCheckText(const WorldField& field, const std::string& name,
                                         const WorldAccuracy* accuracy);

[[nodiscard]] std::uint64_t gpuBytesOf(const WorldField& field);

/// One of the worst places, and advice.
struct WorldPlaceReport {
    const WorldField* field = nullptr;
    const WorldAccuracy& accuracy = kNone<WorldAccuracy>;
    std::size_t number = 0;  ///< index in accuracy.places

    [[nodiscard]] const BodyAccuracy& body() const { return accuracy.bodies[accuracy.worst[number]]; }
    [[nodiscard]] const WorldPlace& place() const { return accuracy.places[number]; }
    /// Returns one sentence; empty if the body is good anyway.
    [[nodiscard]] std::string advice() const;
};

void fields(FieldVisitor& visit, const WorldPlaceReport& report);

void fields(FieldVisitor& visit, const BodyAccuracy& body);
void fields(FieldVisitor& visit, const LostParts& parts);

/// The report of `relief check world.json --json`.
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

void fields(FieldVisitor& visit, const WorldCheckJson& report);

}  // namespace relief
