#include "bake/director/gl_options.h"

namespace relief {

Result<void> refuseGpuOptions(const GpuOptions& options, const std::string& add) {
    if (options.given() != nullptr) {
        return fail(ErrorCode::kUsage,
                    std::string(options.given()) + " does nothing without " + add + "; leave it out");
    }
    return {};
}

Result<WatchedContext> openGl(const GpuOptions& options) {
    GlContextOptions wanted;
    wanted.device = options.device;
    WatchedContext opened;
    opened.watchdog = std::make_unique<Watchdog>(options.limit(false), endProcess("relief"));
    opened.watchdog->feed("making a context");
    Result<std::unique_ptr<GlContext>> context = GlContext::create(wanted);
    opened.watchdog->rest();
    if (!context) {
        return forward(context);
    }
    opened.context = std::move(*context);
    opened.watchdog->setLimit(options.limit(opened.context->software()));
    return opened;
}

}  // namespace relief
