// The command line of `relief`: its verbs, and what is said where it cannot be read.
#pragma once

#include "bake/cli/command.h"
#include "formats/base/result.h"

namespace relief {

// One a verb: adds it to the command line; when it is called, `action` becomes what it does.
void addBake(CLI::App& app, Action& action);
void addCheck(CLI::App& app, Action& action);
void addDiff(CLI::App& app, Action& action);
void addInfo(CLI::App& app, Action& action);
void addQuery(CLI::App& app, Action& action);
void addSlice(CLI::App& app, Action& action);
void addExport(CLI::App& app, Action& action);

/// Parses the command line and does what it says.
[[nodiscard]] Result<void> runCommandLine(int argc, char** argv);

/// "relief: error: …" on standard error.
/// \return the exit code.
int reportError(const Error& error);

}  // namespace relief
