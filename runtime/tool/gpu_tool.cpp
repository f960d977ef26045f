#include "runtime/tool/gpu_tool.h"

#include <unistd.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "formats/fields/json.h"
#include "runtime/tool/option_values.h"

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

constexpr double kTimeoutMax = 1e6;  // seconds

/// --list-devices --json
struct DevicesReport {
    const std::vector<GlDevice>& devices;
};

template <class Visitor, FieldsOf<DevicesReport> R>
void fields(Visitor& visit, R& report) {
    visit("devices", report.devices, {"GPUs, by their number"});
}

std::optional<std::chrono::milliseconds> parseTimeout(const std::string& text) {
    double seconds = 0.0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, seconds);
    if (error != std::errc() || rest != end || !(seconds >= 0.0 && seconds <= kTimeoutMax)) {
        return std::nullopt;
    }
    // Rounded up, for 0 means never.
    return std::chrono::milliseconds(static_cast<std::int64_t>(std::ceil(seconds * 1000.0)));
}

std::string secondsText(std::chrono::milliseconds time) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%g", static_cast<double>(time.count()) / 1000.0);
    return text.data();
}

}  // namespace

void addGpuOptions(CLI::App& app, GpuOptions& options) {
    app.add_option("--device", options.device,
                   "Use this GPU, by its number in --list-devices; default: EGL's choice")
        ->option_text("N")
        ->transform(wholeNumber(0, std::numeric_limits<std::uint32_t>::max(),
                                "the number of a device; --list-devices names them"));
    addParsed(
        app, "--gpu-timeout", options.timeout, parseTimeout, "a number of seconds from 0 (never) to 1000000",
        "Give up, with exit code 4, when the GPU does not answer for so long; default 60, on a software "
        "renderer 600; 0: never")
        ->option_text("SECONDS");
    // CLI11 runs callbacks before it looks for what is required, as it does for --help.
    app.add_flag_callback(
        "--list-devices",
        [&app, &options] {
            const CLI::Option* json = app.get_option_no_throw("--json");
            throw ListDevices{options.api, json != nullptr && json->count() > 0};
        },
        "Print the GPUs that EGL knows, by their number, and exit; with --json as JSON");
}

Result<std::string> devicesAnswer(const ListDevices& what) {
    const std::vector<GlDevice> devices = RELIEF_TRY(listGlDevices(what.api));
    return what.json ? devicesJson(devices) : devicesText(devices);
}

std::chrono::milliseconds defaultGpuTimeout(bool software) {
    return std::chrono::seconds(software ? 600 : 60);
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
            // There is nobody left to tell.
        }
        ::_exit(static_cast<int>(ErrorCode::kFailure));
    };
}

}  // namespace relief
