// A collider measured against the mesh that it was baked from: what `relief check --mesh` reports and `relief view --mesh`
// shows.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bake/cli/import_options.h"
#include "bake/cli/recorded_bake.h"
#include "bake/measure/accuracy.h"
#include "bake/measure/part_accuracy.h"
#include "bake/measure/worst_places.h"
#include "bake/mesh/mesh_query.h"
#include "bake/mesh/prepared_mesh.h"
#include "bake/report/check_report.h"
#include "bake/shape/shape.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace relief {

struct MeshCheckSettings {
    std::string mesh;
    std::uint64_t samples = 200'000;
    std::uint64_t seed = 1;
    std::optional<float> detail;  ///< smaller parts do not count, object units
    ImportSettings import;
};

/// Adds --mesh, and --samples, --seed and --detail, which need it.
/// \return --mesh
CLI::Option* addMeshCheckOptions(CLI::App& verb, MeshCheckSettings& settings);

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
    std::vector<std::string> warnings;  ///< one line each; already logged
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

/// The command of a command line. \param options  its words, without --mesh: "--samples=1000".
/// Errors: kUsage, as `relief check` has them.
[[nodiscard]] Result<MeshCheckSettings> meshCheckSettingsOf(std::vector<std::string> options,
                                                            const std::string& mesh);

/// Before the long work. Errors: kLimit (--samples).
[[nodiscard]] Result<void> prepareMeshCheck(const MeshCheckSettings& settings);

/// Imports the mesh, measures, and looks for the worst places. Logs warnings.
/// \param given       as finishMesh leaves it: instead of the file that the settings name.
/// \param checkpoint  called between stages; what it throws comes out of here and ends the check.
/// Errors: those of importMeshInWorker, of the shapes and of Embree; kInvalidInput (the mesh of another collider).
[[nodiscard]] Result<MeshCheck> checkAgainstMesh(
    const MeshCheckSettings& settings, Collider collider, std::optional<TriangleMesh> given = {},
    const std::function<void()>& checkpoint = [] {});

}  // namespace relief
