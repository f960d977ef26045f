// relief-pages FOLDER: writes the manual pages and completions of the executables, each's into FOLDER/PROGRAM as they
// lie under share. A program of the build: it is not installed.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <span>

#include "formats/base/file_io.h"
#include "runtime/cli/sim.h"
#include "runtime/tool/cli_model.h"
#include "runtime/tool/command_line.h"
#ifdef RELIEF_WITH_BAKE
#include "bake/cli/command_line.h"
#endif

namespace relief {
namespace {

Result<void> write(const std::filesystem::path& path, const std::string& text) {
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);
    return writeFile(path, std::as_bytes(std::span(text)));
}

Result<void> writePages(const CLI::App& app, const std::filesystem::path& pages) {
    const CliProgram program = readProgram(app, RELIEF_VERSION);
    const std::filesystem::path folder = pages / program.name;
    std::filesystem::remove_all(folder);
    RELIEF_TRY(write(folder / "man/man1" / (program.name + ".1"), manPage(program, nullptr)));
    for (const CliCommand& verb : program.command.verbs) {
        std::string name = verb.name;
        name.replace(name.find(' '), 1, "-");
        RELIEF_TRY(write(folder / "man/man1" / (name + ".1"), manPage(program, &verb)));
    }
    RELIEF_TRY(write(folder / "bash-completion/completions" / program.name, bashCompletion(program)));
    RELIEF_TRY(write(folder / "zsh/site-functions" / ("_" + program.name), zshCompletion(program)));
    return write(folder / "fish/vendor_completions.d" / (program.name + ".fish"), fishCompletion(program));
}

Result<void> writeAll(int argc, char** argv) {
    if (argc != 2) {
        return fail(ErrorCode::kUsage, "write relief-pages FOLDER");
    }
    CLI::App sim("", "relief-sim");
    SimCommand command;
    defineSim(sim, command);
    RELIEF_TRY(writePages(sim, argv[1]));
#ifdef RELIEF_WITH_BAKE
    CLI::App relief("", "relief");
    Action action;
    defineRelief(relief, action);
    RELIEF_TRY(writePages(relief, argv[1]));
#endif
    return {};
}

}  // namespace
}  // namespace relief

int main(int argc, char** argv) {
    return relief::runProgram(
        [&] { return relief::writeAll(argc, argv); },
        [](const relief::Error& error) { std::fprintf(stderr, "relief-pages: error: %s\n", error.message.c_str()); },
        {relief::ErrorCode::kFailure, "out of memory"});
}
