// SPDX-License-Identifier: Apache-2.0
// The report of relief check of a world.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/report/parts_report.h"
#include "bake/report/report_text.h"
#include "bake/world/world_check.h"
#include "formats/fields/field.h"

namespace relief {

/// The worse of gradeOf(accuracy.all) and those of its meshes' parts.
[[nodiscard]] Verdict verdictOf(const WorldAccuracy& accuracy, const std::string& unit);

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

void fields(FieldVisitor& visit, const WorldPlaceReport& report);

void fields(FieldVisitor& visit, const BodyAccuracy& body);
void fields(FieldVisitor& visit, const LostParts& parts);

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

void fields(FieldVisitor& visit, const WorldCheckJson& report);

}  // namespace relief
