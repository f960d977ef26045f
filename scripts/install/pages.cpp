// relief-pages FOLDER: writes the manual pages of the executables, which show their --help, in man(7) macros and without a
// date. A program of the build: it is not installed.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <span>

#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "runtime/cli/sim.h"
#include "runtime/command_line/command_line.h"
#ifdef RELIEF_WITH_BAKE
#include "bake/cli/command_line.h"
#endif

namespace relief {
namespace {

/// Text as roff prints it: backslashes, and hyphens that can be copied as such; no line is taken for a request.
std::string escaped(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if ((c == '.' || c == '\'') && (i == 0 || text[i - 1] == '\n')) {
            out += "\\&";
        }
        out += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
    }
    return out;
}

std::string exitCodes() {
    std::string text = ".TP\n.B 0\nsuccess\n";
    for (int code = 1; code <= static_cast<int>(ErrorCode::kDifference); ++code) {
        text += ".TP\n.B " + std::to_string(code) + "\n" +
                escaped(errorCodeName(static_cast<ErrorCode>(code))) + "\n";
    }
    return text + ".TP\n.B 128 + n\nended by signal n\n";
}

/// \param program  whose verb it is; empty: a program itself.
Result<void> write(const CLI::App& app, const std::string& program, const std::filesystem::path& folder) {
    const std::string page = (program.empty() ? "" : program + "-") + app.get_name();
    const std::string description = app.get_description();
    const std::string summary = description.substr(0, description.find('\n'));
    const std::string text =
        ".TH \"" + escaped(page) + "\" 1 \"\" \"Relief " RELIEF_VERSION "\" \"Relief manual\"\n.SH NAME\n" +
        escaped(page) + " \\- " + escaped(lowerCase(summary.substr(0, 1)) + summary.substr(1)) +
        "\n.SH DESCRIPTION\n.nf\n" + escaped(app.help(program)) + "\n.fi\n.SH EXIT STATUS\n" + exitCodes();
    RELIEF_TRY(writeFile(folder / (page + ".1"), std::as_bytes(std::span(text))));
    for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
        RELIEF_TRY(write(*verb, app.get_name(), folder));
    }
    return {};
}

Result<void> writeAll(int argc, char** argv) {
    if (argc != 2) {
        return fail(ErrorCode::kUsage, "write relief-pages FOLDER");
    }
    std::error_code error;
    std::filesystem::create_directories(argv[1], error);
    CLI::App sim("", "relief-sim");
    SimCommand command;
    defineSim(sim, command);
    RELIEF_TRY(write(sim, "", argv[1]));
#ifdef RELIEF_WITH_BAKE
    CLI::App relief("", "relief");
    Action action;
    defineRelief(relief, action);
    RELIEF_TRY(write(relief, "", argv[1]));
#endif
    return {};
}

}  // namespace
}  // namespace relief

int main(int argc, char** argv) {
    return relief::runProgram("relief-pages", [&] { return relief::writeAll(argc, argv); },
                              {relief::ErrorCode::kFailure, "out of memory"});
}
