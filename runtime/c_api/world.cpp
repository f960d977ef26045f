// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "formats/base/text.h"
#include "runtime/bodies/world_bodies.h"
#include "runtime/c_api/objects.h"
#include "runtime/gl/gl_object.h"
#include "runtime/picture/collider_view.h"

using namespace relief;  // NOLINT: the C functions are outside of it

namespace {

// Limits of relief_runtime.h and of the format.
constexpr FieldRange kRotation = within(1.001);
constexpr float kUnitTolerance = 1e-3F;
constexpr double kStreamBytesMax = 1099511627776.0;

std::size_t bodyCount(const WorldObject& world) {
    return world.field.world().bodies.size() + world.added.size();
}

Result<const WorldObject*> worldWithBody(const Call& call, const relief_world* world, std::size_t body) {
    const WorldObject* of = RELIEF_TRY(call.object(world, "world"));
    RELIEF_TRY(call.index(body, bodyCount(*of), "body", "bodies"));
    return of;
}

Pose poseIn(const WorldObject& world, std::size_t body) {
    const std::vector<WorldBody>& bodies = world.field.world().bodies;
    return body < bodies.size() ? poseOf(bodies[body]) : world.added[body - bodies.size()].pose;
}

/// Uploads the bodies of the world; animated bodies follow the others.
Result<TexturesObject> upload(const WorldObject& world) {
    const LoadedWorld& loaded = world.field.loaded();
    std::vector<ColliderBody> bodies = worldBodies(loaded);
    std::vector<AnimatedBody> animated;
    for (const AddedBody& added : world.added) {
        const auto& mesh = added.animation.mesh;
        animated.push_back({static_cast<std::uint32_t>(bodies.size() + animated.size()),
                            RELIEF_TRY(AnimatedCollider::create(mesh, added.options)),
                            {}});
        animated.back().trail.show(
            0.0, [mesh] { return posed(*mesh, firstPose(*mesh)); }, true);
    }
    for (std::size_t i = 0; i < animated.size(); ++i) {
        const AnimatedCollider& of = animated[i].collider;
        bodies.push_back({.collider = &of.frames(), .pose = of.placed(world.added[i].pose), .live = true});
    }
    auto textures = RELIEF_TRY(WorldTextures::create(bodies));
    auto made = RELIEF_TRY(texturesObject(std::move(textures)));
    const ColliderView view = worldView(loaded, made.textures());
    Bounds bounds = view.bounds;
    made.texel = view.texel;
    made.poses = worldPoses(loaded.world);
    made.placed = made.poses;
    for (std::size_t i = 0; i < animated.size(); ++i) {
        AnimatedCollider& of = animated[i].collider;
        const Bounds box = toWorld(of.placed(world.added[i].pose), of.frames().bounds);
        bounds.add(box.min);
        bounds.add(box.max);
        made.texel =
            std::min(made.texel, box.longestSide() / static_cast<float>(of.frames().maps.front().width));
        made.poses.push_back(world.added[i].pose);
        made.placed.push_back(of.placed(world.added[i].pose));
        RELIEF_TRY(of.update(*made.own, animated[i].body));
    }
    made.before = made.poses;
    made.world = bounds;
    made.animated = std::move(animated);
    return made;
}

}  // namespace

Result<Pose> relief::poseOf(const Call& call, const relief_pose& given, NumberName name, const Pose& rest) {
    name.field = "position";
    RELIEF_TRY(call.number(given.position, kAny, name));
    name.field = "rotation";
    RELIEF_TRY(call.number(given.rotation, kRotation, name));
    const glm::quat turn(given.rotation[3], given.rotation[0], given.rotation[1], given.rotation[2]);
    if (!(std::abs(glm::length(turn) - 1.0F) <= kUnitTolerance)) {
        return call.reject(name.text() + " has a length of " + shortest(glm::length(turn)) +
                           "; normalize the quaternion, or pass 0, 0, 0, 1");
    }
    return Pose{vec(given.position), glm::normalize(turn), rest.scale};
}

relief_world* relief_world_load(const char* world_path) {
    return create<relief_world>(__func__, [&](const Call& call) -> Result<WorldObject> {
        RELIEF_TRY(call.notNull(world_path, "world_path"));
        return WorldObject{WorldField(RELIEF_TRY(loadWorld(world_path)))};
    });
}

void relief_world_free(relief_world* world) {
    release(__func__, world, "world");
}

size_t relief_world_body_count(const relief_world* world) {
    return answer(__func__, std::size_t{0}, [&](const Call& call) -> Result<std::size_t> {
        return bodyCount(*RELIEF_TRY(call.object(world, "world")));
    });
}

size_t relief_world_find(const relief_world* world, const char* node, uint32_t* bodies, size_t count) {
    return answer(__func__, std::size_t{0}, [&](const Call& call) -> Result<std::size_t> {
        const World& all = RELIEF_TRY(call.object(world, "world"))->field.world();
        RELIEF_TRY(call.notNull(node, "node"));
        RELIEF_TRY(call.array(bodies, "bodies", count, "count"));
        const std::vector<std::size_t> found = findBodies(all, node);
        if (found.empty()) {
            return call.reject("node is '" + cleanUtf8(node) +
                               "'; no body of the world has a node of that name");
        }
        std::transform(found.begin(),
                       found.begin() + static_cast<std::ptrdiff_t>(std::min(count, found.size())), bodies,
                       [](std::size_t body) { return static_cast<std::uint32_t>(body); });
        return found.size();
    });
}

const char* relief_world_node(const relief_world* world, size_t body) {
    return answer(__func__, "", [&](const Call& call) -> Result<const char*> {
        const std::vector<WorldBody>& bodies =
            RELIEF_TRY(worldWithBody(call, world, body))->field.world().bodies;
        return body < bodies.size() ? bodies[body].node.c_str() : "";
    });
}

void relief_world_bounds(const relief_world* world, float min[3], float max[3]) {
    writeBounds(__func__, min, max, [&](const Call& call) -> Result<Bounds> {
        const WorldObject& of = *RELIEF_TRY(call.object(world, "world"));
        if (bodyCount(of) == 0) {
            return call.reject("world has no bodies; add one with relief_world_add()");
        }
        Bounds bounds = worldBounds(of.field.world());
        for (const AddedBody& added : of.added) {
            const Bounds box = toWorld(added.pose, added.animation.extent.box);
            bounds.add(box.min);
            bounds.add(box.max);
        }
        return bounds;
    });
}

int relief_world_pose(const relief_world* world, size_t body, relief_pose* pose) {
    return answer(__func__, -1, [&](const Call& call) -> Result<int> {
        RELIEF_TRY(call.notNull(pose, "pose"));
        std::fill_n(pose->position, 3, kNan);
        std::fill_n(pose->rotation, 4, kNan);
        const WorldObject& of = *RELIEF_TRY(worldWithBody(call, world, body));
        const Pose from = poseIn(of, body);
        put(from.position, pose->position);
        const std::array<float, 4> turn{from.rotation.x, from.rotation.y, from.rotation.z, from.rotation.w};
        std::copy_n(turn.begin(), 4, pose->rotation);
        return 0;
    });
}

void relief_world_query(const relief_world* world, const float* points, size_t count,
                        relief_sample* samples) {
    query(__func__, world, "world", points, count, samples,
          [](const WorldObject& of, const glm::vec3& point) {
              const WorldSample from = of.field.evaluate(point);
              relief_sample sample{from.distance, {}, from.body};
              put(from.normal, sample.normal);
              return sample;
          });
}

relief_textures* relief_textures_create_world(const relief_world* world) {
    return create<relief_textures>(__func__, [&](const Call& call) -> Result<TexturesObject> {
        const WorldObject& from = *RELIEF_TRY(call.object(world, "world"));
        if (bodyCount(from) == 0) {
            return call.reject("world has no bodies; add one with relief_world_add()");
        }
        RELIEF_TRY(call.context());
        return upload(from);
    });
}

int relief_textures_set_poses(relief_textures* world_textures, const uint32_t* bodies,
                              const relief_pose* poses, size_t count) {
    return answer(__func__, -1, [&](const Call& call) -> Result<int> {
        TexturesObject& to = *RELIEF_TRY(call.object(world_textures, "world_textures"));
        RELIEF_TRY(call.array(bodies, "bodies", count, "count"));
        RELIEF_TRY(call.array(poses, "poses", count, "count"));
        if (!to.world) {
            return call.reject(
                "world_textures contains a single collider, which has no pose; create the textures from a "
                "world");
        }
        RELIEF_TRY(call.context());
        std::vector<Pose> wanted = to.poses;
        for (std::size_t i = 0; i < count; ++i) {
            RELIEF_TRY(call.number(bodies[i], {0.0, static_cast<double>(wanted.size() - 1)}, {"bodies", i}));
            wanted[bodies[i]] = RELIEF_TRY(poseOf(call, poses[i], {"poses", i}, wanted[bodies[i]]));
        }
        to.before = std::exchange(to.poses, std::move(wanted));
        if (to.stream) {
            to.stream->setPoses(to.poses);
            return 0;
        }
        std::vector<Pose> placed = to.poses;
        bool jumps = false;
        for (AnimatedBody& one : to.animated) {
            const bool first = one.fresh && one.next;
            one.trail.hold();
            if (one.next) {
                const MeshPose pose = *std::exchange(one.next, std::nullopt);
                RELIEF_TRY(one.collider.setPose(pose));
                one.show(pose, first);
                one.fresh = false;
            }
            placed[one.body] = one.collider.placed(placed[one.body]);
            if (first) {
                one.collider.settle();
                to.before[one.body] = to.poses[one.body];
                to.placed[one.body] = placed[one.body];
                jumps = true;
            }
        }
        if (jumps) {
            to.own->setPoses(to.placed);
        }
        to.own->setPoses(placed);
        to.placed = std::move(placed);
        for (AnimatedBody& one : to.animated) {
            RELIEF_TRY(one.collider.update(*to.own, one.body));
        }
        return 0;
    });
}

relief_textures* relief_textures_stream_world(const char* world_path, uint64_t gpu_bytes) {
    return create<relief_textures>(__func__, [&](const Call& call) -> Result<TexturesObject> {
        RELIEF_TRY(call.notNull(world_path, "world_path"));
        RELIEF_TRY(call.number(static_cast<double>(gpu_bytes), {1.0, kStreamBytesMax}, {"gpu_bytes"}));
        RELIEF_TRY(call.context());
        const LoadedWorld coarse = RELIEF_TRY(loadWorld(world_path, {}, WorldDetail::kCoarse));
        const World& world = coarse.world;
        auto stream = RELIEF_TRY(WorldStream::open(coarse, world_path, {.gpu_bytes = gpu_bytes}));
        auto made = RELIEF_TRY(texturesObject(std::move(stream)));
        made.world = worldBounds(world);
        made.texel = made.world->longestSide() / 2048.0F;
        made.poses = worldPoses(world);
        return made;
    });
}

int64_t relief_textures_stream(relief_textures* world_textures, const relief_sphere* spheres, size_t count,
                               int wait) {
    return answer(__func__, int64_t{-1}, [&](const Call& call) -> Result<int64_t> {
        TexturesObject& to = *RELIEF_TRY(call.object(world_textures, "world_textures"));
        RELIEF_TRY(call.array(spheres, "spheres", count, "count"));
        RELIEF_TRY(call.number(wait, {0.0, 1.0}, {"wait"}));
        std::vector<PointOfInterest> points;
        for (std::size_t i = 0; i < count; ++i) {
            RELIEF_TRY(call.number(spheres[i].center, kAny, {"spheres", i, "center"}));
            RELIEF_TRY(call.number(spheres[i].radius, kLifetime, {"spheres", i, "radius"}));
            points.push_back({vec(spheres[i].center), spheres[i].radius});
        }
        RELIEF_TRY(call.context());
        if (!to.stream) {
            return 0;
        }
        RELIEF_TRY(wait != 0 ? to.stream->finish(points) : to.stream->update(points));
        const StreamCounts counts = to.stream->counts();
        return static_cast<int64_t>(counts.wanted - counts.present);
    });
}

const char* relief_textures_warning(relief_textures* world_textures) {
    return answer(__func__, "", [&](const Call& call) -> Result<const char*> {
        TexturesObject& of = *RELIEF_TRY(call.object(world_textures, "world_textures"));
        if (of.stream && of.warnings.empty()) {
            of.warnings = of.stream->takeWarnings();
            std::reverse(of.warnings.begin(), of.warnings.end());
        }
        of.warning.clear();
        if (!of.warnings.empty()) {
            of.warning = std::move(of.warnings.back());
            of.warnings.pop_back();
        }
        return of.warning.c_str();
    });
}
