#include "bake/cli/command_line.h"

#include <CLI/CLI.hpp>

#include "runtime/command_line/command_line.h"

namespace relief {
void defineRelief(CLI::App& app, Action& action) {
    setUpHelp(app, "Print this help and exit; `relief VERB --help` explains a verb");
    app.description("Bakes meshes into depth map colliders, and looks into them");
    app.footer(
        "relief bake bunny.obj -o bunny.relief\nrelief info bunny.relief\n"
        "relief slice bunny.relief --axis z --at center -o slice.png");
    app.require_subcommand(1);
    for (const auto& add : {addBake, addCheck, addDiff, addInfo, addQuery, addSlice, addView, addExport}) {
        add(app, action);
    }
}

Result<void> runRelief(int argc, char** argv) {
    CLI::App app("", "relief");
    Action action;
    defineRelief(app, action);
    FileGuard files;
    return RELIEF_TRY(parseCommandLine(app, argumentsOf(argc, argv))) ? action(files) : Result<void>();
}

}  // namespace relief
