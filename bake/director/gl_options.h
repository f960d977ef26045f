// The GPU, for the verbs of `relief` that may use one.
#pragma once

#include <memory>
#include <string>

#include "formats/base/result.h"
#include "runtime/command_line/gpu_tool.h"
#include "runtime/gl/gl_context.h"

namespace relief {

/// A context, and the watchdog over it; destroyed together, the context first.
struct WatchedContext {
    std::unique_ptr<Watchdog> watchdog;  ///< feed it before what the GPU is to do, let it rest afterwards
    std::unique_ptr<GlContext> context;
};

/// Where no GPU is used these options do nothing. \param add  "--gpu": what would make them do something.
/// Errors: kUsage.
[[nodiscard]] Result<void> refuseGpuOptions(const GpuOptions& options, const std::string& add);

/// Makes the context and leaves the watchdog at rest.
/// Fails as GlContext::create.
[[nodiscard]] Result<WatchedContext> openGl(const GpuOptions& options);

}  // namespace relief
