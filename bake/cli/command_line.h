// The command line of `relief`.
#pragma once

#include "bake/cli/command.h"
#include "formats/base/result.h"

namespace relief {

// Each adds a verb. When it is called, `action` becomes what it does.
void addBake(CLI::App& app, Action& action);
void addCheck(CLI::App& app, Action& action);
void addDiff(CLI::App& app, Action& action);
void addInfo(CLI::App& app, Action& action);
void addQuery(CLI::App& app, Action& action);
void addSlice(CLI::App& app, Action& action);
void addView(CLI::App& app, Action& action);
void addExport(CLI::App& app, Action& action);

/// Gives an app named "relief" its verbs. `action` must outlive it.
void defineRelief(CLI::App& app, Action& action);

/// Parses the command line and does what it says.
[[nodiscard]] Result<void> runRelief(int argc, char** argv);

}  // namespace relief
