// `relief bake --backend`: rays on the CPU, or triangles on the GPU.
#pragma once

#include <string>

#include "bake/director/bake_request.h"
#include "bake/director/gl_options.h"
#include "formats/base/result.h"

namespace relief {

/// The part of a bake that decides whether the GPU can do it.
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
    std::string reason;  ///< of auto: for this choice; else empty
    WatchedContext gl;   ///< of raster: current, and the watchdog fed; keep it until the bake is done
};

/// Opens a GL only where the choice may need one.
/// Fails with kUsage for a GPU option that does nothing, and for raster where it cannot bake the request (the message names
/// the option to leave out); with kUnsupported for raster without an OpenGL.
[[nodiscard]] Result<Backend> chooseBackend(BackendChoice choice, const GpuOptions& gpu,
                                            const BackendRequest& request);

}  // namespace relief
