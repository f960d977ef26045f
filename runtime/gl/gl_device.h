// EGL's devices: what `--list-devices` shows and `--device` chooses from.
#pragma once

#include <string>
#include <vector>

#include "runtime/gl/gl_context.h"

namespace relief {

struct GlDevice {
    std::size_t index = 0;   ///< for GlContextOptions::device
    std::string name;        ///< EGL's, by EGL_EXT_device_query_name; or ""
    std::string drm_device;  ///< "/dev/dri/card0", or "" where there is none
    std::string vendor;      ///< of a context opened on it, as are the next two
    std::string renderer;
    std::string version;
    bool software = false;  ///< the processor draws
    std::string problem;    ///< why no context could be opened; "" if one could
};

/// Opens a context of this API on each of EGL's devices in turn; the context that was current stays so. An
/// empty list where EGL enumerates none.
/// Errors: kUnsupported without EGL's library.
[[nodiscard]] Result<std::vector<GlDevice>> listGlDevices(GlApi api = GlApi::kGl33Core);

}  // namespace relief
