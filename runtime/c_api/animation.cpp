// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "formats/base/text.h"
#include "runtime/c_api/objects.h"

using namespace relief;  // NOLINT: the C functions are outside of it

namespace {

constexpr FieldRange kResolution{0.0, 4096.0};
constexpr std::uint32_t kResolutionMin = 16;
constexpr FieldRange kSeconds = within(1e9);

Result<int> setNext(AnimatedBody& body, MeshPose pose) {
    RELIEF_TRY(body.collider.check(pose));
    body.next = std::move(pose);
    return 0;
}

}  // namespace

Result<AnimatedBody*> relief::animatedOf(const Call& call, relief_textures* animated_textures,
                                         std::uint32_t body) {
    TexturesObject& of = *RELIEF_TRY(call.object(animated_textures, "animated_textures"));
    const auto found = std::find_if(of.animated.begin(), of.animated.end(),
                                    [&](const AnimatedBody& one) { return one.body == body; });
    if (found == of.animated.end()) {
        return call.reject("body is " + std::to_string(body) +
                           "; pass an animated body, as returned by relief_world_add()");
    }
    return &*found;
}

relief_animation* relief_animation_create(const relief_collider* collider) {
    return create<relief_animation>(__func__, [&](const Call& call) -> Result<AnimationObject> {
        const Collider& from = *RELIEF_TRY(call.object(collider, "collider"));
        if (from.animation.empty()) {
            return call.reject("collider has no animated mesh; bake it with --animated");
        }
        auto mesh = std::make_shared<const AnimatedMesh>(RELIEF_TRY(readAnimatedMesh(from.animation)));
        const PoseExtent extent = poseExtent(*mesh);
        return AnimationObject{std::move(mesh), extent};
    });
}

void relief_animation_free(relief_animation* animation) {
    release(__func__, animation, "animation");
}

size_t relief_animation_clip_count(const relief_animation* animation) {
    return answer(__func__, std::size_t{0}, [&](const Call& call) -> Result<std::size_t> {
        return RELIEF_TRY(call.object(animation, "animation"))->mesh->clips.size();
    });
}

const char* relief_animation_clip_name(const relief_animation* animation, size_t clip) {
    return answer(__func__, "", [&](const Call& call) -> Result<const char*> {
        const AnimatedMesh& mesh = *RELIEF_TRY(call.object(animation, "animation"))->mesh;
        RELIEF_TRY(call.index(clip, mesh.clips.size(), "clip", "clips"));
        return mesh.clips[clip].name.c_str();
    });
}

float relief_animation_clip_duration(const relief_animation* animation, size_t clip) {
    return answer(__func__, kNan, [&](const Call& call) -> Result<float> {
        const AnimatedMesh& mesh = *RELIEF_TRY(call.object(animation, "animation"))->mesh;
        RELIEF_TRY(call.index(clip, mesh.clips.size(), "clip", "clips"));
        return mesh.clips[clip].seconds;
    });
}

size_t relief_animation_joint_count(const relief_animation* animation) {
    return answer(__func__, std::size_t{0}, [&](const Call& call) -> Result<std::size_t> {
        return RELIEF_TRY(call.object(animation, "animation"))->mesh->joints.size();
    });
}

const char* relief_animation_joint_name(const relief_animation* animation, size_t joint) {
    return answer(__func__, "", [&](const Call& call) -> Result<const char*> {
        const AnimatedMesh& mesh = *RELIEF_TRY(call.object(animation, "animation"))->mesh;
        RELIEF_TRY(call.index(joint, mesh.joints.size(), "joint", "joints"));
        return mesh.nodes[mesh.joints[joint].node].name.c_str();
    });
}

size_t relief_animation_weight_count(const relief_animation* animation) {
    return answer(__func__, std::size_t{0}, [&](const Call& call) -> Result<std::size_t> {
        return RELIEF_TRY(call.object(animation, "animation"))->mesh->weights.size();
    });
}

relief_world* relief_world_create(void) {
    return create<relief_world>(
        __func__, [](const Call&) -> Result<WorldObject> { return WorldObject{WorldField(LoadedWorld{})}; });
}

int64_t relief_world_add(relief_world* world, const relief_animation* animation, const relief_pose* pose,
                         uint32_t resolution, const float box_size[3]) {
    return answer(__func__, int64_t{-1}, [&](const Call& call) -> Result<int64_t> {
        WorldObject& to = *RELIEF_TRY(call.object(world, "world"));
        AddedBody added{.animation = *RELIEF_TRY(call.object(animation, "animation"))};
        RELIEF_TRY(call.notNull(pose, "pose"));
        added.pose = RELIEF_TRY(poseOf(call, *pose, {"pose"}, {}));
        RELIEF_TRY(call.number(resolution, kResolution, {"resolution"}));
        if (resolution > 0 && resolution < kResolutionMin) {
            return call.reject("resolution is " + std::to_string(resolution) + "; choose " +
                               std::to_string(kResolutionMin) + " to 4096, or 0 for 512");
        }
        added.options.resolution = resolution > 0 ? resolution : added.options.resolution;
        added.options.box_size = added.animation.extent.box_size;
        if (box_size != nullptr) {
            added.options.box_size = RELIEF_TRY(vectorOf(call, box_size, kLifetime, "box_size"));
        }
        const std::size_t body = to.field.world().bodies.size() + to.added.size();
        if (body >= kWorldBodiesMax) {
            return call.reject("world has " + std::to_string(body) + " bodies, which is the maximum");
        }
        to.added.push_back(std::move(added));
        return static_cast<int64_t>(body);
    });
}

int relief_textures_set_clip(relief_textures* animated_textures, uint32_t body, const char* clip,
                             double seconds) {
    return answer(__func__, -1, [&](const Call& call) -> Result<int> {
        AnimatedBody& of = *RELIEF_TRY(animatedOf(call, animated_textures, body));
        RELIEF_TRY(call.context());
        const AnimatedMesh& mesh = of.collider.mesh();
        RELIEF_TRY(call.notNull(clip, "clip"));
        RELIEF_TRY(call.number(seconds, kSeconds, {"seconds"}));
        const std::optional<std::size_t> found = findClip(mesh, clip);
        if (!found) {
            return call.reject("clip is '" + cleanUtf8(clip) + "'; the animation has no clip of that name");
        }
        return setNext(of, poseAt(mesh, mesh.clips[*found], seconds));
    });
}

int relief_textures_set_joints(relief_textures* animated_textures, uint32_t body, const float* matrices,
                               size_t joint_count, const float* weights, size_t weight_count) {
    return answer(__func__, -1, [&](const Call& call) -> Result<int> {
        AnimatedBody& of = *RELIEF_TRY(animatedOf(call, animated_textures, body));
        RELIEF_TRY(call.context());
        RELIEF_TRY(call.array(matrices, "matrices", joint_count, "joint_count"));
        RELIEF_TRY(call.array(weights, "weights", weight_count, "weight_count"));
        const AnimatedMesh& mesh = of.collider.mesh();
        if (joint_count != mesh.joints.size() || weight_count != mesh.weights.size()) {
            return call.reject("joint_count is " + std::to_string(joint_count) + " and weight_count " +
                               std::to_string(weight_count) + "; the animation has " +
                               std::to_string(mesh.joints.size()) + " and " +
                               std::to_string(mesh.weights.size()));
        }
        MeshPose pose{std::vector<Affine>(joint_count), {weights, weights + weight_count}};
        for (std::size_t joint = 0; joint < joint_count; ++joint) {
            for (std::size_t i = 0; i < 16; ++i) {
                const float value = matrices[16 * joint + i];
                RELIEF_TRY(call.number(value, kAny, {"matrices", 16 * joint + i}));
                if (i % 4 < 3) {
                    pose.joints[joint].row[i % 4][static_cast<int>(i / 4)] = value;
                }
            }
        }
        for (std::size_t i = 0; i < weight_count; ++i) {
            RELIEF_TRY(call.number(weights[i], kAny, {"weights", i}));
        }
        return setNext(of, std::move(pose));
    });
}
