// SPDX-License-Identifier: Apache-2.0
// The watchdog ends the process if it is not fed, and only then.
#include "runtime/player/watchdog.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <thread>

#include "runtime/command_line/command_line.h"
#include "runtime/command_line/option_values.h"
#include "runtime/player/player_options.h"

namespace relief {
namespace {

using namespace std::chrono_literals;

constexpr auto kForEver = 1h;

void feedAndWait(std::chrono::milliseconds first, std::chrono::milliseconds then) {
    Watchdog dog("tool", first);
    dog.setLimit(then);
    dog.feed("steps 1 to 16");
    std::this_thread::sleep_for(kForEver);
}

TEST(Watchdog, EndsTheProcessAndNamesTheOperationOnTimeout) {
    constexpr const char* kLine =
        "^tool: error: the GPU has not finished steps 1 to 16 within 0.001 seconds; .*--gpu-timeout";
    EXPECT_EXIT(feedAndWait(1ms, 1ms), testing::ExitedWithCode(4), kLine);
    EXPECT_EXIT(feedAndWait(0ms, 1ms), testing::ExitedWithCode(4), kLine);
}

TEST(Watchdog, DoesNothingIfIdleFedOrUnlimited) {
    for (const auto& [first, then] : {std::pair{5ms, 5ms},
                                      {0ms, 0ms},
                                      {1ms, std::chrono::milliseconds(kForEver)},
                                      {std::chrono::milliseconds(kForEver), 0ms}}) {
        Watchdog dog("tool", first);
        std::this_thread::sleep_for(30ms);
        dog.setLimit(then);
        if (then != 5ms) {
            dog.feed("anything");
        }
        std::this_thread::sleep_for(30ms);
        dog.rest();
    }
}

/// The options of a command line with one option.
Result<GpuOptions> gpuOptions(const std::string& option, const std::string& word) {
    CLI::App app("", "tool");
    GpuOptions options;
    addFields(app, options);
    const Result<bool> parsed = parseCommandLine(app, {option + "=" + word});
    return parsed ? Result<GpuOptions>(options) : forward(parsed);
}

TEST(GpuTool, OptionsAndTheirErrors) {
    EXPECT_EQ(gpuOptions("--device", "12")->device, 12U);
    EXPECT_EQ(gpuOptions("--gpu-timeout", "0")->limit(false), 0ms);
    EXPECT_EQ(gpuOptions("--gpu-timeout", "2.5")->limit(false), 2500ms);
    EXPECT_EQ(gpuOptions("--gpu-timeout", "0.0001")->limit(false), 1ms) << "not unlimited";
    EXPECT_FALSE(gpuOptions("--device", "-1"));
    EXPECT_FALSE(gpuOptions("--gpu-timeout", "1e7"));
    EXPECT_GT(GpuOptions{}.limit(true), GpuOptions{}.limit(false));
}

}  // namespace
}  // namespace relief
