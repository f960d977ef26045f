// SPDX-License-Identifier: Apache-2.0
#include "runtime/cli/sim.h"

#include <spdlog/spdlog.h>

#include <cstdio>

#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/config/confined_path.h"
#include "formats/fields/json.h"
#include "runtime/cli/scene_page.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/option_values.h"
#include "runtime/command_line/progress.h"
#include "runtime/player/report.h"
#include "runtime/player/scene_check.h"
#include "runtime/player/simulation.h"

namespace relief {
namespace {

/// Parses "640x480".
std::optional<FrameSize> parseFrameSize(std::string_view text) {
    const std::vector<std::string_view> sides = split(text, 'x');
    std::uint32_t size[2] = {0, 0};
    for (std::size_t i = 0; i < 2 && sides.size() == 2; ++i) {
        const std::optional<std::uint64_t> side = parseUnsigned(sides[i]);
        size[i] = side && *side <= std::numeric_limits<std::uint32_t>::max()
                      ? static_cast<std::uint32_t>(*side)
                      : 0;
    }
    return size[0] > 0 && size[1] > 0 ? std::optional(FrameSize{size[0], size[1]}) : std::nullopt;
}

void addOutputs(CLI::App& app, SimCommand& command) {
    PlayerOptions& player = command.player;
    addOption(app, "--dump", player.dump,
              "Write the particles at the end as PLY, or as OpenVDB points if the name ends in .vdb; - for "
              "standard output")
        ->valueText("OUT.ply");
    addWords(
        app, "--dump-format", command.dump_format,
        WordsFor<DumpFormat>{{"ply", DumpFormat::kPly}, {"vdb", DumpFormat::kVdb}},
        "Format of --dump and --dump-frames (default: vdb if the name of --dump ends in .vdb, else ply)");
    addOption(app, "--events", player.events, "Write each hit as a line of JSON; - for standard output")
        ->valueText("OUT.jsonl");
    addOption(app, "--events-min-speed", player.events_min_speed,
              "Omit hits slower than V from --events, in world units per second (default: 0)")
        ->valueText("V")
        ->needs("--events")
        ->transform(number(0.0F, 1e9F, "a speed, 0 or more"));
}

void addFrames(CLI::App& app, SimCommand& command) {
    PlayerOptions& player = command.player;
    addOption(
        app, "--frames", player.frames,
        "Write pictures frame_0000.png and so on to this folder; it is created if missing, and other files "
        "in it are kept")
        ->valueText("DIR");
    addParsed(app, "--size", command.size, parseFrameSize, "a size such as 960x720, each side at least 1",
              "Size of the pictures in pixels (default: render.size of the scene)")
        ->valueText("WxH")
        ->needs("--frames");
    addOption(app, "--dump-frames", player.dump_frames,
              "Write the particles of each frame as particles_0000.ply and so on to this folder")
        ->valueText("DIR");
    addOption(app, "--first-frame", player.overrides.first_frame,
              "Step of the first frame; 0: before the first step (default: render.first_frame of the scene)")
        ->valueText("N")
        ->transform(wholeNumber(0, kStepsMax));
    addOption(
        app, "--last-frame", player.overrides.last_frame,
        "Step of the last frame; the run continues to its end (default: render.last_frame of the scene)")
        ->valueText("N")
        ->transform(wholeNumber(0, kStepsMax));
    addOption(app, "--steps-per-frame", player.overrides.steps_per_frame,
              "Number of steps per frame (default: render.steps_per_frame of the scene)")
        ->valueText("N")
        ->transform(wholeNumber(1, kStepsMax));
}

void addSimulation(CLI::App& app, SimCommand& command) {
    PlayerOptions& player = command.player;
    addOption(app, "--steps", player.overrides.steps,
              "Number of steps to simulate (default: time.steps of the scene)")
        ->valueText("N")
        ->transform(wholeNumber(0, kStepsMax));
    addOption(app, "--seed", player.overrides.seed,
              "Random seed of the emitters (default: those of the scene)")
        ->valueText("S")
        ->transform(wholeNumber(0, kSeedMax));
    addOption(app, "--root", player.overrides.root,
              "Allow scene paths with .. within this folder (default: only files in the scene's own folder)")
        ->valueText("DIR");
    addWords(app, "--api", player.gpu.api,
             WordsFor<GlApi>{{"gl", GlApi::kGl33Core}, {"gles", GlApi::kGles30}},
             "Use OpenGL 3.3 (gl) or OpenGL ES 3.0 (gles) (default: gl)");
    addWords(
        app, "--shaders", player.path,
        WordsFor<StepPath>{
            {"auto", StepPath::kAuto}, {"fragment", StepPath::kFragment}, {"compute", StepPath::kCompute}},
        "Use fragment or compute shaders (OpenGL 4.3, OpenGL ES 3.1) for particles (default: auto, which "
        "uses "
        "compute if the GPU supports it)");
}

/// Rejects combinations of options that have no effect.
Result<void> checkTogether(const SimCommand& command) {
    const PlayerOptions& player = command.player;
    const SceneOverrides& scene = player.overrides;
    if (player.input.empty()) {
        return fail(ErrorCode::kUsage,
                    "name a scene (.toml), a collider (.relief) or a world.json; see relief-sim --help");
    }
    if ((scene.first_frame || scene.last_frame || scene.steps_per_frame) && player.frames.empty() &&
        player.dump_frames.empty()) {
        return fail(ErrorCode::kUsage,
                    "--first-frame, --last-frame and --steps-per-frame need --frames or "
                    "--dump-frames; add --frames DIR");
    }
    if (scene.first_frame && scene.last_frame && *scene.first_frame > *scene.last_frame) {
        return fail(ErrorCode::kUsage, "--first-frame comes after --last-frame; swap them");
    }
    return {};
}

/// Call it after the work, so that a failed run prints only its error.
void showWarnings(const std::vector<std::string>& warnings, bool quiet) {
    for (const std::string& warning : warnings) {
        if (!quiet) {
            spdlog::warn(warning);
        }
    }
}

/// Runs --check. With --json, prints an object on success and on failure.
Result<void> checkOnly(const SimCommand& command) {
    const Result<CheckReport> checked = checkScene(command.player);
    if (checked) {
        showWarnings(checked->warnings, command.quiet);
    }
    if (command.json) {
        RELIEF_TRY(printOut(checked ? jsonTextOf(*checked) : jsonTextOf(CheckFailure{checked.error()})));
    } else if (checked && !command.quiet) {
        RELIEF_TRY(printOut(checkText(*checked)));
    }
    return checked ? Result<void>() : forward(checked);
}

Result<void> playScene(SimCommand& command) {
    PlayerOptions& player = command.player;
    const bool named_vdb = lowerCase(player.dump.extension().native()) == ".vdb";
    player.dump_format = command.dump_format.value_or(named_vdb ? DumpFormat::kVdb : DumpFormat::kPly);
    if (command.json) {
        RELIEF_TRY(player.guard.writes("-", "--json"));
    } else if (!command.quiet && player.dump != "-" && player.events != "-") {
        RELIEF_TRY(player.guard.writes("-", "the report"));
    }
    Progress progress({.name = quotedPath(player.input), .drawn = !command.quiet});
    progress.begin("playing");
    player.progress = [&progress](std::uint32_t step, std::uint32_t steps) {
        progress.set(steps == 0 ? 1.0 : static_cast<double>(step) / steps);
    };
    Watchdog watchdog("relief-sim", player.gpu.limit(false));
    player.watchdog = &watchdog;
    const PlayerReport played = RELIEF_TRY(play(player));
    progress.finish();
    showWarnings(played.warnings, command.quiet);
    if (played.events_dropped > 0) {
        spdlog::warn("--events lacks {} hits: a step records at most {}; raise --events-min-speed",
                     played.events_dropped, Simulation::kEventsMax);
    }
    if (command.json) {
        return printOut(jsonTextOf(played));
    }
    if (!command.quiet && (player.dump == "-" || player.events == "-")) {
        std::fputs(reportText(played).c_str(), stderr);  // standard output is used by --dump or --events
        return {};
    }
    return command.quiet ? Result<void>() : printOut(reportText(played));
}

}  // namespace

void defineSim(CLI::App& app, SimCommand& command) {
    setUpHelp(app);
    describeApp(
        app,
        "Simulates particles that collide with a baked collider\n\n"
        "Runs a scene on the GPU, without a window, and writes pictures and particles. A collider or a "
        "world without a scene\nruns with a default scene, in which snow falls on it.",
        "relief-sim bunny_in_the_snow.toml --frames frames --dump snow.ply");
    addOption(app, "INPUT", command.player.input, "Scene (.toml), collider (.relief) or world (world.json)")
        ->typeName("SCENE.toml|COLLIDER.relief|WORLD.json");
    addOutputs(app, command);
    const OptionRef check = addFlag(app, "--check", command.check,
                                    "Validate the scene and all its files, and exit; needs no GPU");
    addFlag(app, "--json", command.json, "Print the report, or the result of --check, as JSON");
    const OptionRef page =
        addOption(app, "--page", command.page,
                  "Write one HTML file that plays the scene in a browser, and exit; needs the player that "
                  "scripts/build.sh web builds, but no GPU")
            ->valueText("OUT.html");
    addFlag(app, "-q,--quiet", command.quiet,
            "Print no progress and no summary; errors and the output of --json remain");
    addFrames(app, command);
    addSimulation(app, command);
    addFields(app, command.player.gpu);  // --device, --gpu-timeout
    addMemoryOption(app, command.player.overrides.limits);
    groupOptions(
        app, {{"Options", {"--help", "--version"}},
              {"Output",
               {"--dump", "--dump-format", "--events", "--events-min-speed", "--check", "--json", "--page",
                "--quiet"}},
              {"Frames and pictures",
               {"--frames", "--size", "--dump-frames", "--first-frame", "--last-frame", "--steps-per-frame"}},
              {"Simulation", {"--steps", "--seed", "--root", "--api", "--shaders", "--device"}},
              {"Limits", {"--gpu-timeout", "--max-memory"}}});
    for (const char* played :
         {"--frames", "--dump", "--dump-frames", "--events", "--shaders", "--device", "--gpu-timeout"}) {
        check->excludes(played);
        page->excludes(played);
    }
    for (const char* of_run :
         {"--check", "--json", "--steps", "--seed", "--root", "--api", "--dump-format"}) {
        page->excludes(of_run);
    }
}

Result<void> runSim(int argc, char** argv) {
    const auto app = makeApp("relief-sim");
    SimCommand command;
    defineSim(*app, command);
    if (!RELIEF_TRY(parseCommandLine(*app, argumentsOf(argc, argv)))) {
        return {};
    }
    RELIEF_TRY(checkTogether(command));
    if (!command.player.overrides.root.empty()) {
        RELIEF_TRY(checkRoot(command.player.overrides.root));
    }
    if (command.size) {
        command.player.overrides.width = command.size->width;
        command.player.overrides.height = command.size->height;
    }
    if (!command.page.empty()) {
        showWarnings(RELIEF_TRY(writeScenePage(command.player, command.page)), command.quiet);
        return {};
    }
    return command.check ? checkOnly(command) : playScene(command);
}

}  // namespace relief
