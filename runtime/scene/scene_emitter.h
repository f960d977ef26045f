// SPDX-License-Identifier: Apache-2.0
// The emitters of a scene ([emitter] or several [[emitter]]) and its spawners ([[spawn]]).
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
    std::vector<std::string> materials;           ///< by name; empty: any surface, even without a material
    float within = 0.0F;                          ///< world units
    float min_speed = 0.0F;                       ///< world units/s
    std::vector<std::string> material_origins{};  ///< position of each name
};

/// Reads one name or a list of names, and writes a list.
struct NameList {
    std::vector<std::string>& names;
    std::vector<std::string>& origins;
};
extern const FieldCustom kNameListField;
template <>
inline constexpr const FieldCustom* kFieldCustom<NameList> = &kNameListField;

void fields(FieldVisitor& visit, SceneTouching& touching);

/// An emitter, as read from its table. completeEmitters() fills values that depend on the collider and on the run.
struct SceneEmitter : EmitterSettings {
    SceneEmitter();

    bool has_box = false;  ///< whether box_min and box_max are set; likewise the flags below
    bool has_rate = false;
    bool has_velocity = false;
    bool has_velocity_spread = false;
    bool has_aim = false;
    bool has_speed = false;             ///< speeds of `aim`
    std::filesystem::path points_file;  ///< resolved against the scene's folder; only for kPoints
    std::string points_origin;          ///< position of its key, "scene.toml:3:8", for messages
    /// Resolved; only for kSurface; empty: the surface of the collider that `attach` names.
    std::filesystem::path mesh_file;
    std::string mesh_origin;
    std::string group;  ///< group of the mesh that emits; empty: all
    std::string group_origin;
    std::string material;  ///< material of the mesh that emits; empty: all
    std::string material_origin;
    std::optional<SceneTouching> touching;
    std::uint64_t seed = 1;
    std::string place;  ///< "file:line:column" of the table

    std::optional<std::uint32_t> attach;  ///< index of the collider whose space it uses
    std::vector<SceneKey> given_keys;
    std::vector<PoseKey> keys;  ///< complete, ascending times; empty: fixed
    float inherit = 0.0F;       ///< fraction of the emitter's velocity that births inherit
    [[nodiscard]] bool moves() const { return attach.has_value() || !keys.empty(); }
    /// Whether it emits from the surface of its collider, and deforms with it.
    [[nodiscard]] bool followsShape() const { return shape == EmitterShape::kSurface && mesh_file.empty(); }
};

/// emitter.speed: a number, [min, max], or { mean, deviation }.
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

/// Creates `aim` if visit.fills(); check() removes `aim` if none of its keys is set.
void fields(FieldVisitor& visit, SceneEmitter& e);
[[nodiscard]] std::optional<FieldFault> check(SceneEmitter& emitter, const GivenFields& given);

inline constexpr std::size_t kEmittersMax = 64;
inline constexpr std::size_t kSpawnsMax = 16;

struct SceneSpawn : SpawnSettings {
    std::uint64_t seed = 1;
    std::string on_material;  ///< name of SpawnSettings::material; empty: any
    SourcePlace material_origin;
    friend bool operator==(const SceneSpawn&, const SceneSpawn&) = default;
};

void fields(FieldVisitor& visit, SceneSpawn& spawn);
[[nodiscard]] std::optional<FieldFault> check(SceneSpawn& spawn, const GivenFields& given);

/// Fills missing values. By default, particles fall like snow from a box above the collider.
/// \param bounds, scale  of the collider; scale: the largest of 1e-6, its longest side, and 1e-3 times its centre's
/// largest coordinate.
/// \param seconds, capacity  of the run. Emitters without a rate share the capacity that the others leave.
/// Errors: kInvalidInput if no capacity is left.
[[nodiscard]] Result<void> completeEmitters(std::span<SceneEmitter> emitters, const Bounds& bounds,
                                            float scale, double seconds, std::uint32_t capacity);

/// Creates the spawners. Spawner i uses random stream kEmittersMax + i of its seed.
/// \param materials  WorldTextures::materialNames(); an on_material that is not among them never matches.
[[nodiscard]] std::vector<Spawner> makeSpawners(std::span<const SceneSpawn> spawns,
                                                std::span<const std::string> materials);

/// Returns the motion of each emitter.
/// \param colliders  the colliders that `attach` refers to; for deforming colliders, only the pose is used.
[[nodiscard]] std::vector<EmitterMotion> emitterMotions(std::span<const SceneEmitter> emitters,
                                                        std::span<const SceneCollider> colliders);

}  // namespace relief
