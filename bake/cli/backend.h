// `relief bake --backend`: rays on the CPU, or triangles on the GPU.
#pragma once

#include <string>

#include "bake/cli/gl_options.h"
#include "bake/pipeline/bake.h"
#include "bake/plan/prefer.h"
#include "formats/base/result.h"

namespace CLI {
class App;
}

namespace relief {

enum class BackendChoice : std::uint8_t { kRaycast, kRaster, kAuto };
void addBackendOption(CLI::App& verb, BackendChoice& choice);

/// What of a bake decides whether the GPU can do it.
struct BackendRequest {
    bool planned = false;                ///< maps are chosen by planning, which casts rays
    bool quality_given = false;          ///< by an option or a plan file
    Quality quality = Quality::kNormal;  ///< if given
    Prefer prefer = Prefer::kNeither;
    bool gaps = false;  ///< of a map of gaps between solids
};

struct Backend {
    bool raster = false;
    std::string device;  ///< of raster: GlContext::description()
    std::string reason;  ///< of auto: why this one; else empty
    WatchedContext gl;   ///< of raster: current, and the watchdog fed; keep it until the bake is done
};

/// Opens a GL only if it is asked for one.
/// Fails with kUsage for a GPU option where no GPU is asked for, and for raster where it cannot bake what is requested
/// (the message says what to leave out); with kUnsupported for raster without an OpenGL.
[[nodiscard]] Result<Backend> chooseBackend(BackendChoice choice, const GpuOptions& gpu,
                                            const BackendRequest& request);

}  // namespace relief
