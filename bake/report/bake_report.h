// SPDX-License-Identifier: Apache-2.0
// The report of `relief bake`: the maps and the time they took.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/maps/bake_maps.h"
#include "bake/maps/budget_search.h"
#include "bake/recipe/depfile.h"
#include "bake/repair/repair.h"
#include "bake/report/collider_report.h"
#include "bake/report/parts_report.h"
#include "bake/shape/shape.h"

namespace relief {

struct BakeTimes {
    double import_ms = 0.0;
    double search_ms = 0.0;  ///< of --max-error: all its bakes and measurements
    double check_ms = 0.0;   ///< of a bake that measures itself
    double write_ms = 0.0;
    double total_ms = 0.0;
};

/// Patches for a budget, a texel or an error.
struct PatchesReport {
    std::optional<std::uint64_t> budget;  ///< bytes; not of --texel without --budget
    std::uint64_t bytes = 0;              ///< on the GPU
    double texel = 0.0;                   ///< object units: least distance of two heights
    std::optional<float> wanted_texel;    ///< --texel, object units
    std::optional<double> max_error;      ///< percent; of --max-error, as are the next two
    double wrong_percent = 0.0;           ///< measured
    std::vector<BudgetTry> tries;
};

struct BakeSummary {
    const TriangleMesh& mesh;
    const Baked& baked;
    const std::optional<PatchesReport>& patches;
    const BakeTimes& times;
    const RepairReport& care;
    const ShapeReport& shape;
    std::optional<Verdict> verdict;     ///< if measured
    std::uint64_t unused_vertices = 0;  ///< of the mesh file (TriangleMesh)
    bool verbose = false;
    const AnimatedMesh* animated = nullptr;  ///< if it moves
};

/// For people: a few lines and a table. \param output  as on the command line
[[nodiscard]] std::string bakeText(const BakeSummary& summary, const std::string& output,
                                   std::size_t file_size);
/// One line with its end: "shape: 2 solids, 1 sheet (0.01 m thick)"; empty where no shapes were made.
[[nodiscard]] std::string shapeText(const ShapeReport& report, const std::string& unit);
/// Nothing where no shapes were made.
[[nodiscard]] std::optional<ShapeReport> madeShapes(const ShapeReport& report);

// --- The same as fields.

struct BakedMapReport {
    ColliderMapReport map = {};
    MapReport baked = {};

    /// Share of the texels that hold a surface.
    [[nodiscard]] double coverage() const {
        return static_cast<double>(baked.covered) / static_cast<double>(baked.texels);
    }
};

void fields(FieldVisitor& visit, const BakedMapReport& report);
void fields(FieldVisitor& visit, const ColliderReport<BakedMapReport>& report);

void fields(FieldVisitor& visit, const PatchesReport& report);

void fields(FieldVisitor& visit, const RepairReport& care);

void fields(FieldVisitor& visit, const InputFile& input);

/// "tool", the program and its version.
void toolField(FieldVisitor& visit);
/// The last fields of a bake into a folder.
/// \param removed  containers
void folderFields(FieldVisitor& visit, const std::vector<std::string>& removed, double ms,
                  const std::vector<InputFile>& inputs, const std::vector<std::string>& warnings);

}  // namespace relief
