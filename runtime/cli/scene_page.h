// SPDX-License-Identifier: Apache-2.0
// `relief-sim --page`: a page that plays a scene in a browser.
#pragma once

#include <string>
#include <vector>

#include "formats/base/result.h"
#include "runtime/player/player_options.h"

namespace relief {

/// Writes the page, which holds the scene and every file that it names. Needs no GPU. The same scene gives the same bytes.
/// \param options  a scene; only `input`, `overrides.limits` and `guard` count.
/// \return the warnings of the scene.
/// Errors: kUsage: not a scene; kUnsupported: a scene with a flow, no player; those of loadAll(), checkPictures(),
/// loadDrawnMeshes(), Page::make() and of FileGuard.
[[nodiscard]] Result<std::vector<std::string>> writeScenePage(PlayerOptions& options,
                                                              const std::string& output);

}  // namespace relief
