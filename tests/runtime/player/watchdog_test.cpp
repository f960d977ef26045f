// The watchdog barks once it starves, and not before. Nothing here depends on how fast the machine is: times
// are either none or for ever, next to each other.
#include "runtime/player/watchdog.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <future>
#include <thread>

#include "runtime/cli/gpu_tool.h"
#include "runtime/command_line/command_line.h"

namespace relief {
namespace {

using namespace std::chrono_literals;

constexpr auto kForEver = 1h;

TEST(Watchdog, StarvedItSaysWhatWasWaitedForAfterCleaningUp) {
    std::promise<std::string> said;
    std::atomic<bool> clean = false;
    Watchdog dog(1ms, [&](const std::string& what, std::chrono::milliseconds limit) {
        EXPECT_EQ(limit, 1ms);
        EXPECT_TRUE(clean) << "what is half-made goes first";
        said.set_value(what);
    });
    dog.setCleanUp([&] { clean = true; });
    dog.feed("steps 1 to 16");
    EXPECT_EQ(said.get_future().get(), "steps 1 to 16");
    dog.feed("more");  // it has barked, once: a second set_value would throw
    dog.rest();
}

TEST(Watchdog, AtRestFedOrWithoutLimitItIsQuiet) {
    std::atomic<int> barks = 0;
    const auto bark = [&](const std::string&, std::chrono::milliseconds) { ++barks; };
    {
        Watchdog resting(5ms, bark);
        std::this_thread::sleep_for(30ms);
        Watchdog fed(kForEver, bark);
        for (int i = 0; i < 100; ++i) {
            fed.feed("step");
        }
        Watchdog endless(0ms, bark);
        endless.feed("anything");
        Watchdog changed(1ms, bark);
        changed.setLimit(kForEver);
        changed.feed("anything");
        Watchdog lifted(kForEver, bark);
        lifted.feed("anything");
        lifted.setLimit(0ms);
        lifted.feed("anything");
        std::this_thread::sleep_for(30ms);
    }
    EXPECT_EQ(barks, 0);
}

TEST(Watchdog, ALimitGivenLaterCounts) {
    std::promise<void> said;
    Watchdog dog(0ms, [&](const std::string&, std::chrono::milliseconds) { said.set_value(); });
    dog.feed("nothing");
    dog.setLimit(1ms);
    dog.feed("something");
    said.get_future().get();
}

/// What a command line makes of one option.
Result<GpuOptions> gpuOptions(const std::string& option, const std::string& word) {
    CLI::App app("", "tool");
    GpuOptions options;
    addGpuOptions(app, options);
    const Result<bool> parsed = parseCommandLine(app, {option + "=" + word});
    return parsed ? Result<GpuOptions>(options) : forward(parsed);
}

TEST(GpuTool, OptionsAndTheirErrors) {
    EXPECT_EQ(gpuOptions("--device", "0")->device, 0U);
    EXPECT_EQ(gpuOptions("--device", "12")->device, 12U);
    EXPECT_EQ(gpuOptions("--device", "012")->device, 12U) << "not octal";
    for (const char* word : {"", "-1", "one", "1x", "0x1", " 1", "99999999999999999999999"}) {
        ASSERT_FALSE(gpuOptions("--device", word)) << word;
        EXPECT_EQ(gpuOptions("--device", word).error().code, ErrorCode::kUsage);
    }
    EXPECT_EQ(gpuOptions("--gpu-timeout", "0")->limit(false), 0ms);
    EXPECT_EQ(gpuOptions("--gpu-timeout", "2.5")->limit(false), 2500ms);
    EXPECT_EQ(gpuOptions("--gpu-timeout", "0.0001")->limit(false), 1ms) << "not never";
    for (const char* word : {"", "-1", "nan", "inf", "1e7", "soon", "5s"}) {
        ASSERT_FALSE(gpuOptions("--gpu-timeout", word)) << word;
        EXPECT_EQ(gpuOptions("--gpu-timeout", word).error().code, ErrorCode::kUsage);
    }
    EXPECT_GT(defaultGpuTimeout(true), defaultGpuTimeout(false));
}

TEST(GpuTool, DevicesInWords) {
    GlDevice one;
    one.renderer = "R";
    one.vendor = "V";
    one.version = "4.6";
    one.drm_device = "/dev/dri/card0";
    GlDevice two;
    two.index = 1;
    two.name = "broken";
    two.problem = "no context";
    two.software = true;
    EXPECT_EQ(devicesText({one, two}), "0  R, V, 4.6, /dev/dri/card0\n1  broken: no context, software\n");
    EXPECT_EQ(devicesText({}), "EGL names no devices; leave --device out\n");
    EXPECT_EQ(devicesJson({}), "{\n  \"devices\": []\n}\n");
}

}  // namespace
}  // namespace relief
