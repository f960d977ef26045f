// --device, --list-devices and --gpu-timeout of the verbs of `relief` that may use a GPU.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "formats/base/result.h"
#include "runtime/gl/gl_context.h"
#include "runtime/tool/watchdog.h"

namespace relief {

struct GlOptions {
    std::string device;
    std::string gpu_timeout;
};

/// A context, and the watchdog over it; destroyed together, the context first.
struct WatchedContext {
    std::unique_ptr<Watchdog> watchdog;  ///< feed it before what the GPU is to do, let it rest afterwards
    std::unique_ptr<GlContext> context;
};

/// `--list-devices` is done while the command line is parsed, so that it needs no other argument.
void addGlOptions(CLI::App& verb, GlOptions& options);

/// What `--list-devices` throws out of CLI::App::parse; runCommandLine catches it.
struct ListDevices {
    bool json = false;  ///< the verb has --json, and it is given
};
[[nodiscard]] Result<void> listDevices(const ListDevices& what);

/// Where no GPU is used these options do nothing. \param add  "--gpu": what would make them do something.
/// Errors: kUsage.
[[nodiscard]] Result<void> refuseGlOptions(const GlOptions& options, const std::string& add);

/// Makes the context and leaves the watchdog at rest.
/// Errors: kUsage, and those of GlContext::create.
[[nodiscard]] Result<WatchedContext> openGl(const GlOptions& options);

}  // namespace relief
