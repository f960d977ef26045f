// SPDX-License-Identifier: Apache-2.0
// Shared by the command lines of both executables: help, version and usage errors.
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

/// Adds --help and --version. Call it before adding options and verbs. Help starts with the examples, which are the
/// footer.
/// \param help  help text of --help itself.
void setUpHelp(CLI::App& app, const std::string& help = "Print this help and exit");

struct AppDeleter {
    void operator()(CLI::App* app) const;
};
/// Creates a command line without options. \param name  of the program.
[[nodiscard]] std::unique_ptr<CLI::App, AppDeleter> makeApp(const std::string& name);
/// \param examples  complete command lines, one per line.
void describeApp(CLI::App& app, const std::string& description, const std::string& examples);
/// Sets a callback for when the verb was parsed.
void onVerb(CLI::App& verb, std::function<void()> parsed);

struct GivenOption {
    std::string name;
    std::vector<std::string> long_names;  ///< without their dashes
};
/// Returns the options that were given on the command line.
[[nodiscard]] std::vector<GivenOption> givenOptions(const CLI::App& parsed);

/// Parses the command line. Prints the output of --help and --version.
/// \param arguments  without the program name.
/// \return false after --help or --version, otherwise true.
/// Errors: kUsage, one line that names the option and the cure; kIo if the output cannot be printed.
[[nodiscard]] Result<bool> parseCommandLine(CLI::App& app, std::vector<std::string> arguments);

/// Returns all arguments except the program name.
[[nodiscard]] std::vector<std::string> argumentsOf(int argc, char** argv);

/// Writes to standard output. Errors: kIo.
[[nodiscard]] Result<void> printOut(const std::string& text);

/// The body of main(). Reports errors and exceptions; removes temporary files on signals. Directs spdlog to standard
/// error as "PROGRAM: warning: …", coloured on a terminal unless NO_COLOR is set.
/// \return the exit code.
int runProgram(const std::string& program, const std::function<Result<void>()>& run,
               const Error& out_of_memory);

/// Prints "PROGRAM: error: …" to standard error.
void reportError(const Error& error);

}  // namespace relief
