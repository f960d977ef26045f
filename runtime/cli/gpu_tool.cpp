#include "runtime/cli/gpu_tool.h"

#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>

#include "formats/fields/json.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/field_options.h"

namespace relief {

template <class Visitor, FieldsOf<GlDevice> D>
void fields(Visitor& visit, D& device) {
    visit("index", device.index, {"Number for --device"});
    visit("name", nonEmpty(device.name), {"Name; null if unknown, as are the others"});
    visit("drm_device", nonEmpty(device.drm_device), {"Device file"});
    visit("vendor", nonEmpty(device.vendor), {"Vendor of the driver"});
    visit("renderer", nonEmpty(device.renderer), {"Renderer of the driver"});
    visit("version", nonEmpty(device.version), {"Version of OpenGL"});
    visit("software", device.software, {"It draws on the CPU"});
    visit("problem", nonEmpty(device.problem), {"Reason why it cannot be used"});
}

namespace {

/// --list-devices --json
struct DevicesReport {
    const std::vector<GlDevice>& devices;
};

template <class Visitor, FieldsOf<DevicesReport> R>
void fields(Visitor& visit, R& report) {
    visit("devices", report.devices, {"GPUs, by their number"});
}

std::string secondsText(std::chrono::milliseconds time) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%g", static_cast<double>(time.count()) / 1000.0);
    return text.data();
}

}  // namespace

void addGpuOptions(CLI::App& app, GpuOptions& options) {
    addFields(app, options);
    // CLI11 runs callbacks before it looks for what is required, as it does for --help.
    app.add_flag_callback(
        "--list-devices",
        [&app, &options] {
            const CLI::Option* json = app.get_option_no_throw("--json");
            const bool as_json = json != nullptr && json->count() > 0;
            throw Answer{listGlDevices(options.api).map(as_json ? devicesJson : devicesText)};
        },
        "Print the GPUs that EGL knows, by their number, and exit; with --json as JSON");
}

std::chrono::milliseconds GpuOptions::limit(bool software) const {
    return timeout ? std::chrono::milliseconds(static_cast<std::int64_t>(std::ceil(*timeout * 1000.0)))
                   : defaultGpuTimeout(software);
}

std::string devicesText(const std::vector<GlDevice>& devices) {
    if (devices.empty()) {
        return "EGL names no devices; leave --device out\n";
    }
    std::string text;
    for (const GlDevice& device : devices) {
        text += std::to_string(device.index) + "  ";
        if (device.problem.empty()) {
            text += device.renderer + ", " + device.vendor + ", " + device.version;
        } else {
            text += (device.name.empty() ? "" : device.name + ": ") + device.problem;
        }
        text += (device.software ? ", software" : "") +
                (device.drm_device.empty() ? std::string() : ", " + device.drm_device) + "\n";
    }
    return text;
}

std::string devicesJson(const std::vector<GlDevice>& devices) {
    return jsonText(jsonOf(DevicesReport{devices}));
}

Watchdog::Starved endProcess(const std::string& program) {
    return [program](const std::string& what, std::chrono::milliseconds limit) {
        const std::string line = program + ": error: the GPU has not finished " + what + " within " +
                                 secondsText(limit) +
                                 " seconds; if it is only slow, raise --gpu-timeout (0: wait for ever)\n";
        // Past the streams, whose locks the stuck thread may hold.
        if (::write(STDERR_FILENO, line.data(), line.size()) < 0) {
            // No reader is left for a message.
        }
        ::_exit(static_cast<int>(ErrorCode::kFailure));
    };
}

}  // namespace relief
