// Texts derived from the options of the verbs: the README's table, Python's arguments, the fuzz dictionary of recipes.
#pragma once

#include "formats/fields/generated.h"

namespace relief {

[[nodiscard]] GeneratedTexts bakeTexts();

/// The JSON Schemas of what `relief` prints.
[[nodiscard]] GeneratedTexts bakeSchemas();

}  // namespace relief
