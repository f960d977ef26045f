// SPDX-License-Identifier: Apache-2.0
// Measures a collider against the mesh that it was baked from, for `relief check --mesh`, `relief view --mesh` and
// relief.check() in Python.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bake/measure/accuracy.h"
#include "bake/measure/depth_proof.h"
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
    std::optional<float> min_part;  ///< smaller parts are ignored, object units
    ImportOptions import;
    ImportLimits import_limits;
};

/// Visits the fields of a check except the import options.
void measurementFields(FieldVisitor& visit, CheckRequest& request);

void fields(FieldVisitor& visit, CheckRequest& request);

/// The truth of a mesh, and the accuracy of the collider.
struct Measured {
    TruthSamples samples;
    ColliderAccuracy accuracy;
};

/// A check against a mesh, with the results of its stages.
struct MeshCheck {
    Collider collider;
    PreparedMesh imported{TriangleMesh()};  ///< wound outwards
    /// The solid of the imported mesh; overlaps of its solids are inside.
    PreparedMesh mesh{TriangleMesh()};
    ShapeReport shape;
    RecordedBake recorded;
    PreparedMesh baked{TriangleMesh()};  ///< solid of the repaired mesh; if not repaired, `mesh`
    std::optional<MeshQuery> query;      ///< of `baked`
    bool same_file = false;
    std::vector<std::string> warnings;  ///< one line each
    bool watertight = false;
    Measured original;
    std::optional<Measured> repaired;  ///< if the collider was baked from a repaired mesh
    SurfaceParts parts;                ///< of `baked`
    PartsAccuracy part_accuracy;
    std::vector<WorstPlace> places;
    DepthProof proof;            ///< against the mesh that was baked
    std::vector<Advice> advice;  ///< filled in by the caller, because it requires bakes

    /// The measurement against the mesh that was baked.
    [[nodiscard]] const Measured& judged() const { return repaired ? *repaired : original; }
    [[nodiscard]] double wrongPercent() const { return judged().accuracy.field.near.total(); }
    /// Whether the accuracy against the imported mesh is within the limit, and no part is lost.
    /// \param max_error  percent; nullopt always passes.
    [[nodiscard]] bool passes(std::optional<float> max_error) const;
};

/// Returns the solid that the recorded options make of a mesh. Its shells have the recorded thickness. If a repair
/// removed all sheets, no thickness is recorded; imported sheets then get the default thickness for the recorded texel
/// or, without a texel, for kBudgetDefault, so that colliders of all budgets are compared with the same solid.
/// Errors: those of makeSolid.
[[nodiscard]] Result<ShapedMesh> recordedSolid(BakeRequest recorded, const PreparedMesh& mesh);

/// Returns the solid of the mesh after the recorded repair.
/// Errors: those of repairMesh and makeSolid; kUnsupported (repeating the repair would take too long).
[[nodiscard]] Result<ShapedMesh> repairedSolid(const BakeRequest& recorded, const PreparedMesh& mesh);

/// Imports the mesh, measures the collider, and finds the worst places.
/// \param given       from finishMesh; used instead of the request's file.
/// \param checkpoint  called between stages; its exceptions end the check and propagate.
/// Errors: kLimit (samples); kInvalidInput (the mesh of another collider); kUsage (options or names that require the
/// mesh file); those of importMeshInWorker, recordedSolid and MeshQuery::build.
[[nodiscard]] Result<MeshCheck> check(
    const CheckRequest& request, Collider collider, std::optional<TriangleMesh> given = {},
    const std::function<void()>& checkpoint = [] {});

/// Suggests commands for a collider that is not accurate enough. Tries them in memory, except slow ones. The causes of
/// the worst places determine the commands: patches with twice the bytes, closed holes, thicker sheets, a wrapped mesh.
/// The best command comes first; commands that did not help come last. The result does not depend on the number of
/// threads or the machine, because the choice of trials does not depend on time.
/// \param run  result of a check. \param mesh_file, output  file names for the commands
[[nodiscard]] std::vector<Advice> adviceFor(const MeshCheck& run, const std::string& mesh_file,
                                            const std::string& output);

}  // namespace relief
