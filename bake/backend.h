// `relief bake --backend`: rays on the CPU, or triangles on the GPU.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "bake/bake.h"
#include "bake/prefer.h"
#include "formats/result.h"
#include "runtime/gl_context.h"

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
    std::string device;                  ///< of raster: GlContext::description()
    std::string reason;                  ///< of auto: why this one; else empty
    std::unique_ptr<GlContext> context;  ///< of raster: current; keep it until the bake is done
};

/// Opens a GL only if it is asked for one.
/// Errors: kUsage (no such word; raster for what it cannot do; the message says what to leave out),
/// kUnsupported (raster without a GL).
[[nodiscard]] Result<Backend> chooseBackend(const BackendOptions& options, const BackendRequest& request);

/// Whether a GL_RENDERER is a program that runs on the CPU, by the names of those there are.
[[nodiscard]] bool isSoftwareRenderer(const std::string& renderer);

}  // namespace relief
