// SPDX-License-Identifier: Apache-2.0
// The emitters of a scene, [emitter] or several [[emitter]], and its [[spawn]].
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "formats/base/source_place.h"
#include "formats/collider.h"
#include "runtime/births/emitter_motion.h"
#include "runtime/events/spawner.h"
#include "runtime/particles/emitter.h"
#include "runtime/particles/particle_type.h"
#include "runtime/scene/scene_collider.h"

namespace relief {

/// emitter.touching.
struct SceneTouching {
    std::vector<std::string> materials;  ///< by name; empty: any, and what has none
    float within = 0.0F;                 ///< world units, as is the next
    float min_speed = 0.0F;
};

/// A name, or several.
struct NameList {
    std::vector<std::string>& names;
};
extern const FieldCustom kNameListField;
template <>
inline constexpr const FieldCustom* kFieldCustom<NameList> = &kNameListField;

void fields(FieldVisitor& visit, SceneTouching& touching);

/// An emitter as its table gives it. completeEmitters() fills what depends on the collider and on the run.
struct SceneEmitter : EmitterSettings {
    SceneEmitter();

    bool has_box = false;  ///< box_min and box_max are set, as are the next with their flags
    bool has_rate = false;
    bool has_velocity = false;
    bool has_velocity_spread = false;
    bool has_aim = false;
    bool has_speed = false;             ///< of aim
    std::filesystem::path points_file;  ///< resolved against the scene's folder; for kPoints alone
    std::string points_origin;          ///< "scene.toml:3:8" of that key, for messages
    std::filesystem::path
        mesh_file;  ///< resolved as well; for kSurface alone; empty: of the collider it is attached to
    std::string mesh_origin;
    std::string group;     ///< of that mesh; empty: all of it
    std::string material;  ///< likewise
    std::optional<SceneTouching> touching;
    std::uint64_t seed = 1;
    std::string place;  ///< "file:line:column" of the table

    std::optional<std::uint32_t> attach;  ///< the number of the collider in whose space it is, from 0
    std::vector<SceneKey> given_keys;
    std::vector<PoseKey> keys;  ///< of those; by rising time; empty: it rests there
    float inherit = 0.0F;       ///< share of its own velocity that births take on
    [[nodiscard]] bool moves() const { return attach.has_value() || !keys.empty(); }
    /// Its surface is that of the collider that it is attached to, and bends with it.
    [[nodiscard]] bool followsShape() const { return shape == EmitterShape::kSurface && mesh_file.empty(); }
};

/// emitter.speed: a number, [least, most], or { mean, deviation }.
struct EmitterSpeed {
    EmitterAim& aim;
};
extern const FieldCustom kEmitterSpeedField;
template <>
inline constexpr const FieldCustom* kFieldCustom<EmitterSpeed> = &kEmitterSpeedField;
struct NormalSpeed {
    float mean = 0.0F;
    float deviation = 0.0F;
};
void fields(FieldVisitor& visit, NormalSpeed& speed);

/// Makes an aim if there is none and the visitor fills it; check() removes one that no key has set.
void fields(FieldVisitor& visit, SceneEmitter& e);
[[nodiscard]] std::optional<FieldFault> check(SceneEmitter& emitter, const GivenFields& given);

inline constexpr std::size_t kEmittersMax = 64;
inline constexpr std::size_t kSpawnsMax = 16;

struct SceneSpawn : SpawnSettings {
    std::uint64_t seed = 1;
    std::string on_material;  ///< SpawnSettings::material by its name; empty: any
    SourcePlace place;        ///< of the table
    friend bool operator==(const SceneSpawn&, const SceneSpawn&) = default;
};

void fields(FieldVisitor& visit, SceneSpawn& spawn);
[[nodiscard]] std::optional<FieldFault> check(SceneSpawn& spawn, const GivenFields& given);

/// Sets what no key has set: boxes above the collider, from which snow falls.
/// \param bounds, scale  of the collider; scale > 0, its size.
/// \param seconds, capacity  of the run: emitters without a rate share evenly what the others leave of it.
/// Errors: kInvalidInput if they leave nothing.
[[nodiscard]] Result<void> completeEmitters(std::span<SceneEmitter> emitters, const Bounds& bounds,
                                            float scale, double seconds, std::uint32_t capacity);

/// Spawner i draws from stream i of its seed, behind those of the emitters.
/// \param materials  WorldTextures::materialNames(); a name that is not among them is never hit.
[[nodiscard]] std::vector<Spawner> makeSpawners(std::span<const SceneSpawn> spawns,
                                                std::span<const std::string> materials);

/// Trajectories that carry the births of each emitter along.
/// \param colliders  that `attach` counts; those that deform are followed by their pose alone.
[[nodiscard]] std::vector<EmitterMotion> emitterMotions(std::span<const SceneEmitter> emitters,
                                                        std::span<const SceneCollider> colliders);

}  // namespace relief
