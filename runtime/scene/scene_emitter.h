// The emitters of a scene: [emitter], or several [[emitter]]. Keys, units, defaults, ranges: README.md beside
// this file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "runtime/collider/pose_keys.h"
#include "runtime/particles/emitter.h"
#include "runtime/scene/scene_collider.h"

namespace relief {

/// One emitter as its table says. What is optional and not said is filled by completeEmitters().
struct SceneEmitter {
    EmitterShape shape = EmitterShape::kBox;
    std::optional<glm::vec3> box_min;  ///< a point if equal to box_max; given both or neither
    std::optional<glm::vec3> box_max;
    glm::vec3 center{0.0F};
    float radius = 0.0F;
    glm::vec3 normal{0.0F, 1.0F, 0.0F};
    std::filesystem::path points;  ///< resolved against the scene's folder; for kPoints alone
    std::string points_origin;     ///< "scene.toml:3:8" of that key, for messages

    double start = 0.0;              ///< seconds
    std::optional<double> rate;      ///< births a second
    std::optional<double> duration;  ///< seconds of births; nullopt: to the end
    std::uint32_t burst = 0;
    double burst_every = 0.0;  ///< seconds; 0: once

    std::optional<glm::vec3> velocity;  ///< 0 for an aimed emitter
    std::optional<glm::vec3> velocity_spread;
    bool aimed = false;  ///< by any of the next keys
    std::optional<glm::vec3> direction;
    float cone = 0.0F;               ///< degrees
    std::optional<float> speed_min;  ///< speed_max beside it
    std::optional<float> speed_max;
    float speed_deviation = 0.0F;

    float lifetime_min = 30.0F;  ///< seconds
    float lifetime_max = 30.0F;
    std::uint32_t type = 0;   ///< 0 … kEmitterTypeMax
    std::string type_name;    ///< where the scene names the type: resolveEmitterTypes() finds its index
    std::string type_origin;  ///< "scene.toml:3:8" of that key
    std::uint64_t seed = 1;
    bool spread = true;

    std::optional<std::uint32_t> attach;  ///< the number of the collider in whose space it is, from 0
    std::vector<PoseKey> keys;            ///< by rising time; empty: it rests there
    float inherit = 0.0F;                 ///< share of its own velocity that births take on
    [[nodiscard]] bool moves() const { return attach.has_value() || !keys.empty(); }
};

inline constexpr std::uint32_t kEmitterTypeMax = 15;
inline constexpr std::size_t kEmittersMax = 64;

/// The index of a type that a table names, by its name or its number.
/// \param key     "emitter.type", for messages; origin is its place.
/// \param name    empty: the number `type` was given.
/// \param names   of the types there are, in order.
/// Errors: kInvalidInput, "file:line:column: …", for a name or an index that is not among them; where `names` is empty, for a
/// name alone.
[[nodiscard]] Result<std::uint32_t> resolvedType(const std::string& key, const std::string& name,
                                                 const std::string& origin, std::uint32_t type,
                                                 std::span<const std::string> names);

/// Turns names of types into indices.
/// \param names  of the types there are, in order.
/// Errors: kInvalidInput, "file:line:column: …", for a name or an index that is not among them; where `names`
/// is empty, for a name alone.
[[nodiscard]] Result<void> resolveEmitterTypes(std::span<SceneEmitter> emitters,
                                               std::span<const std::string> names);

/// Fills every optional: boxes above the collider, from which snow falls.
/// \param bounds, scale  of the collider; scale > 0, its size.
/// \param seconds, capacity  of the run: emitters without a rate share evenly what the others leave of it.
/// Errors: kInvalidInput if they leave nothing.
[[nodiscard]] Result<void> completeEmitters(std::span<SceneEmitter> emitters, const Bounds& bounds,
                                            float scale, double seconds, std::uint32_t capacity);

/// Ready to give birth; reads the files of points. Emitter i draws from stream i.
/// \param emitters  complete.
/// Fails as loadPointList does, with the place of the key, and with kInvalidInput (points without normals and
/// without a direction).
[[nodiscard]] Result<std::vector<Emitter>> makeEmitters(std::span<const SceneEmitter> emitters);

/// What carries the births of each emitter along.
/// \param colliders  that `attach` counts; those that deform are followed by their pose alone.
[[nodiscard]] std::vector<EmitterMotion> emitterMotions(std::span<const SceneEmitter> emitters,
                                                        std::span<const SceneCollider> colliders);

}  // namespace relief
