#include "bake/cli/command_line.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdlib>

#include "bake/cli/response_file.h"
#include "runtime/tool/command_line.h"

namespace relief {
namespace {

void makeLogger() {
    auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
    if (const char* no_color = std::getenv("NO_COLOR"); no_color != nullptr && *no_color != '\0') {
        sink->set_color_mode(spdlog::color_mode::never);
    }
    auto logger = std::make_shared<spdlog::logger>("relief", std::move(sink));
    logger->set_pattern("relief: %^%l%$: %v");
    spdlog::set_default_logger(std::move(logger));
}

}  // namespace

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
    makeLogger();
    CLI::App app("", "relief");
    Action action;
    defineRelief(app, action);
    FileGuard files;
    std::vector<std::string> arguments = RELIEF_TRY(expandArguments(argumentsOf(argc, argv), files));
    return RELIEF_TRY(parseCommandLine(app, std::move(arguments))) ? action(files) : Result<void>();
}

void reportError(const Error& error) {
    spdlog::error(error.message);
}

}  // namespace relief
