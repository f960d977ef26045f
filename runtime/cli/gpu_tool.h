// Options about the GPU: --device, --list-devices and --gpu-timeout.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "formats/base/field.h"
#include "formats/base/result.h"
#include "runtime/gl/gl_device.h"
#include "runtime/player/watchdog.h"

namespace CLI {
class App;
}

namespace relief {

/// What the options are read into.
struct GpuOptions {
    GlApi api = GlApi::kGl33Core;       ///< whose devices --list-devices lists
    std::optional<std::size_t> device;  ///< whether there is such a device shows when a context is made
    std::optional<double> timeout;      ///< seconds; 0: never

    /// In whole milliseconds, rounded up, for 0 means never; without --gpu-timeout defaultGpuTimeout().
    [[nodiscard]] std::chrono::milliseconds limit(bool software) const;
    /// The first option that is given, or nullptr.
    [[nodiscard]] const char* given() const {
        return device ? "--device" : timeout ? "--gpu-timeout" : nullptr;
    }
};

template <class Visitor, FieldsOf<GpuOptions> Options>
void fields(Visitor& visit, Options& options) {
    visit("device", options.device,
          {.help = "Use this GPU, by its number in --list-devices",
           .range = {0.0, 4294967295.0},
           .fallback = "EGL's choice",
           .value = "N",
           .must = "the number of a device; --list-devices names them"});
    visit("gpu_timeout", options.timeout,
          {.help = "Give up, with exit code 4, when the GPU does not answer for so long; 0: never",
           .unit = "s",
           .range = {0.0, 1e6},
           .fallback = "60, on a software renderer 600",
           .value = "SECONDS",
           .must = "a number of seconds from 0 (never) to 1000000"});
}

/// --list-devices is answered by parseCommandLine(), so that it needs no other argument. `options` must outlive the app.
void addGpuOptions(CLI::App& app, GpuOptions& options);

/// A line a device, or one that says that there is none; with a newline.
[[nodiscard]] std::string devicesText(const std::vector<GlDevice>& devices);
/// {devices: [{index, name, drm_device, vendor, renderer, version, software, problem}]}; what EGL does not
/// say is null, as is `problem` where a context was opened.
[[nodiscard]] std::string devicesJson(const std::vector<GlDevice>& devices);

/// A Watchdog::Starved that prints one line, "PROGRAM: error: the GPU …", and ends the process with exit code
/// 4, at once: a driver that hangs would hang in every destructor too.
[[nodiscard]] Watchdog::Starved endProcess(const std::string& program);

}  // namespace relief
