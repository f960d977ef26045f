// SPDX-License-Identifier: Apache-2.0
// A collider measured against the mesh that it was baked from: for `relief check --mesh`, `relief view --mesh` and
// relief.check() in Python.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bake/measure/accuracy.h"
#include "bake/measure/part_accuracy.h"
#include "bake/measure/worst_places.h"
#include "bake/mesh/mesh_query.h"
#include "bake/mesh/prepared_mesh.h"
#include "bake/pipeline/bake_request.h"
#include "bake/shape/shape.h"
#include "bake/verdict/check_report.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

struct CheckRequest {
    std::string mesh;  ///< a file
    std::uint64_t samples = 200'000;
    std::uint64_t seed = 1;
    std::optional<float> detail;  ///< smaller parts do not count, object units
    ImportOptions import;
    ImportLimits import_limits;
};

/// Those that go without the import's.
void measurementFields(FieldVisitor& visit, CheckRequest& request);

void fields(FieldVisitor& visit, CheckRequest& request);

/// The truth of a mesh, and how far the collider is from it.
struct Measured {
    TruthSamples samples;
    ColliderAccuracy accuracy;
};

/// A check against a mesh, and what its stages leave for the next.
struct MeshCheck {
    Collider collider;
    PreparedMesh imported{TriangleMesh()};  ///< wound outwards
    /// The solid that stands for it: where solids overlap, their winding decides what is inside.
    PreparedMesh mesh{TriangleMesh()};
    ShapeReport shape;
    RecordedBake recorded;
    PreparedMesh baked{TriangleMesh()};  ///< the same of the repaired mesh; `mesh` without a repair
    std::optional<MeshQuery> query;      ///< of what is judged: `baked`
    bool same_file = false;
    std::vector<std::string> warnings;  ///< one line each
    bool watertight = false;
    Measured original;
    std::optional<Measured> repaired;  ///< if the collider is of a repaired mesh
    SurfaceParts parts;                ///< of what is judged
    PartsAccuracy part_accuracy;
    std::vector<WorstPlace> places;
    std::vector<Advice> advice;  ///< left to the caller, for it takes bakes

    /// Against the mesh that was baked.
    [[nodiscard]] const Measured& judged() const { return repaired ? *repaired : original; }
    [[nodiscard]] double wrongPercent() const { return judged().accuracy.field.near.total(); }
    /// Against the mesh as it came; and no part is lost. \param max_error  percent; nullopt: anything passes.
    [[nodiscard]] bool passes(std::optional<float> max_error) const;
};

/// The solid that was baked of a mesh. A thickness is recorded with every sheet. Sheets that a repair has replaced take that of
/// the default budget, whatever the bake's: the repaired mesh is compared with the same solid at each.
/// Errors: those of makeSolid.
[[nodiscard]] Result<ShapedMesh> recordedSolid(BakeRequest recorded, const PreparedMesh& mesh);

/// The same of the mesh as the recorded repair leaves it.
/// Errors: those of repairMesh and makeSolid; kUnsupported: a repair that takes too long to be made again.
[[nodiscard]] Result<ShapedMesh> repairedSolid(const BakeRequest& recorded, const PreparedMesh& mesh);

/// Imports the mesh, measures, and looks for the worst places.
/// \param given       as finishMesh leaves it: instead of the file that the request names.
/// \param checkpoint  called between stages; what it throws comes out of here and ends the check.
/// Errors: kLimit (samples); those of importMeshInWorker, of the shapes and of Embree; kInvalidInput (the mesh of another
/// collider); kUsage (options or names that need the mesh's file).
[[nodiscard]] Result<MeshCheck> check(
    const CheckRequest& request, Collider collider, std::optional<TriangleMesh> given = {},
    const std::function<void()>& checkpoint = [] {});

/// Commands that may help a collider that is wrong too often, tried in memory before they are advised. By the causes of the
/// places: twice the budget, cubes at places that no map sees, holes filled, the mesh wrapped. The best comes first, what does
/// not help last. The same for any number of threads, and on every machine: what is tried does not depend on the time it takes.
/// \param run  a check's result. \param mesh_file  as the command names it. \param output  of the advised bake
[[nodiscard]] std::vector<Advice> adviceFor(const MeshCheck& run, const std::string& mesh_file,
                                            const std::string& output);

}  // namespace relief
