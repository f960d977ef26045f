// What the verbs of `relief` share: one file a verb defines its options and runs behind its library.
#pragma once

#include <functional>
#include <string>

#include "formats/base/file_guard.h"
#include "formats/base/result.h"

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

/// Adds a verb with -q and -v.
/// \param example  complete command lines, one a line: the help begins with them.
CLI::App& addVerb(CLI::App& app, CommonOptions& common, const std::string& name,
                  const std::string& description, const std::string& example);

/// Which messages appear.
void startLogging(const CommonOptions& common);

/// "standard input" for "-", else the path in quotes: for messages.
[[nodiscard]] std::string shownInput(const std::string& file);
/// "standard input", or the name without its folder: for reports.
[[nodiscard]] std::string inputName(const std::string& file);

}  // namespace relief
