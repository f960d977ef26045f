// The command line of an executable as data, read off its CLI::App: what the manual pages and the completions
// are made of, so that they say what the program takes. For executables; no part of the libraries.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace relief {

/// What a shell may offer for a value.
enum class CliValue { kNone, kWords, kFile, kFolder };

struct CliOption {
    std::vector<std::string> names;  ///< "-o", "--output"; of a positional its name, without dashes
    std::string value;               ///< "OUT.relief"; empty: a flag
    std::string description;         ///< lines separated by '\n'
    std::vector<std::string> words;  ///< of a value written as a|b|c
    CliValue kind = CliValue::kNone;
    bool positional = false;
    bool required = false;
    bool repeatable = false;
};

struct CliCommand {
    std::string name;                   ///< "relief", "relief bake"
    std::string summary;                ///< one line
    std::string description;            ///< what follows it; paragraphs separated by empty lines; perhaps ""
    std::vector<std::string> examples;  ///< complete command lines
    std::vector<CliOption> options;     ///< positionals first
    std::vector<CliCommand> verbs;
};

/// What the program is, beside what its CLI::App knows.
struct CliProgram {
    std::string name;
    std::string version;
    CliCommand command;
};

/// \param app       its description's first line is the summary; its footer, by lines, the examples, unless
///                  `examples` are given. Options of the group "" are hidden, here too.
[[nodiscard]] CliProgram readProgram(const CLI::App& app, const std::string& name,
                                     const std::string& version);

/// `PROGRAM --dump-cli FORMAT`, which is in no help: json, man, man:VERB, bash, zsh or fish. To be asked
/// before the command line is parsed. \return what to print; nullopt where the command line is another one,
/// or FORMAT unknown.
[[nodiscard]] std::optional<std::string> dumpedCommandLine(const CliProgram& program, int argc,
                                                           const char* const* argv);

// The formats, one file each; dumpedCommandLine chooses.

/// What cmake reads: {"program", "version", "verbs": [{"name", "options": [{…}]}], "options": […]}.
[[nodiscard]] std::string cliJson(const CliProgram& program);

/// A page of section 1 in man(7) macros, without a date.
/// \param verb  nullptr for the program's own page.
[[nodiscard]] std::string manPage(const CliProgram& program, const CliCommand* verb);

[[nodiscard]] std::string bashCompletion(const CliProgram& program);
[[nodiscard]] std::string zshCompletion(const CliProgram& program);
[[nodiscard]] std::string fishCompletion(const CliProgram& program);

}  // namespace relief
