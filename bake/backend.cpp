#include "bake/backend.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "bake/text.h"
#include "formats/file_io.h"

namespace relief {
namespace {

constexpr std::array<std::string_view, 3> kBackends = {"raycast", "raster", "auto"};

/// What keeps the GPU from it, and the cure; empty if nothing does.
std::string obstacle(const BackendRequest& request) {
    if (request.planned) {
        return "planning the maps casts rays; name them by --map, --paper or --plan";
    }
    if (request.quality_given && request.quality != Quality::kFast) {
        return std::string("--quality ") + qualityName(request.quality) +
               " fits planes to more rays than one a texel; take --quality fast";
    }
    if (request.prefer != Prefer::kNeither) {
        return std::string("--prefer ") + preferName(request.prefer) +
               " chooses among planes that rays were fitted to; leave --prefer out";
    }
    return {};
}

}  // namespace

void addBackendOptions(CLI::App& verb, BackendOptions& options) {
    verb.add_option(
            "--backend", options.backend,
            "Who bakes maps that are named: raycast (on the CPU, default), raster (on the GPU, texels'\n"
            "centres alone: implies --quality fast), or auto: raster where the options allow it and\n"
            "the OpenGL is a GPU's. Only raycast gives the same bytes on every machine")
        ->option_text("WORD");
}

bool isSoftwareRenderer(const std::string& renderer) {
    std::string lower = renderer;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    constexpr std::array<std::string_view, 6> kNames = {"llvmpipe",    "softpipe", "swrast",
                                                        "swiftshader", "software", "lavapipe"};
    return std::any_of(kNames.begin(), kNames.end(),
                       [&](std::string_view name) { return lower.find(name) != std::string::npos; });
}

Result<Backend> chooseBackend(const BackendOptions& options, const BackendRequest& request) {
    const auto word = std::find(kBackends.begin(), kBackends.end(), options.backend);
    if (word == kBackends.end()) {
        return fail(ErrorCode::kUsage, "--backend is '" + cleanUtf8(options.backend) +
                                           "' but must be one of " + listed(kBackends) +
                                           didYouMean(options.backend, kBackends));
    }
    Backend backend;
    if (*word == "raycast") {
        return backend;
    }
    const bool automatic = *word == "auto";
    const std::string problem = obstacle(request);
    if (!problem.empty()) {
        if (!automatic) {
            return fail(ErrorCode::kUsage, "--backend raster: " + problem + ", or leave --backend out");
        }
        backend.reason = problem.substr(0, problem.find(';'));
        return backend;
    }
    Result<std::unique_ptr<GlContext>> context = GlContext::create();
    if (!context) {
        if (!automatic) {
            return fail(context.error().code,
                        "--backend raster: " + context.error().message + "; or bake with --backend raycast");
        }
        backend.reason = context.error().message;
        return backend;
    }
    const auto* const renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    if (automatic && isSoftwareRenderer(renderer == nullptr ? "" : renderer)) {
        backend.reason = "the OpenGL runs on the CPU: " + (*context)->description();
        return backend;
    }
    backend.raster = true;
    backend.device = (*context)->description();
    backend.reason = automatic ? "planes of quality fast; the OpenGL is a GPU's: " + backend.device : "";
    backend.context = std::move(*context);
    return backend;
}

}  // namespace relief
