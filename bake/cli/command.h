// SPDX-License-Identifier: Apache-2.0
// The command line of `relief`, and code that its verbs share. Each verb has a file that defines its options and runs it.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "formats/base/file_guard.h"
#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/container_limits.h"
#include "formats/fields/generated.h"

namespace CLI {
class App;
}

namespace relief {

/// The work of a verb, after the command line is parsed.
using Action = std::function<Result<void>(FileGuard& files)>;

struct CommonOptions {
    bool quiet = false;     ///< errors only
    bool verbose = false;   ///< also details
    bool warnings = false;  ///< with quiet: also warnings
};

/// Adds a verb with --help, --manual, and the options that select messages: -q, -v and --warnings-only.
/// \param description  a summary line, an empty line, and text for --help; withDetails() adds text for --manual
/// \param example  complete command lines, one per line; the help starts with them
CLI::App& addVerb(CLI::App& app, CommonOptions& common, const std::string& name,
                  const std::string& description, const std::string& example);

/// Runs `each` for every file. With several files, it logs errors immediately and continues with the next file.
/// Errors: the error of a single file; for several files, the first error's code and the number of failures.
[[nodiscard]] Result<void> forEachFile(const std::vector<std::string>& files,
                                       const std::function<Result<void>(const std::string& file)>& each);

/// Sets `action` to `run` if the parsed command line contains the verb.
void setAction(CLI::App& verb, Action& action, Action run);

void logWarnings(const std::vector<std::string>& warnings);

/// For messages: "standard input" for "-", otherwise the quoted path.
[[nodiscard]] std::string inputText(const std::string& file);
/// For reports: "standard input" for "-", otherwise the file's name without its folder.
[[nodiscard]] std::string inputName(const std::string& file);

/// Returns whether a file is a world, by its extension .json.
[[nodiscard]] bool isWorldFile(const std::string& file);

// Each function adds a verb, which sets `action` if the parsed command line contains it.
void addBake(CLI::App& app, Action& action);
void addCheck(CLI::App& app, Action& action);
void addInfo(CLI::App& app, Action& action);
void addQuery(CLI::App& app, Action& action);
void addSlice(CLI::App& app, Action& action);
void addView(CLI::App& app, Action& action);
void addExport(CLI::App& app, Action& action);

/// Adds the verbs to an app named "relief". `action` must outlive the app.
void defineRelief(CLI::App& app, Action& action);

/// Parses the command line and runs the verb.
[[nodiscard]] Result<void> runRelief(int argc, char** argv);

struct ColliderFile {
    std::vector<std::byte> bytes;
    Collider collider;
};
/// Errors: those of loadCollider, prefixed with the file.
[[nodiscard]] Result<ColliderFile> readColliderFile(const std::string& file, const ContainerLimits& limits);

/// Texts derived from the options of the verbs: Python's arguments, the fuzz dictionary of recipes, and the JSON Schemas
/// of the reports.
[[nodiscard]] GeneratedTexts bakeTexts();

}  // namespace relief
