// The JSON Schemas of what `relief` prints.
#pragma once

#include "formats/fields/generated.h"

namespace relief {

[[nodiscard]] GeneratedTexts bakeSchemas();

}  // namespace relief
