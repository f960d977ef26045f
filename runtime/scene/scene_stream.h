// The world of a scene that has only what is needed of it on the GPU.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "runtime/scene/loaded_scene.h"
#include "runtime/stream/world_stream.h"

namespace relief {

/// \param loaded  with a [stream].
/// \param bodies  the scene's colliders.
/// Errors: those of WorldStream::create and makeFileSource.
[[nodiscard]] Result<std::unique_ptr<WorldStream>> makeStream(const LoadedScene& loaded,
                                                              std::span<const ColliderBody> bodies);

/// Balls about the camera and about the birthplaces of each emitter, wider by the radius of the [stream].
/// \param seconds  since the beginning; emitters and a camera that move are where they are then.
/// \param motions  of the emitters.
[[nodiscard]] std::vector<PointOfInterest> streamPoints(const LoadedScene& loaded,
                                                        std::span<const EmitterMotion> motions,
                                                        double seconds);

}  // namespace relief
