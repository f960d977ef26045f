#include "bake/cli/gl_options.h"

#include "bake/cli/command.h"
#include "runtime/tool/gpu_tool.h"

namespace relief {

void addGlOptions(CLI::App& verb, GlOptions& options) {
    verb.add_option("--device", options.device, kDeviceHelp)->option_text("N");
    verb.add_option("--gpu-timeout", options.gpu_timeout, kGpuTimeoutHelp)->option_text("SECONDS");
    // CLI11 runs callbacks before it looks for what is required, as it does for --help.
    verb.add_flag_callback(
        "--list-devices",
        [&verb] {
            const CLI::Option* json = verb.get_option_no_throw("--json");
            throw ListDevices{json != nullptr && json->count() > 0};
        },
        kListDevicesHelp);
}

Result<void> listDevices(const ListDevices& what) {
    const std::vector<GlDevice> devices = RELIEF_TRY(listGlDevices());
    return printOut(what.json ? devicesJson(devices) : devicesText(devices));
}

Result<void> refuseGlOptions(const GlOptions& options, const std::string& add) {
    const char* given = !options.device.empty()        ? "--device"
                        : !options.gpu_timeout.empty() ? "--gpu-timeout"
                                                       : nullptr;
    if (given != nullptr) {
        return fail(ErrorCode::kUsage,
                    std::string(given) + " does nothing without " + add + "; leave it out");
    }
    return {};
}

Result<WatchedContext> openGl(const GlOptions& options) {
    GlContextOptions wanted;
    if (!options.device.empty()) {
        const std::size_t device = RELIEF_TRY(parseDevice(options.device));
        wanted.device = device;
    }
    std::chrono::milliseconds limit = defaultGpuTimeout(false);
    if (!options.gpu_timeout.empty()) {
        const auto given = RELIEF_TRY(parseGpuTimeout(options.gpu_timeout));
        limit = given;
    }
    WatchedContext opened;
    opened.watchdog = std::make_unique<Watchdog>(limit, endProcess("relief"));
    opened.watchdog->feed("making a context");
    Result<std::unique_ptr<GlContext>> context = GlContext::create(wanted);
    opened.watchdog->rest();
    if (!context) {
        return forward(context);
    }
    opened.context = std::move(*context);
    if (options.gpu_timeout.empty()) {
        opened.watchdog->setLimit(defaultGpuTimeout(opened.context->software()));
    }
    return opened;
}

}  // namespace relief
