// SPDX-License-Identifier: Apache-2.0
// The command line of `relief`, and what its verbs share. One file a verb defines its options and runs it.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "formats/base/file_guard.h"
#include "formats/base/result.h"
#include "formats/container.h"
#include "formats/fields/generated.h"

namespace CLI {
class App;
}

namespace relief {

/// The work of a verb, after the command line is parsed.
using Action = std::function<Result<void>(FileGuard& files)>;

struct CommonOptions {
    bool quiet = false;     ///< errors only
    bool verbose = false;   ///< details too
    bool warnings = false;  ///< with quiet: warnings too
};

/// Adds a verb with -q, -v and --warnings-only, which choose the messages that appear.
/// \param example  complete command lines, one a line: the help begins with them.
CLI::App& addVerb(CLI::App& app, CommonOptions& common, const std::string& name,
                  const std::string& description, const std::string& example);

/// Runs `each` for every file. Of several, errors are shown as they come, and the other files still get their turn.
/// Errors: that of the only file; else the code of the first failure, with the number of failures.
[[nodiscard]] Result<void> forEachFile(const std::vector<std::string>& files,
                                       const std::function<Result<void>(const std::string& file)>& each);

/// "standard input" for "-", else the path in quotes: for messages.
[[nodiscard]] std::string shownInput(const std::string& file);
/// "standard input", or the name without its folder: for reports.
[[nodiscard]] std::string inputName(const std::string& file);

/// Whether a file is taken for a world: by its extension, .json.
[[nodiscard]] bool namesWorld(const std::string& file);

// Each adds a verb. When it is called, `action` becomes what it does.
void addBake(CLI::App& app, Action& action);
void addCheck(CLI::App& app, Action& action);
void addInfo(CLI::App& app, Action& action);
void addQuery(CLI::App& app, Action& action);
void addSlice(CLI::App& app, Action& action);
void addView(CLI::App& app, Action& action);
void addExport(CLI::App& app, Action& action);

/// Gives an app named "relief" its verbs. `action` must outlive it.
void defineRelief(CLI::App& app, Action& action);

/// Parses the command line and runs the verb.
[[nodiscard]] Result<void> runRelief(int argc, char** argv);

struct ColliderFile {
    std::vector<std::byte> bytes;
    Collider collider;
};
/// Errors: those of loadCollider, with the file in front.
[[nodiscard]] Result<ColliderFile> readColliderFile(const std::string& file, const ContainerLimits& limits);

/// Derived from the options of the verbs: the README's table, Python's arguments, the fuzz dictionary of recipes; and the
/// JSON Schemas of what `relief` prints.
[[nodiscard]] GeneratedTexts bakeTexts();

}  // namespace relief
