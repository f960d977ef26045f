// SPDX-License-Identifier: Apache-2.0
// The objects behind the handles of relief_runtime.h, and helpers that its functions share.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "formats/base/finite.h"
#include "formats/world/world_field.h"
#include "runtime/births/mesh_trail.h"
#include "runtime/bodies/world_textures.h"
#include "runtime/c_api/call.h"
#include "runtime/c_api/relief_runtime.h"
#include "runtime/live/animated_collider.h"
#include "runtime/particles/particle_system.h"
#include "runtime/picture/particle_renderer.h"
#include "runtime/stream/world_stream.h"

namespace relief {

/// An animated body on the GPU.
struct AnimatedBody {
    std::uint32_t body;  // index in the world's textures
    AnimatedCollider collider;
    MeshTrail trail;                    // motion of its mesh; `shown` is the time of the last pose
    std::optional<MeshPose> next = {};  // applied by the next relief_textures_set_poses()
    bool fresh = true;                  // no pose was set yet; the first pose is not motion
    double shown = 0.0;                 // number of calls of show()

    void show(const MeshPose& pose, bool jumps) {
        trail.show(
            ++shown, [mesh = collider.shared(), pose] { return posed(*mesh, pose); }, jumps);
    }
};

struct TexturesObject {
    std::optional<WorldTextures> own;          // empty if streamed
    std::unique_ptr<WorldStream> stream = {};  // null if not streamed
    std::string glsl = {};
    GLint units = 0;                   // texture units of the context
    GLint blocks = 0;                  // uniform block bindings
    std::optional<Bounds> world = {};  // initial bounds of the bodies; nullopt: a single collider
    float texel = 0.0F;                // finest texel of a world, in world units
    std::vector<Pose> poses = {};      // of the bodies, at the end of the next step
    std::vector<Pose> before = {};     // of the bodies, at its beginning
    std::vector<Pose> placed = {};     // as uploaded; an animated body is placed at the centre of its box
    std::vector<AnimatedBody> animated = {};
    std::vector<std::string> warnings = {};  // of the stream, not returned yet
    std::string warning = {};                // the last one returned

    [[nodiscard]] const WorldTextures& textures() const { return stream ? stream->textures() : *own; }
};

struct ParticlesObject {
    std::shared_ptr<const TexturesObject> textures;  // the system points to it; may be null
    ParticleSystem system;
    std::vector<Birth> births;  // scratch memory of a call
};

struct RendererObject {
    std::shared_ptr<const TexturesObject> textures;  // may be null
    ParticleRenderer renderer;
    float diameter = 0.01F;
};

struct AnimationObject {
    std::shared_ptr<const AnimatedMesh> mesh;
    PoseExtent extent;
};

struct EmitterObject {
    std::shared_ptr<const AnimatedMesh> mesh;
    Emitter emitter;
    float inherit = 0.0F;
};

/// An animated body of a world, numbered after the bodies of the file.
struct AddedBody {
    AnimationObject animation;
    Pose pose{};
    AnimatedColliderOptions options{};
};

struct WorldObject {
    WorldField field;
    std::vector<AddedBody> added = {};
};

template <>
struct HandleType<relief_textures> : HandleOf<TexturesObject, HandleKind::kTextures> {};
template <>
struct HandleType<relief_particles> : HandleOf<ParticlesObject, HandleKind::kParticles> {};
template <>
struct HandleType<relief_renderer> : HandleOf<RendererObject, HandleKind::kPicture> {};
template <>
struct HandleType<relief_world> : HandleOf<WorldObject, HandleKind::kWorld> {};
template <>
struct HandleType<relief_animation> : HandleOf<AnimationObject, HandleKind::kAnimation> {};
template <>
struct HandleType<relief_emitter> : HandleOf<EmitterObject, HandleKind::kEmitter> {};

// Ranges of relief_runtime.h. A particle beyond 1e15 counts as lost (isLost()).
inline constexpr FieldRange kAny{-1e15, 1e15};
inline constexpr FieldRange kNotNegative{0.0, 1e15};
inline constexpr FieldRange kFraction{0.0, 1.0};
inline constexpr FieldRange kLifetime{0.0, 1e15, false};
inline constexpr FieldRange kStep{0.0, 1e9, false};
inline constexpr FieldRange kPixels{0.0, 65536.0};
inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

inline glm::vec3 vec(const float (&v)[3]) {
    return {v[0], v[1], v[2]};
}

inline void put(const glm::vec3& v, float (&out)[3]) {
    std::copy_n(&v.x, 3, out);
}

inline glm::vec3 pointAt(const float* points, std::size_t i) {
    return {points[3 * i], points[3 * i + 1], points[3 * i + 2]};
}

/// Checks and returns three numbers.
[[nodiscard]] inline Result<glm::vec3> vectorOf(const Call& call, const float* given, const FieldRange& range,
                                                const char* argument) {
    for (std::size_t i = 0; i < 3; ++i) {
        RELIEF_TRY(call.number(given[i], range, {argument, i}));
    }
    return pointAt(given, 0);
}

/// Finds an animated body by its number.
[[nodiscard]] Result<AnimatedBody*> animatedOf(const Call& call, relief_textures* animated_textures,
                                               std::uint32_t body);

/// Validates and converts a pose. \param rest  provides the scale.
[[nodiscard]] Result<Pose> poseOf(const Call& call, const relief_pose& given, NumberName name,
                                  const Pose& rest);

/// Returns whether objects of this kind own GL objects.
[[nodiscard]] constexpr bool hasGlNames(HandleKind kind) {
    return kind == HandleKind::kTextures || kind == HandleKind::kParticles || kind == HandleKind::kPicture;
}

/// Frees an object. Fails without a current context if the object owns GL objects.
template <class H>
void release(const char* function, H* handle, const char* argument) noexcept {
    answer(function, false, [&](const Call& call) -> Result<bool> {
        if (handle != nullptr) {
            [[maybe_unused]] const auto* object = RELIEF_TRY(call.object(handle, argument));
            if (hasGlNames(HandleType<H>::kKind)) {
                RELIEF_TRY(call.context());
            }
            [[maybe_unused]] const auto last =
                handleTable().remove(HandleType<H>::kKind, reinterpret_cast<std::uintptr_t>(handle));
        }
        return true;
    });
}

/// Writes sampleAt(object, point) for each point, or NaN for points that cannot be evaluated.
/// \param argument  the parameter name of the handle.
template <class H, class F>
void query(const char* function, const H* handle, const char* argument, const float* points,
           std::size_t count, relief_sample* samples, const F& sampleAt) {
    const auto unknown = [&](std::size_t i) { samples[i] = {kNan, {0.0F, 0.0F, 0.0F}, -1}; };
    answer(function, false, [&](const Call& call) -> Result<bool> {
        RELIEF_TRY(call.array(samples, "samples", count, "count"));
        for (std::size_t i = 0; i < count; ++i) {
            unknown(i);
        }
        RELIEF_TRY(call.array(points, "points", count, "count"));
        const auto& field = *RELIEF_TRY(call.object(handle, argument));
        std::size_t wrong = count;
        for (std::size_t i = 0; i < count; ++i) {
            const glm::vec3 point = pointAt(points, i);
            if (!isFinite(point)) {
                wrong = std::min(wrong, i);
                continue;
            }
            samples[i] = sampleAt(field, point);
        }
        if (wrong < count) {
            return call.reject("points[" + std::to_string(wrong) + "] is not finite");
        }
        return true;
    });
}

/// Writes the result of boundsOf(call), or NaN on failure.
template <class F>
void writeBounds(const char* function, float* min, float* max, const F& boundsOf) {
    answer(function, false, [&](const Call& call) -> Result<bool> {
        for (float* out : {min, max}) {
            if (out != nullptr) {
                std::fill_n(out, 3, kNan);
            }
        }
        const Bounds bounds = RELIEF_TRY(boundsOf(call));
        RELIEF_TRY(call.notNull(min, "min"));
        RELIEF_TRY(call.notNull(max, "max"));
        std::copy_n(&bounds.min.x, 3, min);
        std::copy_n(&bounds.max.x, 3, max);
        return true;
    });
}

/// Completes textures with their GLSL and the limits of the context, which must be current.
[[nodiscard]] Result<TexturesObject> texturesObject(WorldTextures textures);
[[nodiscard]] Result<TexturesObject> texturesObject(std::unique_ptr<WorldStream> stream);

}  // namespace relief
