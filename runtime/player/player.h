// SPDX-License-Identifier: Apache-2.0
// Plays a scene without a window: the work of relief-sim between its command line and its report.
#pragma once

#include "runtime/player/player_options.h"

namespace relief {

/// Frames, of every kind, are written after the steps that frameDue() of scene.h names.
/// Fails as loadAll, makeEmitters, GlContext, Simulation and Outputs do; a failed frame or dump ends the run.
[[nodiscard]] Result<PlayerReport> play(const PlayerOptions& options);

}  // namespace relief
