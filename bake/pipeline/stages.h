// SPDX-License-Identifier: Apache-2.0
// The stages of a bake. Each is a function of the results of the previous stages.
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
    std::function<void(double share)> progress;  ///< fraction of the stage, in [0, 1]; called from any thread
    std::function<void()> checkpoint;  ///< called in stages that report no progress, from any thread
    std::function<void(const BudgetTrial&)> tried;      ///< during the search for the smallest budget
    std::function<void(const TriangleMesh&)> imported;  ///< the mesh as imported
    FileGuard* files = nullptr;  ///< receives the inputs that are known only after the import
};

/// Calls a function of a watcher, unless the function is empty.
template <class... Arguments>
void notify(const std::function<void(Arguments...)>& function, Arguments... arguments) {
    if (function) {
        function(arguments...);
    }
}

struct SourceMesh {
    TriangleMesh mesh;                          ///< the rest pose of an animated mesh
    std::optional<AnimatedMesh> animated = {};  ///< with --animated
};

/// Reads the mesh of a request. Errors: those of importMeshInWorker and importAnimatedInWorker.
[[nodiscard]] Result<SourceMesh> importSource(const BakeRequest& request, const BakeSettings& settings);

/// A mesh ready to be baked. Copies share its data.
struct SolidMesh {
    std::uint64_t unused_vertices = 0;  ///< in the mesh file; repair discards this count
    RepairedMesh mesh;
    ShapeReport shape;
    SurfaceParts parts;
    std::shared_ptr<const MaterialSource> materials;  ///< null: no materials are kept
    std::optional<AnimatedMesh> animated;             ///< with --animated
    std::optional<PreparedMesh> imported;  ///< the mesh before a repair, if --max-error measures against it

    /// Whether the solid is the same for any budget, because it has no shells.
    [[nodiscard]] bool isBudgetIndependent() const { return shape.sheets == 0; }
};

/// Repairs a mesh, and makes its solid. Errors: kUsage (--thickness); those of repairMesh, materialSource and
/// makeSolid.
[[nodiscard]] Result<SolidMesh> solidOf(const BakeRequest& request, SourceMesh source,
                                        const BakeWatcher& watcher);

/// Returns the solid of an outward-wound mesh, or, with --holes keep or --animated, the mesh itself. Errors: those of
/// parseShapeOptions and shapeMesh.
[[nodiscard]] Result<ShapedMesh> makeSolid(const BakeRequest& request, const PreparedMesh& mesh);

/// Patches limited by a budget, a texel or an error.
struct PatchesReport {
    std::optional<std::uint64_t> budget;   ///< bytes; nullopt for --texel without --budget
    std::uint64_t bytes = 0;               ///< on the GPU
    double texel = 0.0;                    ///< object units: minimum distance between heights
    std::optional<float> requested_texel;  ///< --texel, object units
    std::optional<double> max_error;       ///< percent; this and the next two: only with --max-error
    double wrong_percent = 0.0;            ///< measured
    std::vector<BudgetTrial> tries;
};

struct BakedMaps {
    Baked baked = {};
    std::optional<PatchesReport> patches = {};
    double search_ms = 0.0;  ///< of the search for --max-error
};

/// Bakes the named maps of a solid, or patches limited by a budget, a texel or an error.
/// Errors: those of bake (bake_maps.h), bakePatchesWithin and bakeForError; kDifference (floats are too coarse for
/// --max-error).
[[nodiscard]] Result<BakedMaps> bakeMaps(const BakeRequest& request, const BakeSettings& settings,
                                         const SolidMesh& solid, const BakeWatcher& watcher);

/// Bakes the named maps of a solid, or patches for the budget or texel of the request. Ignores `max_error`.
/// Errors: those of bake (bake_maps.h) and bakePatchesWithin.
[[nodiscard]] Result<Baked> bakeSolid(const BakeRequest& request, const PreparedMesh& solid);

/// Returns the warnings about the import, the parts, the unit, the names of --as, the maps and the measurement.
/// \param check  null if the collider is not measured.
[[nodiscard]] std::vector<std::string> warningsOf(const BakeRequest& request, const SolidMesh& solid,
                                                  const Baked& baked, const SelfCheck* check);

/// \param nodes  number of visible nodes of the source.
[[nodiscard]] std::vector<std::string> noticesOf(const SolidMesh& solid, std::size_t nodes);

}  // namespace relief
