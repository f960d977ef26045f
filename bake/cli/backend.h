// `relief bake --backend`: rays on the CPU, or triangles on the GPU.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "bake/cli/gl_options.h"
#include "bake/pipeline/bake.h"
#include "bake/plan/prefer.h"
#include "formats/base/result.h"

namespace relief {

struct BackendOptions {
    std::string backend = "raycast";
};
void addBackendOptions(CLI::App& verb, BackendOptions& options);

/// What of a bake decides whether the GPU can do it.
struct BackendRequest {
    bool planned = false;                ///< maps are chosen by planning, which casts rays
    bool quality_given = false;          ///< by an option or a plan file
    Quality quality = Quality::kNormal;  ///< if given
    Prefer prefer = Prefer::kNeither;
};

struct Backend {
    bool raster = false;
    std::string device;  ///< of raster: GlContext::description()
    std::string reason;  ///< of auto: why this one; else empty
    WatchedContext gl;   ///< of raster: current, and the watchdog fed; keep it until the bake is done
};

/// Opens a GL only if it is asked for one.
/// Errors: kUsage (no such word; a GL option where no GL is asked for; raster for what it cannot do; the
/// message says what to leave out), kUnsupported (raster without a GL).
[[nodiscard]] Result<Backend> chooseBackend(const BackendOptions& options, const GlOptions& gl,
                                            const BackendRequest& request);

}  // namespace relief
