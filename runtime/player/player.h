// SPDX-License-Identifier: Apache-2.0
// Runs a scene without a window.
#pragma once

#include "runtime/player/player_options.h"

namespace relief {

/// Runs a scene. Writes frames and dumps after the steps for which frameDue() in scene.h is true.
/// Errors: those of loadAll, makeEmitters, GlContext, Simulation and Outputs. A failed frame or dump ends the run.
[[nodiscard]] Result<PlayerReport> play(const PlayerOptions& options);

}  // namespace relief
