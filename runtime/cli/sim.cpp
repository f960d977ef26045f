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

/// "640x480"
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

/// What is written, and how often.
void addOutputs(CLI::App& app, SimCommand& command) {
    PlayerOptions& player = command.player;
    addOption(
        app, "--frames", player.frames,
        "Write frame_0000.png and so on into this folder, made if missing. Frames of an earlier run are "
        "overwritten one by one; any beyond this run's last stay")
        ->valueText("DIR");
    addParsed(app, "--size", command.size, parseFrameSize, "a size such as 960x720, each side at least 1",
              "Size of the frames in pixels, instead of the scene's")
        ->valueText("WxH")
        ->needs("--frames");
    addOption(app, "--seed", player.overrides.seed, "Seed of the births, instead of the scene's")
        ->valueText("S")
        ->transform(wholeNumber(0, kSeedMax));
    addOption(app, "--dump", player.dump, "Write the final particles; - for standard output")
        ->valueText("OUT.ply");
    addOption(app, "--dump-frames", player.dump_frames,
              "Write particles_0000.ply and so on into this folder, made if missing, as often as frames")
        ->valueText("DIR");
    addWords(app, "--dump-format", command.dump_format,
             WordsFor<DumpFormat>{{"ply", DumpFormat::kPly}, {"vdb", DumpFormat::kVdb}},
             "Of --dump and --dump-frames: PLY, or points of OpenVDB; default: what --dump's name ends with, "
             "else ply");
    addOption(app, "--first-frame", player.overrides.first_frame,
              "Step of the first frame of --frames and --dump-frames, instead of the scene's "
              "render.first; 0: before the first step")
        ->valueText("N")
        ->transform(wholeNumber(0, kStepsMax));
    addOption(app, "--last-frame", player.overrides.last_frame,
              "Step of the last frame, instead of the scene's render.last; the run goes on to its end")
        ->valueText("N")
        ->transform(wholeNumber(0, kStepsMax));
    addOption(app, "--frame-every", player.overrides.frame_every,
              "Steps from frame to frame, instead of the scene's render.every")
        ->valueText("N")
        ->transform(wholeNumber(1, kStepsMax));
    addOption(app, "--events", player.events,
              "Write the hits while playing, a line of JSON each; - for standard output")
        ->valueText("OUT.jsonl");
    addOption(app, "--events-min-speed", player.events_min_speed,
              "Leave hits out of --events that are slower, world units a second")
        ->valueText("V")
        ->needs("--events")
        ->transform(number(0.0F, 1e9F, "a speed, 0 or more"));
}

/// Options that have no effect together.
Result<void> checkTogether(const SimCommand& command) {
    const PlayerOptions& player = command.player;
    const SceneOverrides& scene = player.overrides;
    if (player.input.empty()) {
        return fail(ErrorCode::kUsage,
                    "name a scene (.toml), a collider (.relief) or a world.json; see relief-sim --help");
    }
    if ((scene.first_frame || scene.last_frame || scene.frame_every) && player.frames.empty() &&
        player.dump_frames.empty()) {
        return fail(ErrorCode::kUsage,
                    "--first-frame, --last-frame and --frame-every need --frames or "
                    "--dump-frames; add --frames DIR");
    }
    if (scene.first_frame && scene.last_frame && *scene.first_frame > *scene.last_frame) {
        return fail(ErrorCode::kUsage, "--first-frame comes after --last-frame; swap them");
    }
    return {};
}

/// After the work: a run that fails has one line to say.
void showWarnings(const std::vector<std::string>& warnings, bool quiet) {
    for (const std::string& warning : warnings) {
        if (!quiet) {
            spdlog::warn(warning);
        }
    }
}

/// --check. With --json the object comes in either case.
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
        spdlog::warn("{} hits are missing in --events: a step lists at most {}; raise --events-min-speed",
                     played.events_dropped, Simulation::kEventsMax);
    }
    if (command.json) {
        return printOut(jsonTextOf(played));
    }
    if (!command.quiet && (player.dump == "-" || player.events == "-")) {
        std::fputs(reportText(played).c_str(), stderr);  // they have standard output to themselves
        return {};
    }
    return command.quiet ? Result<void>() : printOut(reportText(played));
}

}  // namespace

void defineSim(CLI::App& app, SimCommand& command) {
    setUpHelp(app);
    describeApp(
        app,
        "Plays a scene against a baked collider\n\n"
        "Headless: particles fall, collide and rest. Given a collider or a world alone it lets snow fall on "
        "it.",
        "relief-sim bunny_in_the_snow.toml --frames frames --dump snow.ply");
    addOption(app, "INPUT", command.player.input, "Scene (.toml), collider (.relief) or world (world.json)")
        ->typeName("SCENE.toml|COLLIDER.relief|WORLD.json");
    addOption(app, "--steps", command.player.overrides.steps, "Steps to play, instead of the scene's")
        ->valueText("N")
        ->transform(wholeNumber(0, kStepsMax));
    addOutputs(app, command);
    addOption(app, "--root", command.player.overrides.root,
              "Folder whose files the scene may name too, by ..; default: those of its own folder alone")
        ->valueText("DIR");
    addMemoryOption(app, command.player.overrides.limits);
    const OptionRef check =
        addFlag(app, "--check", command.check,
                "Only check the scene and what it names, without a GPU: one line, or the first error");
    addWords(app, "--api", command.player.gpu.api,
             WordsFor<GlApi>{{"gl", GlApi::kGl33Core}, {"gles", GlApi::kGles30}},
             "gl for OpenGL 3.3 (default), gles for OpenGL ES 3.0");
    addWords(
        app, "--path", command.player.path,
        WordsFor<StepPath>{
            {"auto", StepPath::kAuto}, {"fragment", StepPath::kFragment}, {"compute", StepPath::kCompute}},
        "How particles step, are sorted and drawn: fragment shaders, compute shaders (OpenGL 4.3, OpenGL ES "
        "3.1), or auto "
        "(default): "
        "compute on a GPU that has it");
    addFields(app, command.player.gpu);
    addFlag(app, "--json", command.json, "Print the report, or what --check finds, as JSON");
    const OptionRef page =
        addOption(app, "--page", command.page,
                  "Only write a page that plays the scene in a browser, without a GPU: one HTML file that "
                  "holds every file of the scene. It needs the player that scripts/build.sh web builds once")
            ->valueText("OUT.html");
    for (const char* played :
         {"--frames", "--dump", "--dump-frames", "--events", "--path", "--device", "--gpu-timeout"}) {
        check->excludes(played);
        page->excludes(played);
    }
    for (const char* of_run :
         {"--check", "--json", "--steps", "--seed", "--root", "--api", "--dump-format"}) {
        page->excludes(of_run);
    }
    addFlag(app, "-q,--quiet", command.quiet,
            "No progress and no summary; errors still, and what --json asks for");
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
