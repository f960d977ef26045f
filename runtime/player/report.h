// SPDX-License-Identifier: Apache-2.0
// The report of a run of relief-sim.
#pragma once

#include <string>

#include "formats/fields/generated.h"
#include "runtime/player/player.h"

namespace relief {

/// A few lines for people.
[[nodiscard]] std::string reportText(const PlayerReport& report);

/// The JSON Schemas of all that `relief-sim` prints and logs.
[[nodiscard]] GeneratedTexts playerSchemas();

/// "fragment" or "compute"; not of kAuto
[[nodiscard]] constexpr std::string_view stepPathName(StepPath path) {
    return path == StepPath::kCompute ? "compute" : "fragment";
}

/// `relief-sim --json`. Keys: README.md beside this file, "The report".
void fields(FieldVisitor& visit, const PlayerReport& report);

}  // namespace relief
