// What the verbs of `relief` share: one file a verb registers its options here and runs behind its library.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <string>

#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

/// What a verb does once the command line is parsed.
using Action = std::function<Result<void>()>;

struct CommonOptions {
    bool quiet = false;    ///< errors only
    bool verbose = false;  ///< details too
};

/// Adds a verb with -q and -v.
/// \param example  complete command lines, one a line: the help begins with them.
CLI::App& addVerb(CLI::App& app, CommonOptions& common, const std::string& name,
                  const std::string& description, const std::string& example);

/// Messages of one line on standard error, "relief: warning: …"; coloured on a terminal without NO_COLOR.
void startLogging(const CommonOptions& common);

/// A whole number option.
/// \param what  its name, for messages.
/// Errors: kUsage.
[[nodiscard]] Result<std::uint64_t> parseCount(const std::string& text, const std::string& what);

/// A share in percent, "1.5" or "1.5%", not negative.
/// \param what  its name, for messages.
/// Errors: kUsage.
[[nodiscard]] Result<float> parsePercent(const std::string& text, const std::string& what);

/// Writes text that a verb reports to standard output. Errors: kIo.
[[nodiscard]] Result<void> printOut(const std::string& text);

}  // namespace relief
