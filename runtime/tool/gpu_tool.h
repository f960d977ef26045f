// What both executables share about the GPU: --device, --list-devices and --gpu-timeout.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "runtime/gl/gl_device.h"
#include "runtime/tool/watchdog.h"

namespace CLI {
class App;
}

namespace relief {

/// What the options are read into.
struct GpuOptions {
    GlApi api = GlApi::kGl33Core;       ///< whose devices --list-devices lists
    std::optional<std::size_t> device;  ///< whether there is such a device shows when a context is made
    std::optional<std::chrono::milliseconds> timeout;

    /// The first option that is given, or nullptr.
    [[nodiscard]] const char* given() const {
        return device ? "--device" : timeout ? "--gpu-timeout" : nullptr;
    }
};

/// --list-devices is answered by parseCommandLine(), so that it needs no other argument.
void addGpuOptions(CLI::App& app, GpuOptions& options);

/// What --list-devices throws out of CLI::App::parse.
struct ListDevices {
    GlApi api;
    bool json;  ///< there is a --json, and it is given
};
/// The text to print. Fails as listGlDevices.
[[nodiscard]] Result<std::string> devicesAnswer(const ListDevices& what);

/// What --gpu-timeout is where it is not given. A software renderer does not hang, it takes its time.
[[nodiscard]] std::chrono::milliseconds defaultGpuTimeout(bool software);

/// A line a device, or one that says that there is none; with a newline.
[[nodiscard]] std::string devicesText(const std::vector<GlDevice>& devices);
/// {devices: [{index, name, drm_device, vendor, renderer, version, software, problem}]}; what EGL does not
/// say is null, as is `problem` where a context was opened.
[[nodiscard]] std::string devicesJson(const std::vector<GlDevice>& devices);

/// A Watchdog::Starved that prints one line, "PROGRAM: error: the GPU …", and ends the process with exit code
/// 4, at once: a driver that hangs would hang in every destructor too.
[[nodiscard]] Watchdog::Starved endProcess(const std::string& program);

}  // namespace relief
