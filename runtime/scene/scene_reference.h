// SPDX-License-Identifier: Apache-2.0
// Checked-in texts derived from the fields of a scene; scripts/generate.sh writes them.
#pragma once

#include "formats/fields/generated.h"

namespace relief {

/// Returns the tables of README.md in this folder, the schema for editors, and the dictionary of the fuzzer.
[[nodiscard]] GeneratedTexts sceneReference();

}  // namespace relief
