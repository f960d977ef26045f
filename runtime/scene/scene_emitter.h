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
#include "runtime/particles/emitter.h"
#include "runtime/particles/particle_type.h"
#include "runtime/particles/spawner.h"
#include "runtime/scene/scene_collider.h"

namespace relief {

/// emitter.touching.
struct SceneTouching {
    std::vector<std::string> materials;  ///< by name; empty: any, and what has none
    float within = 0.0F;                 ///< world units, as is the next
    float min_speed = 0.0F;
};

/// A name, or several.
template <class Names>
struct NameList {
    Names& names;
};
template <class Names>
NameList(Names&) -> NameList<Names>;

template <class Visitor, FieldsOf<SceneTouching> T>
void fields(Visitor& visit, T& touching) {
    const NameList names{touching.materials};
    bool named = !touching.materials.empty();
    visit(
        "within", touching.within,
        {"Distance from the nearest other surface up to which it is touched", {}, kSizeRange, {}, kRequired});
    visit(
        "material", FieldMaybe{names, named},
        leftOut({"Name of the material that is touched, or a list of names", {}, {}, "any, and the ground"}));
    visit("min_speed", touching.min_speed,
          {"Least speed of the emitter's surface relative to the one that it touches", "1/s", kSpeedRange});
}

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
template <class Aim>
struct EmitterSpeed {
    Aim& aim;
};
template <class Aim>
EmitterSpeed(Aim&) -> EmitterSpeed<Aim>;
struct NormalSpeed {
    float mean = 0.0F;
    float deviation = 0.0F;
};
template <class Visitor, FieldsOf<NormalSpeed> S>
void fields(Visitor& visit, S& speed) {
    visit("mean", speed.mean, {"Mean of a normal distribution", "1/s", kSpeedRange, {}, kRequired});
    visit("deviation", speed.deviation, {"Its standard deviation", "1/s", kSpeedRange});
}

/// The aim of an emitter, made where there is none yet; check() removes one that no key has set.
[[nodiscard]] inline EmitterAim& aimOf(SceneEmitter& emitter) {
    return emitter.aim ? *emitter.aim : emitter.aim.emplace();
}
[[nodiscard]] inline const EmitterAim& aimOf(const SceneEmitter& emitter) {
    static const EmitterAim none;
    return emitter.aim ? *emitter.aim : none;
}

template <class Visitor, FieldsOf<SceneEmitter> E>
void fields(Visitor& visit, E& e) {
    auto& aim = aimOf(e);
    const EmitterSpeed speed{aim};
    visit(
        "shape", e.shape,
        {"Place of birth; a sphere is its volume, a shell its surface, a surface that of a collider or mesh",
         {},
         {},
         "\"point\" with point, \"points\" with points, else \"box\"",
         {.selects = true}});
    visit("box_min", FieldMaybe{e.box_min, e.has_box},
          {"Lower corner",
           "[x, y, z]",
           kPointRange,
           "1.45 L about the centre on x and z, 0.15 L above the top",
           {.needs = "box_max", .only = "box"}});
    visit("box_max", FieldMaybe{e.box_max, e.has_box},
          {"Upper corner",
           "[x, y, z]",
           kPointRange,
           "as box_min, 0.75 L above the top",
           {.needs = "box_min", .only = "box"}});
    visit("point", e.box_min,
          {"Place of a point",
           "[x, y, z]",
           kPointRange,
           {},
           {.instead_of = "box_min", .only = "point", .required = true, .chooses = true}});
    visit("center", e.center,
          {"Centre", "[x, y, z]", kPointRange, {}, {.only = "sphere shell disc", .required = true}});
    visit("radius", e.radius,
          {"Radius", {}, kLengthRange, {}, {.only = "sphere shell disc", .required = true}});
    visit("normal", e.normal,
          {"Normal of the disc", "[x, y, z]", kPointRange, {}, {.only = "disc", .not_zero = true}});
    visit("points", FieldFile{e.points_file, e.points_origin},
          {"File of 1 to 2²² points, below",
           {},
           {},
           {},
           {.only = "points", .required = true, .chooses = true}});
    visit("mesh", FieldFile{e.mesh_file, e.mesh_origin},
          leftOut({"The .obj or .ply whose surface it is, in the emitter's space",
                   {},
                   {},
                   "that of the collider it is attached to, as it moves and bends",
                   {.only = "surface"}}));
    visit(
        "group", e.group,
        leftOut({"Joint or node whose weights are the density of the births; of an .obj its group or object",
                 {},
                 {},
                 "all",
                 {.only = "surface"}}));
    visit("material", e.material, leftOut({"Material that gives birth", {}, {}, "all", {.only = "surface"}}));
    visit("touching", e.touching,
          leftOut(
              {"Births only where the surface touches another", {}, {}, "everywhere", {.only = "surface"}}));
    visit("start", e.start, {"Time before anything is born", "s", kTimeRange});
    visit("rate", FieldMaybe{e.rate, e.has_rate},
          {"Births a second; several emitters without a rate share what the others leave of the capacity",
           "1/s",
           {0.0, kRateMax},
           "the capacity by the end of the births"});
    visit("duration", e.duration,
          {"Time from the start to the last birth", "s", kLifeRange, "the whole run"});
    visit("burst", e.burst, {"Births at the start, at most the capacity", {}, {0.0, 1 << 24}});
    visit("burst_every", e.burst_every,
          leftOut(
              {"Time from burst to burst", "s", {1e-4, kSecondsMax}, "a single burst", {.needs = "burst"}}));
    visit("spread", e.spread, {"Births by rate are spread over their step"});
    visit("velocity", FieldMaybe{e.velocity, e.has_velocity},
          leftOut({"Velocity of every birth",
                   "[x, y, z]/s",
                   within(kSpeedMax),
                   "[0, −0.8 L, 0]; none with direction, cone or speed",
                   {.instead_of = "direction cone speed"}}));
    visit("velocity_spread", FieldMaybe{e.velocity_spread, e.has_velocity_spread},
          {"Largest uniform deviation from the velocity, either way", "[x, y, z]/s", kSpeedRange,
           "[0.12, 0.1, 0.12] L; none with direction, cone or speed"});
    visit("direction", FieldMaybe{aim.direction, e.has_aim},
          leftOut({"Direction of births; required for a box or point",
                   "[x, y, z]",
                   kPointRange,
                   "the normal: outwards, the disc's, the point's own, the surface's",
                   {.not_zero = true}}));
    visit("cone", FieldMaybe{aim.cone_degrees, e.has_aim},
          leftOut({"Half angle about the direction, uniform over its solid angle", "degrees", {0.0, 180.0}}));
    visit("speed", FieldMaybe{speed, e.has_speed},
          leftOut({"Speed along the direction: a number, [least, most], or { mean, deviation }, which is "
                   "normal and never below 0",
                   "1/s", kSpeedRange, "0.8 L"}));
    visit("lifetime", FieldSpan{e.lifetime_min, e.lifetime_max}, {"Lifetime", "s", kLifeRange});
    visit("type", e.type,
          {"Number or name of the type", {}, {0.0, kParticleTypesMax - 1}, {}, {.index_of = "type"}});
    visit("seed", e.seed, {"Seed; emitter i draws from the i-th stream of its seed", {}, {0.0, kSeedMax}});
    visit("attach", e.attach,
          leftOut({"Number, from 0, of the collider in whose space the emitter is; needs a place, or the "
                   "shape surface",
                   {},
                   {0.0, ColliderTextures::kBodiesMax - 1},
                   "the world",
                   {.index_of = "collider"}}));
    visit("key", e.given_keys, leftOut({"Poses at times, two or more", {}, {}, {}, {.most = kPoseKeysMax}}));
    visit("inherit", e.inherit,
          leftOut({"Share of its own velocity that births take on",
                   {},
                   kFactorRange,
                   {},
                   {.needs = "attach key"}}));
}
[[nodiscard]] std::optional<FieldFault> check(SceneEmitter& emitter, const GivenFields& given);

inline constexpr std::size_t kEmittersMax = 64;
inline constexpr std::size_t kSpawnsMax = 16;

struct SceneSpawn : SpawnSettings {
    std::uint64_t seed = 1;
    std::string on_material;  ///< SpawnSettings::material by its name; empty: any
    SourcePlace place;        ///< of the table
    friend bool operator==(const SceneSpawn&, const SceneSpawn&) = default;
};

template <class Visitor, FieldsOf<SceneSpawn> S>
void fields(Visitor& visit, S& spawn) {
    fields(visit, baseOf<SpawnSettings>(spawn));
    visit("material", spawn.on_material,
          leftOut({"Name of the material that was hit", {}, {}, "any", {.only = "collision"}}));
    visit("seed", spawn.seed, {"Seed; spawn i draws from a stream of its own", {}, {0.0, kSeedMax}});
}
[[nodiscard]] std::optional<FieldFault> check(SceneSpawn& spawn, const GivenFields& given);

/// Sets what no key has set: boxes above the collider, from which snow falls.
/// \param bounds, scale  of the collider; scale > 0, its size.
/// \param seconds, capacity  of the run: emitters without a rate share evenly what the others leave of it.
/// Errors: kInvalidInput if they leave nothing.
[[nodiscard]] Result<void> completeEmitters(std::span<SceneEmitter> emitters, const Bounds& bounds,
                                            float scale, double seconds, std::uint32_t capacity);

/// Spawner i draws from stream i of its seed, behind those of the emitters.
/// \param materials  ColliderTextures::materialNames(); a name that is not among them is never hit.
[[nodiscard]] std::vector<Spawner> makeSpawners(std::span<const SceneSpawn> spawns,
                                                std::span<const std::string> materials);

/// Trajectories that carry the births of each emitter along.
/// \param colliders  that `attach` counts; those that deform are followed by their pose alone.
[[nodiscard]] std::vector<EmitterMotion> emitterMotions(std::span<const SceneEmitter> emitters,
                                                        std::span<const SceneCollider> colliders);

}  // namespace relief
