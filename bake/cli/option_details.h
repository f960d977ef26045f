// SPDX-License-Identifier: Apache-2.0
// The keys of --map and --heights for --manual and the manual pages, and the headings of --help.
#pragma once

#include <vector>

#include "runtime/command_line/command_line.h"

namespace relief {

/// Adds the keys of --map and --heights to the details of these options.
void addKeyDetails(CLI::App& verb);

/// Sorts the options of `relief bake` under headings.
void groupBakeOptions(CLI::App& verb);
/// Sorts the options of another verb under headings. \param groups  its own headings; common ones follow
void groupVerbOptions(CLI::App& verb, std::vector<OptionGroup> groups);

}  // namespace relief
