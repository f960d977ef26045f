// What both executables share about the GPU: --device, --list-devices and --gpu-timeout.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "runtime/gl/gl_device.h"
#include "runtime/tool/watchdog.h"

namespace relief {

inline constexpr const char* kDeviceHelp =
    "Use this GPU, by its number in --list-devices; default: EGL's choice";
inline constexpr const char* kListDevicesHelp =
    "Print the GPUs that EGL knows, by their number, and exit; with --json as JSON";
inline constexpr const char* kGpuTimeoutHelp =
    "Give up, with exit code 4, when the GPU does not answer for so long; default 60, on a software renderer "
    "600; 0: never";

/// "--device". Whether there is such a device shows when a context is made. Errors: kUsage.
[[nodiscard]] Result<std::size_t> parseDevice(const std::string& text);

/// "--gpu-timeout": seconds, 0 to 10⁶, fractions too. Errors: kUsage.
[[nodiscard]] Result<std::chrono::milliseconds> parseGpuTimeout(const std::string& text);

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
