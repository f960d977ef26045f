// SPDX-License-Identifier: Apache-2.0
// The world of a scene that has only what is needed of it on the GPU.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "runtime/births/emitter_motion.h"
#include "runtime/scene/loaded_scene.h"
#include "runtime/stream/world_stream.h"

namespace relief {

/// \param loaded  with a [stream].
/// \param bodies  the scene's colliders.
/// \param source  of the world's; null: makeFileSource().
/// Errors: those of WorldStream::create and makeFileSource.
[[nodiscard]] Result<std::unique_ptr<WorldStream>> makeStream(const LoadedScene& loaded,
                                                              std::span<const ColliderBody> bodies,
                                                              std::unique_ptr<ColliderSource> source);

/// A ball that holds all birthplaces of each emitter, in its own space.
[[nodiscard]] std::vector<PointOfInterest> emitterBalls(std::span<const Emitter> emitters);
/// The same in the world, wider by a radius.
/// \param motions  of the emitters.
/// \param radius   of the [stream].
/// \param seconds  since the beginning; emitters that move are where they are then.
[[nodiscard]] std::vector<PointOfInterest> emitterPoints(std::span<const PointOfInterest> balls,
                                                         std::span<const EmitterMotion> motions, float radius,
                                                         double seconds);
/// A ball of the radius of the [stream] about the scene's camera.
[[nodiscard]] PointOfInterest cameraPoint(const LoadedScene& loaded, double seconds);

}  // namespace relief
