// SPDX-License-Identifier: Apache-2.0
// The keys of --map and --heights for the manual pages, --manual and the README, and the headings of --help.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/command_line/command_line.h"

namespace relief {

/// The keys of --map and --heights as tables of Markdown.
[[nodiscard]] std::string mapKeyTable();
[[nodiscard]] std::string heightsKeyTable();

/// Adds the keys of --map and --heights to the details of these options.
void addKeyDetails(CLI::App& verb);

/// Sorts the options of `relief bake` under headings.
void groupBakeOptions(CLI::App& verb);
/// Sorts the options of another verb under headings. \param groups  its own headings; common ones follow
void groupVerbOptions(CLI::App& verb, std::vector<OptionGroup> groups);

}  // namespace relief
