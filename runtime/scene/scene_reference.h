// SPDX-License-Identifier: Apache-2.0
// Everything that is derived from the fields of a scene and checked in; scripts/generate.sh writes it.
#pragma once

#include "formats/fields/generated.h"

namespace relief {

/// The tables of README.md beside this file, the schema for editors, and the dictionary of the fuzzer.
[[nodiscard]] GeneratedTexts sceneReference();

}  // namespace relief
