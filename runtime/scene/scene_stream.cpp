// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_stream.h"

#include <glm/geometric.hpp>

namespace relief {
namespace {

constexpr double kMegabyte = 1e6;
/// Maximum number of remote requests in flight: browsers allow six connections per server.
constexpr std::size_t kRemoteRequestsMax = 6;

/// Returns a ball around all birth positions, in the space of the emitter.
PointOfInterest ballOf(const EmitterSettings& emitter) {
    Bounds box;
    switch (emitter.shape) {
        case EmitterShape::kPoints:
            for (const glm::vec3& point : emitter.points.positions) {
                box.add(point);
            }
            break;
        case EmitterShape::kSurface:
            box = emitter.surface->bounds();
            break;
        case EmitterShape::kBox:
        case EmitterShape::kPoint:
            box = {emitter.box_min, emitter.shape == EmitterShape::kBox ? emitter.box_max : emitter.box_min};
            break;
        default:
            return {emitter.center, emitter.radius};
    }
    return {box.center(), 0.5F * glm::length(box.size())};
}

}  // namespace

Result<std::unique_ptr<WorldStream>> makeStream(const LoadedScene& loaded,
                                                std::span<const ColliderBody> bodies,
                                                std::unique_ptr<ColliderSource> source) {
    const Scene& scene = loaded.scene;
    StreamOptions options{.gpu_bytes = static_cast<std::uint64_t>(kMegabyte * double{scene.stream->memory})};
    if (source) {
        options.under_way = kRemoteRequestsMax;
    } else {
        source = RELIEF_TRY(makeFileSource(loaded.world, scene.world.parent_path(), loaded.limits));
    }
    std::vector<const Collider*> coarse;
    for (const auto& collider : loaded.world_colliders) {
        coarse.push_back(collider.get());
    }
    return WorldStream::create(loaded.world, bodies, coarse, std::move(source), options);
}

std::vector<PointOfInterest> emitterBalls(std::span<const Emitter> emitters) {
    std::vector<PointOfInterest> balls;
    for (const Emitter& emitter : emitters) {
        balls.push_back(ballOf(emitter.settings()));
    }
    return balls;
}

std::vector<PointOfInterest> emitterPoints(std::span<const PointOfInterest> balls,
                                           std::span<const EmitterMotion> motions, float radius,
                                           double seconds) {
    std::vector<PointOfInterest> points;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        Birth middle{.position = balls[i].position};
        carry(motions[i], seconds, {&middle, 1});
        points.push_back({middle.position, balls[i].radius + radius});
    }
    return points;
}

}  // namespace relief
