#include "bake/director/backend.h"

namespace relief {
namespace {

/// The reason why the GPU cannot bake the request, and the cure; empty: it can.
std::string obstacle(const BackendRequest& request) {
    if (request.planned) {
        return "planning the maps casts rays; name them by --map, --paper or --plan";
    }
    if (request.quality_given && request.quality != Quality::kFast) {
        return "--quality " + std::string(wordOf(request.quality)) +
               " fits planes to more rays than one a texel; take --quality fast";
    }
    if (request.prefer != Prefer::kNeither) {
        return "--prefer " + std::string(wordOf(request.prefer)) +
               " chooses among planes that rays were fitted to; leave --prefer out";
    }
    if (request.gaps) {
        return "only rays find gaps between solids; leave out compare=gap";
    }
    return {};
}

}  // namespace

Result<Backend> chooseBackend(BackendChoice choice, const GpuOptions& gpu, const BackendRequest& request) {
    Backend backend;
    if (choice == BackendChoice::kRaycast) {
        RELIEF_TRY(refuseGpuOptions(gpu, "--backend raster or auto"));
        return backend;
    }
    const bool automatic = choice == BackendChoice::kAuto;
    const std::string problem = obstacle(request);
    if (!problem.empty()) {
        if (!automatic) {
            return fail(ErrorCode::kUsage, "--backend raster: " + problem + ", or leave --backend out");
        }
        backend.reason = problem.substr(0, problem.find(';'));
        return backend;
    }
    Result<WatchedContext> opened = openGl(gpu);
    if (!opened) {
        // A device that does not exist is a mistake, whoever bakes.
        if (opened.error().code == ErrorCode::kUsage) {
            return forward(opened);
        }
        if (!automatic) {
            return fail(opened.error().code,
                        "--backend raster: " + opened.error().message + "; or bake with --backend raycast");
        }
        backend.reason = opened.error().message;
        return backend;
    }
    const GlContext& context = *opened->context;
    if (automatic && context.software()) {
        backend.reason = "the OpenGL runs on the CPU: " + context.description();
        return backend;
    }
    backend.raster = true;
    backend.device = context.description();
    backend.reason = automatic ? "planes of quality fast; the OpenGL is a GPU's: " + backend.device : "";
    backend.gl = std::move(*opened);
    backend.gl.watchdog->feed("drawing the maps");
    return backend;
}

}  // namespace relief
