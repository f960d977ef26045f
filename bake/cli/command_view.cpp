// relief view: a page to turn a collider round in, drop particles on it, and see where it is wrong.
#include <CLI/CLI.hpp>
#include <span>

#include "bake/cli/command.h"
#include "bake/cli/view_source.h"
#include "formats/base/file_io.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/memory_option.h"

namespace relief {
namespace {

struct ViewCommand {
    CommonOptions common;
    ViewSource source;
    std::string output;
};

/// Beside FILE unless -o says where.
Result<std::string> outputOf(const ViewCommand& command) {
    if (!command.output.empty()) {
        return command.output;
    }
    if (command.source.file == "-") {
        return fail(ErrorCode::kUsage,
                    "a page of standard input has no name of its own; give it one with -o");
    }
    return std::filesystem::path(command.source.file).replace_extension(".html").string();
}

Result<void> checkSource(const ViewSource& source) {
    if (source.isScene() && !source.check.mesh.empty()) {
        return fail(ErrorCode::kUsage, "--mesh is for a collider, and " + quotedPath(source.file) +
                                           " is a scene; leave out --mesh, or view the collider");
    }
    return {};
}

Result<void> runView(const ViewCommand& command, FileGuard& files) {
    startLogging(command.common);
    RELIEF_TRY(checkSource(command.source));
    const std::string output = RELIEF_TRY(outputOf(command));
    RELIEF_TRY(files.reads(command.source.file));
    RELIEF_TRY(files.reads(command.source.check.mesh));
    RELIEF_TRY(files.writes(output, "-o"));
    const MadePage page = RELIEF_TRY(makeViewPage(command.source));
    // What the inputs refer to is known only now.
    for (const std::filesystem::path& file : page.files) {
        RELIEF_TRY(files.reads(file));
    }
    return writeFile(output, std::as_bytes(std::span(page.html)));
}

}  // namespace

void addView(CLI::App& app, Action& action) {
    auto command = std::make_shared<ViewCommand>();
    CLI::App& verb = addVerb(
        app, command->common, "view",
        "Makes a page to look at a collider, and to play with\n\nOne HTML file that holds everything and "
        "opens from disk in any browser with WebGL2: the surface as the maps see it,\nevery map, slices, and "
        "live "
        "particles. With --mesh also the mesh, the errors on it and the worst places of `relief check`.\n"
        "Of a scene: its particles, as relief-sim plays them.",
        "relief view bunny.relief\n"
        "relief view bunny.relief --mesh bunny.obj -o page.html\n"
        "relief view scene.toml");
    verb.add_option("FILE", command->source.file,
                    "The collider, or a scene (.toml); - for a collider on standard input")
        ->type_name("")
        ->required();
    addMeshOptions(verb, command->source.check);
    addFields(verb, command->source.check.import);
    addFields(verb, command->source.check.import_limits);
    addMemoryOption(verb, command->source.limits);
    verb.add_option("-o,--output", command->output,
                    "The page; - for standard output; default FILE with .html in place of its extension")
        ->option_text("OUT");
    verb.callback(
        [command, &action] { action = [command](FileGuard& files) { return runView(*command, files); }; });
}

}  // namespace relief
