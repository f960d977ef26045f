// SPDX-License-Identifier: Apache-2.0
// Streamed worlds of scenes.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "runtime/births/emitter_motion.h"
#include "runtime/scene/loaded_scene.h"
#include "runtime/stream/world_stream.h"

namespace relief {

/// Creates the stream of a world.
/// \param loaded  with a [stream].
/// \param bodies  the colliders of the scene.
/// \param source  loads colliders; null: makeFileSource().
/// Errors: those of WorldStream::create() and makeFileSource().
[[nodiscard]] Result<std::unique_ptr<WorldStream>> makeStream(const LoadedScene& loaded,
                                                              std::span<const ColliderBody> bodies,
                                                              std::unique_ptr<ColliderSource> source);

/// Returns one ball per emitter, around all its birth positions, in the emitter's space.
[[nodiscard]] std::vector<PointOfInterest> emitterBalls(std::span<const Emitter> emitters);
/// Returns the balls in world space, enlarged by a radius.
/// \param motions  of the emitters.
/// \param radius   of the [stream].
/// \param seconds  time of the poses of moving emitters.
[[nodiscard]] std::vector<PointOfInterest> emitterPoints(std::span<const PointOfInterest> balls,
                                                         std::span<const EmitterMotion> motions, float radius,
                                                         double seconds);

}  // namespace relief
