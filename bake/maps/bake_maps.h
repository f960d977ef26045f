// SPDX-License-Identifier: Apache-2.0
// The pipeline: mesh -> views -> samples -> texels -> collider.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bake/mesh/prepared_mesh.h"
#include "bake/patches/patch_planner.h"
#include "bake/views/map_spec.h"
#include "bake/views/prefer.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

struct BakeOptions {
    std::vector<MapSpec> maps;       ///< empty: paperMapSpecs()
    std::uint32_t resolution = 512;  ///< texels along a side, for maps whose spec names no size
    Quality quality = Quality::kNormal;
    Prefer prefer = Prefer::kNeither;
    std::uint64_t budget = 0;  ///< of patches, bytes, to be recorded; 0: none
    float texel = 0.0F;        ///< of patches for a budget, object units: MapSpec::texel; 0: by the budget
    std::optional<Bounds> roots_hold{};  ///< PatchOptions::roots_hold
    unsigned threads = 0;                ///< 0: all cores. Never changes the result.
    /// Called now and then, from any thread but from one at a time, with the share of the work done, in [0, 1]. It may throw:
    /// what it throws comes out of bake(), and ends it.
    std::function<void(double)> progress;
};

struct MapReport {
    MapSpec spec;               ///< complete
    std::uint64_t covered = 0;  ///< texels with a surface
    std::uint64_t texels = 0;
};

struct BakeReport {
    double build_ms = 0.0;   ///< acceleration structure
    double trace_ms = 0.0;   ///< rays
    double encode_ms = 0.0;  ///< normals and texels
    double fit_ms = 0.0;     ///< rays and planes of the maps whose decode is plane, and patches
    std::vector<MapReport> maps;
    std::vector<std::string> warnings;  ///< what is probably not meant; one line each
};

struct Baked {
    Collider collider;
    BakeReport report;
};

/// Errors: kUsage and kLimit (a spec, the resolution, too many maps or texels), kFailure (Embree; no ray of
/// any map meets the mesh).
[[nodiscard]] Result<Baked> bake(const PreparedMesh& mesh, const BakeOptions& options);

/// A line for a mesh more than 1000 times its size away from the origin; nullopt for others.
[[nodiscard]] std::optional<std::string> coarseFloatsWarning(const TriangleMesh& mesh);
/// About the share of points near the surface that are on the wrong side because floats are coarse there, whatever the maps are:
/// by the step of floats at the farthest corner, in standard deviations of the points' distance. Percent, up to 50.
[[nodiscard]] double wrongByFloats(const TriangleMesh& mesh);
/// At least half of the percentage is due to floats: more bytes do not help.
[[nodiscard]] inline bool floatsLimit(const TriangleMesh& mesh, double wrong_percent) {
    return 2.0 * wrongByFloats(mesh) > wrong_percent;
}

/// The errors of patches against their bytes (planErrors).
/// \param bytes  of the largest tree, kPatchBytesMin to kPatchBytesMax.
/// Errors: kFailure (Embree).
[[nodiscard]] Result<ErrorCurve> planErrors(const PreparedMesh& mesh, const BakeOptions& options,
                                            std::uint64_t bytes);

}  // namespace relief
