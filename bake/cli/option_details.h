// SPDX-License-Identifier: Apache-2.0
// Texts about the options of `relief` that are too long for --help. --manual and the manual pages print them.
#pragma once

#include <vector>

#include "runtime/command_line/command_line.h"

namespace relief {

/// Adds its details to each option of `relief bake`.
void addBakeDetails(CLI::App& verb);

/// Sorts the options of `relief bake` under headings.
void groupBakeOptions(CLI::App& verb);
/// Sorts the options of another verb under headings. \param groups  its own headings; common ones follow
void groupVerbOptions(CLI::App& verb, std::vector<OptionGroup> groups);

}  // namespace relief
