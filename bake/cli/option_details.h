// SPDX-License-Identifier: Apache-2.0
// Texts about the options of `relief` that are too long for --help. The manual pages, --manual and the README are built
// from them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/command_line/command_line.h"

namespace relief {

/// Details of an option of `relief bake`; empty if its help is complete. \param name  "max_error"
[[nodiscard]] std::string_view bakeDetails(std::string_view name);

/// The keys of --map and --heights as tables of Markdown.
[[nodiscard]] std::string mapKeyTable();
[[nodiscard]] std::string heightsKeyTable();

/// Adds its details to each option of `relief bake`.
void addBakeDetails(CLI::App& verb);

/// Sorts the options of `relief bake` under headings.
void groupBakeOptions(CLI::App& verb);
/// Sorts the options of another verb under headings. \param groups  its own headings; common ones follow
void groupVerbOptions(CLI::App& verb, std::vector<OptionGroup> groups);

}  // namespace relief
