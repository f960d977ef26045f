// SPDX-License-Identifier: Apache-2.0
// Bakes a mesh into a collider: mesh -> views -> samples -> texels -> collider.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bake/mesh/prepared_mesh.h"
#include "bake/patches/patch_planner.h"
#include "bake/views/map_spec.h"
#include "formats/base/enum_words.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

/// How maps with Decode::kPlane, which include all patches, classify doubtful space. kInside: as solid, so that no
/// particle enters a wall. kOutside: as free, so that no free volume is lost.
enum class Prefer : std::uint8_t { kNeither, kInside, kOutside };

template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<Prefer>{"neither", "inside", "outside"};

/// The fitting effort for maps with Decode::kPlane: rays along each side of a texel's footprint, and rounds of search
/// among neighbouring normals; for patches, the density of samples and the number of cells tried.
enum class Quality : std::uint8_t { kFast, kNormal, kBest };

template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<Quality>{"fast", "normal", "best"};

struct BakeOptions {
    std::vector<MapSpec> maps;       ///< empty: paperMapSpecs()
    std::uint32_t resolution = 512;  ///< texels along a side, for maps whose spec has no size
    Quality quality = Quality::kNormal;
    Prefer prefer = Prefer::kNeither;
    /// MapSpec::texel for bakePatchesWithin(), object units; bake() ignores it. 0: limited only by the budget.
    float texel = 0.0F;
    std::optional<Bounds> roots_contain{};  ///< PatchOptions::roots_contain
    unsigned threads = 0;                   ///< 0: all cores; the result does not depend on it
    /// Called periodically with the fraction of the work done, in [0, 1]; from any thread, never concurrently. Its
    /// exceptions end bake() and propagate.
    std::function<void(double)> progress;
};

struct MapReport {
    MapSpec spec;               ///< with all defaults filled in
    std::uint64_t covered = 0;  ///< texels with a surface
    std::uint64_t texels = 0;
    bool coarser = false;  ///< the texel of patches is larger than requested, because of the budget

    /// Returns the fraction of the texels that store a surface.
    [[nodiscard]] double coverage() const {
        return static_cast<double>(covered) / static_cast<double>(texels);
    }
};

struct BakeReport {
    double build_ms = 0.0;   ///< acceleration structure
    double trace_ms = 0.0;   ///< rays
    double encode_ms = 0.0;  ///< normals and texels
    double fit_ms = 0.0;     ///< maps with Decode::kPlane, including their rays
    std::vector<MapReport> maps;
    std::vector<std::string> warnings;  ///< likely errors in the options; one line each
};

struct Baked {
    Collider collider;
    BakeReport report;
};

/// Bakes the maps of a mesh.
/// Errors: kUsage and kLimit (a spec, the resolution, too many maps or texels), kFailure (Embree; no ray of any map
/// hits the mesh).
[[nodiscard]] Result<Baked> bake(const PreparedMesh& mesh, const BakeOptions& options);

/// Returns a warning if a mesh is more than 1000 times its size away from the origin, else nullopt.
[[nodiscard]] std::optional<std::string> coarseFloatsWarning(const TriangleMesh& mesh);
/// Estimates the percentage of points near the surface that are misclassified only because floats are coarse at the
/// coordinates of the mesh, regardless of the maps. Depends on the spacing of floats at the farthest corner, relative
/// to the standard deviation of the points' distance from the surface. At most 50.
[[nodiscard]] double wrongByFloats(const TriangleMesh& mesh);
/// Returns whether coarse floats cause more than half of `wrong_percent`, so that more bytes do not help.
[[nodiscard]] inline bool floatsLimit(const TriangleMesh& mesh, double wrong_percent) {
    return 2.0 * wrongByFloats(mesh) > wrong_percent;
}

/// Returns the error curve of trees of patches (planErrors in patch_planner.h).
/// \param bytes  of the largest tree, kPatchBytesMin to kPatchBytesMax.
/// Errors: kFailure (Embree).
[[nodiscard]] Result<ErrorCurve> planErrors(const PreparedMesh& mesh, const BakeOptions& options,
                                            std::uint64_t bytes);

}  // namespace relief
