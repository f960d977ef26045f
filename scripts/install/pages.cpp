// relief-pages FOLDER: writes the manual pages of the executables, made of the definitions of their command lines, in
// man(7) macros and without a date. A program of the build: it is not installed.
#include <CLI/CLI.hpp>
#include <algorithm>
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

/// An argument of a macro: quotes end it.
std::string argument(const std::string& text) {
    std::string out = escaped(text);
    for (std::size_t at = 0; (at = out.find('"', at)) != std::string::npos;) {
        out.replace(at, 1, "\\(dq");
    }
    return "\"" + out + "\"";
}

std::string pageName(const CLI::App& app) {
    return (app.get_parent() != nullptr ? app.get_parent()->get_name() + "-" : "") + app.get_name();
}

std::string commandName(const CLI::App& app) {
    return (app.get_parent() != nullptr ? app.get_parent()->get_name() + " " : "") + app.get_name();
}

/// The first line of a description, or the paragraphs after it.
std::string summaryOf(const CLI::App& app) {
    const std::string text = app.get_description();
    return text.substr(0, text.find('\n'));
}
std::string detailsOf(const CLI::App& app) {
    const std::string text = app.get_description();
    std::string out;
    for (std::size_t start = std::min(text.find("\n\n"), text.size()); start < text.size();) {
        const std::size_t end = std::min(text.find("\n\n", start + 2), text.size());
        out += ".PP\n" + escaped(std::string_view(text).substr(start + 2, end - start - 2)) + "\n";
        start = end;
    }
    return out;
}

/// "-o, --output"; of a positional its name.
std::string namesOf(const CLI::Option& option) {
    std::string names;
    for (const std::string& name : option.get_snames()) {
        names += (names.empty() ? "-" : ", -") + name;
    }
    for (const std::string& name : option.get_lnames()) {
        names += (names.empty() ? "--" : ", --") + name;
    }
    return names.empty() ? option.get_name(true) : names;
}

/// "OUT.relief"; empty: a flag, or a positional.
std::string valueOf(const CLI::Option& option) {
    if (option.get_positional() || option.get_expected_max() == 0) {
        return {};
    }
    return option.get_option_text().empty() ? option.get_type_name() : option.get_option_text();
}

/// Positionals first; those of the group "" are hidden.
std::vector<const CLI::Option*> optionsOf(const CLI::App& app) {
    std::vector<const CLI::Option*> options = app.get_options();
    std::erase_if(options, [](const CLI::Option* option) { return option->get_group().empty(); });
    std::ranges::stable_partition(options,
                                  [](const CLI::Option* option) { return option->get_positional(); });
    return options;
}

std::vector<const CLI::App*> verbsOf(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

std::string optionEntry(const CLI::Option& option) {
    const std::string value = valueOf(option);
    const std::string description = option.get_description();
    // Descriptions of several lines are tables for the terminal: their lines stay lines.
    const bool lines = description.find('\n') != std::string::npos;
    return ".TP\n" +
           (value.empty() ? ".BR " + argument(namesOf(option))
                          : ".BI " + argument(namesOf(option) + " ") + " " + argument(value)) +
           "\n" + (lines ? ".nf\n" : "") + escaped(description) + "\n" + (lines ? ".fi\n" : "");
}

std::string synopsis(const CLI::App& app) {
    std::string text = ".B " + escaped(commandName(app)) + "\n";
    for (const CLI::Option* option : optionsOf(app)) {
        if (option->get_positional()) {
            const std::string name = "\\fI" + escaped(namesOf(*option)) + "\\fR";
            text += (option->get_required() ? name : "[" + name + "]") + "\n";
        } else if (option->get_required()) {
            text += ".BI " + argument(option->get_name() + " ") + " " + argument(valueOf(*option)) + "\n";
        }
    }
    return text + (verbsOf(app).empty() ? "" : ".I VERB\n") + "[\\fIOPTION\\fR...]\n";
}

std::string exitCodes() {
    std::string text = ".TP\n.B 0\nsuccess\n";
    for (int code = 1; code <= static_cast<int>(ErrorCode::kDifference); ++code) {
        text += ".TP\n.B " + std::to_string(code) + "\n" +
                escaped(errorCodeName(static_cast<ErrorCode>(code))) + "\n";
    }
    return text + ".TP\n.B 128 + n\nended by signal n\n";
}

std::string seeAlso(const CLI::App& app) {
    const CLI::App& program = app.get_parent() != nullptr ? *app.get_parent() : app;
    std::string text = ".SH SEE ALSO\n";
    if (&program != &app) {
        text += ".BR " + escaped(program.get_name()) + " (1),\n";
    }
    for (const CLI::App* verb : verbsOf(program)) {
        text += verb == &app ? "" : ".BR " + escaped(pageName(*verb)) + " (1),\n";
    }
    return text + ".BR " + (program.get_name() == "relief" ? "relief\\-sim" : "relief") + " (1)\n";
}

std::string manPage(const CLI::App& app) {
    std::string summary = summaryOf(app);
    std::string text = ".TH " + argument(pageName(app)) + " 1 \"\" " + argument("Relief " RELIEF_VERSION) +
                       " \"Relief manual\"\n.SH NAME\n" + escaped(pageName(app)) + " \\- " +
                       escaped(lowerCase(summary.substr(0, 1)) + summary.substr(1)) + "\n.SH SYNOPSIS\n" +
                       synopsis(app) + ".SH DESCRIPTION\n" + escaped(summary) + ".\n" + detailsOf(app);
    text += verbsOf(app).empty() ? "" : ".SH VERBS\n";
    for (const CLI::App* verb : verbsOf(app)) {
        text += ".TP\n.BR " + escaped(pageName(*verb)) + " (1)\n" + escaped(summaryOf(*verb)) + "\n";
    }
    text += ".SH OPTIONS\n";
    for (const CLI::Option* option : optionsOf(app)) {
        text += optionEntry(*option);
    }
    return text + ".SH EXIT STATUS\n" + exitCodes() + ".SH EXAMPLES\n.nf\n" + escaped(app.get_footer()) +
           "\n.fi\n" + seeAlso(app);
}

Result<void> write(const CLI::App& app, const std::filesystem::path& folder) {
    const std::string text = manPage(app);
    RELIEF_TRY(writeFile(folder / (pageName(app) + ".1"), std::as_bytes(std::span(text))));
    for (const CLI::App* verb : verbsOf(app)) {
        RELIEF_TRY(write(*verb, folder));
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
    RELIEF_TRY(write(sim, argv[1]));
#ifdef RELIEF_WITH_BAKE
    CLI::App relief("", "relief");
    Action action;
    defineRelief(relief, action);
    RELIEF_TRY(write(relief, argv[1]));
#endif
    return {};
}

}  // namespace
}  // namespace relief

int main(int argc, char** argv) {
    return relief::runProgram("relief-pages", [&] { return relief::writeAll(argc, argv); },
                              {relief::ErrorCode::kFailure, "out of memory"});
}
