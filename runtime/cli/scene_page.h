// SPDX-License-Identifier: Apache-2.0
// Writes the page of `relief-sim --page`, which plays a scene in a browser.
#pragma once

#include <string>
#include <vector>

#include "formats/base/result.h"
#include "runtime/player/player_options.h"

namespace relief {

/// Writes a page that contains the scene and every file that it names. Needs no GPU. Equal scenes produce equal bytes.
/// \param options  only `input`, `overrides.limits` and `guard` are used; `input` must be a scene.
/// \return the warnings of the scene.
/// Errors: kUsage (not a scene), kUnsupported (a scene with a flow, or a build without the player); those of loadAll(),
/// checkPictures(), loadDrawnMeshes(), Page::make() and FileGuard.
[[nodiscard]] Result<std::vector<std::string>> writeScenePage(PlayerOptions& options,
                                                              const std::string& output);

}  // namespace relief
