// SPDX-License-Identifier: Apache-2.0
// Shared by the command lines of both executables: help, version, and usage errors.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "formats/base/result.h"

namespace CLI {
class App;
}

namespace relief {

/// Adds --help and --version. Call it before options and verbs are added. The help begins with the examples of
/// describeApp(). \param help  describes --help itself.
void setUpHelp(CLI::App& app, const std::string& help = "Print this help and exit");
/// Adds --help and --manual to a verb. --manual prints the help with all details; the manual page is made from it.
void setUpVerbHelp(CLI::App& verb);

/// The description of an option or verb. Only --manual shows the details.
[[nodiscard]] std::string withDetails(const std::string& help, const std::string& details);
/// Appends to the details of an option. Does nothing if the app has no such option.
void addDetails(CLI::App& app, const std::string& name, const std::string& details);

/// A heading in the help, and the names of its options, such as "--budget". Names that an app lacks have no effect.
struct OptionGroup {
    std::string title;
    std::vector<std::string> options;
};
/// Lists the options under headings, in this order. An option that is named twice appears under the first heading.
/// Options without a heading follow under "Options". Call it after all options are added.
void groupOptions(CLI::App& app, const std::vector<OptionGroup>& groups);

struct AppDeleter {
    void operator()(CLI::App* app) const;
};
/// A command line without options. \param name  name of the program
[[nodiscard]] std::unique_ptr<CLI::App, AppDeleter> makeApp(const std::string& name);
/// \param examples  complete command lines, one per line
void describeApp(CLI::App& app, const std::string& description, const std::string& examples);
/// Sets the function to call after the verb is parsed.
void onVerb(CLI::App& verb, std::function<void()> parsed);

struct GivenOption {
    std::string name;
    std::vector<std::string> long_names;  ///< without their dashes
};
/// Returns the options that the command line contains.
[[nodiscard]] std::vector<GivenOption> givenOptions(const CLI::App& parsed);

/// Parses the command line. Prints the texts of --help, --manual and --version.
/// \param arguments  arguments without the program's name
/// \return false if such a text was printed and the program is done
/// Errors: kUsage with a one-line message that names the option and the fix; kIo if the text cannot be printed.
[[nodiscard]] Result<bool> parseCommandLine(CLI::App& app, std::vector<std::string> arguments);

/// Returns all arguments except the program's name.
[[nodiscard]] std::vector<std::string> argumentsOf(int argc, char** argv);

/// Writes to standard output. Errors: kIo.
[[nodiscard]] Result<void> printOut(const std::string& text);

/// The body of main(). Exceptions become errors; signals remove temporary files. spdlog writes lines such as
/// "PROGRAM: warning: …" to standard error, coloured on a terminal unless NO_COLOR is set.
/// \return the exit code.
int runProgram(const std::string& program, const std::function<Result<void>()>& run,
               const Error& out_of_memory);

/// Logs "PROGRAM: error: …".
void reportError(const Error& error);

}  // namespace relief
