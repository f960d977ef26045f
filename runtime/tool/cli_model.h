// The command line of an executable as data, read off its CLI::App. The manual pages and the completions are made of it,
// so that they say what the program takes.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

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

struct CliProgram {
    std::string name;
    std::string version;
    CliCommand command;
};

/// \param app  its name is the program's, its description's first line the summary, its footer, by lines, the examples.
///             Options of the group "" are hidden, here too.
[[nodiscard]] CliProgram readProgram(const CLI::App& app, const std::string& version);

[[nodiscard]] std::string joined(const std::vector<std::string>& words, const char* separator);

/// A page of section 1 in man(7) macros, without a date.
/// \param verb  nullptr for the program's own page.
[[nodiscard]] std::string manPage(const CliProgram& program, const CliCommand* verb);

[[nodiscard]] std::string bashCompletion(const CliProgram& program);
[[nodiscard]] std::string zshCompletion(const CliProgram& program);
[[nodiscard]] std::string fishCompletion(const CliProgram& program);

}  // namespace relief
