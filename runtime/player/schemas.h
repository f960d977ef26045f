// The JSON Schemas of what `relief-sim` prints and logs.
#pragma once

#include "formats/fields/generated.h"

namespace relief {

[[nodiscard]] GeneratedTexts playerSchemas();

}  // namespace relief
