// relief-sim: the command line of the player.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <charconv>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/ending_signals.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "runtime/player/player.h"
#include "runtime/player/report.h"
#include "runtime/player/scene_check.h"
#include "runtime/tool/cli_model.h"
#include "runtime/tool/gpu_tool.h"

namespace {

using relief::ErrorCode;

constexpr std::string_view kHelpHead =
    "Example:\n"
    "  relief-sim bunny_in_the_snow.toml --frames frames --dump snow.ply\n"
    "\n"
    "Plays a scene against a baked collider, headless: particles fall, collide and rest.\n"
    "Given a collider alone it lets snow fall on it.\n";

constexpr std::string_view kHelpFoot =
    "\n"
    "Exit codes: 0 done, 1 usage, 2 file or I/O, 3 invalid input, 4 failure, 5 unsupported here, 6 above a "
    "limit.\n";

constexpr std::array<std::string_view, 19> kOptions{
    "--steps",      "--frames", "--size",        "--seed",  "--dump",   "--dump-frames",
    "--video",      "--stats",  "--stats-every", "--check", "--json",   "--api",
    "-q",           "--quiet",  "--version",     "--help",  "--device", "--list-devices",
    "--gpu-timeout"};

int report(ErrorCode code, const std::string& message) {
    std::fprintf(stderr, "relief-sim: error: %s\n", message.c_str());
    return static_cast<int>(code);
}

/// A word of the command line, in quotes and on one line.
std::string quotedWord(const std::string& word) {
    return relief::quotedPath(word);
}

template <class T>
bool parseNumber(std::string_view text, T& out) {
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, out);
    return error == std::errc() && rest == end;
}

/// "640x480"; false if it is not that.
bool parseSize(std::string_view text, std::uint32_t& width, std::uint32_t& height) {
    const std::size_t cross = text.find('x');
    return cross != std::string_view::npos && parseNumber(text.substr(0, cross), width) &&
           parseNumber(text.substr(cross + 1), height) && width > 0 && height > 0;
}

struct CommandLine {
    std::string input;
    std::string steps;
    std::string frames;
    std::string size;
    std::string seed;
    std::string dump;
    std::string dump_frames;
    std::string video;
    std::string stats;
    std::string stats_every;
    std::string api = "gl";
    std::string device;
    std::string gpu_timeout;
    bool list_devices = false;
    bool check = false;
    bool json = false;
    bool quiet = false;
};

/// Fills the options from the words; an empty string, or what is wrong with them.
std::string toOptions(const CommandLine& line, relief::PlayerOptions& options) {
    options.input = line.input;
    options.frames = line.frames;
    options.dump = line.dump;
    options.dump_frames = line.dump_frames;
    options.video = line.video;
    options.stats = line.stats;
    options.count_collisions = line.json;
    options.time_stages = line.json;
    if (line.check && !(line.frames + line.dump + line.dump_frames + line.video + line.stats).empty()) {
        return "--check plays nothing and writes nothing; remove it, or the outputs";
    }
    if (!line.steps.empty()) {
        std::uint32_t steps = 0;
        if (!parseNumber(line.steps, steps) || steps > 10'000'000) {
            return "--steps " + quotedWord(line.steps) + " is not a whole number from 0 to 10000000";
        }
        options.overrides.steps = steps;
    }
    if (!line.seed.empty()) {
        std::uint64_t seed = 0;
        if (!parseNumber(line.seed, seed) || seed > 9007199254740992U) {
            return "--seed " + quotedWord(line.seed) + " is not a whole number from 0 to 9007199254740992";
        }
        options.overrides.seed = seed;
    }
    if (!line.size.empty()) {
        std::uint32_t width = 0;
        std::uint32_t height = 0;
        if (!parseSize(line.size, width, height)) {
            return "--size " + quotedWord(line.size) +
                   " is not a size; write it as 960x720, each side at least 1";
        }
        if (line.frames.empty() && line.video.empty()) {
            return "--size does nothing without --frames or --video; add --frames DIR";
        }
        options.overrides.width = width;
        options.overrides.height = height;
    }
    if (line.api == "gles") {
        options.api = relief::GlApi::kGles30;
    } else if (line.api != "gl") {
        return "--api " + quotedWord(line.api) + " is unknown; choose gl or gles";
    }
    if (!line.device.empty()) {
        const auto device = relief::parseDevice(line.device);
        if (!device) {
            return device.error().message;
        }
        options.device = *device;
    }
    if (line.check && !(line.device + line.gpu_timeout).empty()) {
        return std::string(line.device.empty() ? "--gpu-timeout" : "--device") +
               " does nothing with --check, which needs no GPU; leave it out";
    }
    if (!line.stats_every.empty()) {
        std::uint32_t every = 0;
        if (!parseNumber(line.stats_every, every) || every < 1 || every > 10'000'000) {
            return "--stats-every " + quotedWord(line.stats_every) +
                   " is not a whole number from 1 to 10000000";
        }
        if (line.stats.empty()) {
            return "--stats-every does nothing without --stats; add --stats OUT.jsonl";
        }
        options.stats_every = every;
    }
    if (line.json && line.dump == "-") {
        return "--json and --dump - both write standard output; dump to a file";
    }
    if (line.stats == "-" && (line.json || line.dump == "-")) {
        return std::string("--stats - and ") + (line.json ? "--json" : "--dump -") +
               " both write standard output; write the statistics to a file";
    }
    return {};
}

/// "--fames" -> ", did you mean '--frames'?"
std::string unknownOption(const CLI::App& app) {
    for (const std::string& word : app.remaining()) {
        if (word.size() > 1 && word.front() == '-') {
            const std::string name = word.substr(0, word.find('='));
            const std::string hint = relief::didYouMean(name, kOptions);
            return "unknown option " + quotedWord(name) + (hint.empty() ? "; see relief-sim --help" : hint);
        }
    }
    return "one scene or collider at a time; " + quotedWord(app.remaining().front()) + " is one too many";
}

void showProgress(std::uint32_t step, std::uint32_t steps) {
    constexpr int kWidth = 40;
    const int done = steps == 0 ? kWidth : static_cast<int>(std::uint64_t{kWidth} * step / steps);
    std::fprintf(stderr, "\r[%s%s] %u/%u%s", std::string(static_cast<std::size_t>(done), '#').c_str(),
                 std::string(static_cast<std::size_t>(kWidth - done), '.').c_str(), step, steps,
                 step >= steps ? "\n" : "");
}

/// For the manual page: the help's head and foot are made for a terminal.
relief::CliProgram simProgram(const CLI::App& app) {
    relief::CliProgram program = relief::readProgram(app, "relief-sim", RELIEF_VERSION);
    program.command.summary = "Plays a scene against a baked collider";
    program.command.description =
        "Headless: particles fall, collide and rest. Given a collider alone it lets snow fall on it.";
    program.command.examples = {"relief-sim bunny_in_the_snow.toml --frames frames --dump snow.ply"};
    return program;
}

/// --check: 0, or the code of the first mistake. With --json the object comes in either case.
int check(const CommandLine& line, const relief::PlayerOptions& options) {
    const auto checked = relief::checkScene(options);
    if (line.json || (checked && !line.quiet)) {
        const std::string text = !line.json ? relief::checkText(*checked)
                                 : checked  ? relief::checkJson(*checked)
                                            : relief::checkJson(checked.error());
        if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0) {
            return report(ErrorCode::kIo, "cannot write the result to standard output");
        }
    }
    return checked ? 0 : report(checked.error().code, checked.error().message);
}

/// --list-devices.
int listDevices(const CommandLine& line) {
    if (line.api != "gl" && line.api != "gles") {
        return report(ErrorCode::kUsage, "--api " + quotedWord(line.api) + " is unknown; choose gl or gles");
    }
    const auto devices =
        relief::listGlDevices(line.api == "gles" ? relief::GlApi::kGles30 : relief::GlApi::kGl33Core);
    if (!devices) {
        return report(devices.error().code, devices.error().message);
    }
    const std::string text = line.json ? relief::devicesJson(*devices) : relief::devicesText(*devices);
    if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0) {
        return report(ErrorCode::kIo, "cannot write the devices to standard output");
    }
    return 0;
}

int run(int argc, char** argv) {
    CLI::App app{std::string(kHelpHead)};
    CommandLine line;
    app.name("relief-sim");
    app.footer(std::string(kHelpFoot));
    app.allow_extras();
    app.set_version_flag("--version", "relief-sim " RELIEF_VERSION);
    app.add_option("INPUT", line.input, "Scene (.toml) or collider (.relief)")
        ->type_name("SCENE.toml|COLLIDER.relief");
    app.add_option("--steps", line.steps, "Steps to play, instead of the scene's")->type_name("N");
    app.add_option(
           "--frames", line.frames,
           "Write frame_0000.png and so on into this folder, made if missing. Frames of an earlier run are "
           "overwritten one by one; any beyond this run's last stay")
        ->type_name("DIR");
    app.add_option("--size", line.size, "Size of the frames in pixels, instead of the scene's")
        ->type_name("WxH");
    app.add_option("--seed", line.seed, "Seed of the births, instead of the scene's")->type_name("S");
    app.add_option("--dump", line.dump, "Write the final particles as PLY; - for standard output")
        ->type_name("OUT.ply");
    app.add_option("--dump-frames", line.dump_frames,
                   "Write particles_0000.ply and so on into this folder, made if missing, as often as frames")
        ->type_name("DIR");
    app.add_option(
           "--video", line.video,
           "Write the frames as a video (.mp4, .mkv, .mov or .webm) in the scene's time; needs ffmpeg")
        ->type_name("OUT.mp4");
    app.add_option("--stats", line.stats,
                   "Write statistics while playing, a line of JSON each; - for standard output")
        ->type_name("OUT.jsonl");
    app.add_option("--stats-every", line.stats_every,
                   "Steps from line to line of --stats, instead of the scene's render.every")
        ->type_name("N");
    app.add_flag("--check", line.check,
                 "Only check the scene and what it names, without a GPU: one line, or the first mistake");
    app.add_option("--api", line.api, "gl for OpenGL 3.3 (default), gles for OpenGL ES 3.0")
        ->type_name("gl|gles");
    app.add_option("--device", line.device, relief::kDeviceHelp)->type_name("N");
    app.add_flag("--list-devices", line.list_devices, relief::kListDevicesHelp);
    app.add_option("--gpu-timeout", line.gpu_timeout, relief::kGpuTimeoutHelp)->type_name("SECONDS");
    app.add_flag("--json", line.json, "Print the report, or what --check finds, as JSON");
    app.add_flag("-q,--quiet", line.quiet,
                 "No progress and no summary; errors still, and what --json asks for");
    if (const auto dumped = relief::dumpedCommandLine(simProgram(app), argc, argv)) {
        return std::fputs(dumped->c_str(), stdout) < 0 || std::fflush(stdout) != 0
                   ? report(ErrorCode::kIo, "cannot write to standard output")
                   : 0;
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& success) {  // --help, --version
        return app.exit(success);
    } catch (const CLI::ParseError& error) {
        return report(ErrorCode::kUsage, std::string(error.what()) + "; see relief-sim --help");
    }
    if (app.remaining_size() > 0) {
        return report(ErrorCode::kUsage, unknownOption(app));
    }
    if (line.list_devices) {
        return listDevices(line);
    }
    if (line.input.empty()) {
        return report(ErrorCode::kUsage,
                      "name a scene (.toml) or a collider (.relief); see relief-sim --help");
    }
    for (const CLI::Option* option : app.get_options()) {
        if (option->count() > 0 && option->get_expected_max() > 0 && option->results().back().empty()) {
            return report(ErrorCode::kUsage,
                          option->get_name() + " is given without a value; see relief-sim --help");
        }
    }
    relief::PlayerOptions options;
    if (const std::string wrong = toOptions(line, options); !wrong.empty()) {
        return report(ErrorCode::kUsage, wrong);
    }
    if (line.check) {
        return check(line, options);
    }
    if (!line.quiet && isatty(STDERR_FILENO) != 0) {
        options.progress = showProgress;
    }
    std::chrono::milliseconds limit = relief::defaultGpuTimeout(false);
    if (!line.gpu_timeout.empty()) {
        const auto given = relief::parseGpuTimeout(line.gpu_timeout);
        if (!given) {
            return report(given.error().code, given.error().message);
        }
        limit = *given;
    }
    relief::Watchdog watchdog(limit, relief::endProcess("relief-sim"));
    options.watchdog = &watchdog;
    options.default_timeout = line.gpu_timeout.empty();
    const auto played = relief::play(options);
    if (!played) {
        return report(played.error().code, played.error().message);
    }
    if (line.json || !line.quiet) {
        // The dump or the statistics may have standard output to themselves.
        const bool to_stderr = !line.json && (line.dump == "-" || line.stats == "-");
        const std::string text = line.json ? relief::reportJson(*played) : relief::reportText(*played);
        if (std::fputs(text.c_str(), to_stderr ? stderr : stdout) < 0 || std::fflush(stdout) != 0) {
            return report(ErrorCode::kIo, "cannot write the report to standard output");
        }
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    relief::endCleanlyOnSignals();
    try {
        return run(argc, argv);
    } catch (const std::bad_alloc&) {
        return report(ErrorCode::kLimit, "out of memory; choose a smaller capacity or size");
    } catch (const std::exception& error) {
        return report(ErrorCode::kFailure, error.what());
    }
}
