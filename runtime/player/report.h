// SPDX-License-Identifier: Apache-2.0
// The report of a run of relief-sim.
#pragma once

#include <string>

#include "formats/fields/generated.h"
#include "runtime/player/player.h"

namespace relief {

/// Returns the report as a few lines of text.
[[nodiscard]] std::string reportText(const PlayerReport& report);

/// Returns the JSON Schemas of all outputs of `relief-sim`.
[[nodiscard]] GeneratedTexts playerSchemas();

/// Returns "fragment" or "compute". \param path  not kAuto.
[[nodiscard]] constexpr std::string_view stepPathName(StepPath path) {
    return path == StepPath::kCompute ? "compute" : "fragment";
}

/// Describes the keys of the JSON report that `relief-sim --json` prints.
void fields(FieldVisitor& visit, const PlayerReport& report);

}  // namespace relief
