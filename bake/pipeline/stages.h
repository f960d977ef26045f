// SPDX-License-Identifier: Apache-2.0
// The stages of a bake. Each is a function of the values that the stages before it made.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bake/maps/budget_search.h"
#include "bake/materials/material_tree.h"
#include "bake/measure/self_check.h"
#include "bake/pipeline/bake_request.h"
#include "bake/repair/repair.h"
#include "bake/shape/shape.h"
#include "formats/animation/animated_mesh.h"
#include "formats/base/file_guard.h"
#include "formats/base/result.h"

namespace relief {

/// Follows a bake. Each function may be empty, and may throw: its exceptions propagate out of bake().
struct BakeWatcher {
    std::function<void(const char* stage)> begin;  ///< "baking the maps"
    std::function<void(double share)> progress;    ///< of the stage, in [0, 1]; any thread calls it
    std::function<void()> checkpoint;              ///< within a stage without shares; any thread calls it
    std::function<void(const BudgetTry&)> tried;   ///< of a search for the least budget
    std::function<void(const TriangleMesh&)> imported;  ///< as it came
    FileGuard* files = nullptr;  ///< gets the inputs that are known only after the import
};

/// Calls a function of a watcher that may be empty.
template <class... Arguments>
void notify(const std::function<void(Arguments...)>& function, Arguments... arguments) {
    if (function) {
        function(arguments...);
    }
}

struct SourceMesh {
    TriangleMesh mesh;                          ///< of an animated mesh its rest pose
    std::optional<AnimatedMesh> animated = {};  ///< with --animated
};

/// Reads the mesh of a request. Errors: those of importMeshInWorker and importAnimatedInWorker.
[[nodiscard]] Result<SourceMesh> importSource(const BakeRequest& request, const BakeSettings& settings);

/// A mesh that is ready to be baked. Copies share it.
struct SolidMesh {
    std::uint64_t unused_vertices = 0;  ///< of the mesh file; repair discards this count
    RepairedMesh mesh;
    ShapeReport shape;
    SurfaceParts parts;
    std::shared_ptr<const MaterialSource> materials;  ///< null: none are kept
    std::optional<AnimatedMesh> animated;             ///< with --animated
    std::optional<PreparedMesh> imported;  ///< as it came, if it was repaired and --max-error measures it

    /// It is the same with any budget: it has no shells.
    [[nodiscard]] bool suitsAnyBudget() const { return shape.sheets == 0; }
};

/// Repairs a mesh, and makes a solid of it. Errors: kUsage (--thickness); those of repairMesh, materialSource and makeSolid.
[[nodiscard]] Result<SolidMesh> solidOf(const BakeRequest& request, SourceMesh source,
                                        const BakeWatcher& watcher);

/// The solid of a mesh that has been wound outwards: the mesh itself with --holes keep.
/// Errors: those of parseShapeOptions and shapeMesh.
[[nodiscard]] Result<ShapedMesh> makeSolid(const BakeRequest& request, const PreparedMesh& mesh);

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

struct BakedMaps {
    Baked baked = {};
    std::optional<PatchesReport> patches = {};
    double search_ms = 0.0;  ///< of --max-error
};

/// The named maps of a solid, or patches for a budget, a texel or an error.
/// Errors: those of bake(mesh), bakePatchesWithin and bakeForError; kDifference: floats are too coarse for --max-error.
[[nodiscard]] Result<BakedMaps> bakeMaps(const BakeRequest& request, const BakeSettings& settings,
                                         const SolidMesh& solid, const BakeWatcher& watcher);

/// The maps of a solid, by their names, or patches for its budget (not for an error). Errors: as bake.
[[nodiscard]] Result<Baked> bakeSolid(const BakeRequest& request, const PreparedMesh& solid);

/// The warnings of a bake: of the import, the parts and the unit, then of the maps, then of the measurement.
/// \param check  null: the collider is not measured.
[[nodiscard]] std::vector<std::string> warningsOf(const BakeRequest& request, const SolidMesh& solid,
                                                  const Baked& baked, const SelfCheck* check);

/// \param nodes  of the source, that show something.
[[nodiscard]] std::vector<std::string> noticesOf(const SolidMesh& solid, std::size_t nodes);

}  // namespace relief
