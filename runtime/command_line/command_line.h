// SPDX-License-Identifier: Apache-2.0
// Shared by the command lines of both executables: help, version, and errors of usage.
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

/// Gives a program its --help and --version, before it gets its options and verbs. Help begins with the examples: the
/// lines of the footer. \param help  the help text of --help.
void setUpHelp(CLI::App& app, const std::string& help = "Print this help and exit");

struct AppDeleter {
    void operator()(CLI::App* app) const;
};
/// A command line without options. \param name  of the program
[[nodiscard]] std::unique_ptr<CLI::App, AppDeleter> makeApp(const std::string& name);
/// \param examples  complete command lines, one a line
void describeApp(CLI::App& app, const std::string& description, const std::string& examples);
/// Calls back once a verb is parsed.
void onVerb(CLI::App& verb, std::function<void()> parsed);

struct GivenOption {
    std::string name;
    std::vector<std::string> long_names;  ///< without their dashes
};
/// The options that a command line contains.
[[nodiscard]] std::vector<GivenOption> givenOptions(const CLI::App& parsed);

/// Parses the command line. Prints the answers to --help and --version.
/// \param arguments  without the program's name.
/// \return whether there is anything left to do.
/// Fails with kUsage and one line that names the option and the cure; with kIo if the answer cannot be printed.
[[nodiscard]] Result<bool> parseCommandLine(CLI::App& app, std::vector<std::string> arguments);

/// All arguments but the program's name.
[[nodiscard]] std::vector<std::string> argumentsOf(int argc, char** argv);

/// Writes to standard output. Fails with kIo.
[[nodiscard]] Result<void> printOut(const std::string& text);

/// The body of main(). Exceptions become errors; signals remove temporary files. spdlog's messages are lines on standard
/// error, "PROGRAM: warning: …", coloured on a terminal without NO_COLOR.
/// \return the exit code.
int runProgram(const std::string& program, const std::function<Result<void>()>& run,
               const Error& out_of_memory);

/// "PROGRAM: error: …"
void reportError(const Error& error);

}  // namespace relief
