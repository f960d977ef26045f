// The effective settings of a scene, by its own keys, as `relief-sim --json` reports them.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "formats/fields/json.h"
#include "runtime/scene/scene.h"

namespace relief {

inline constexpr FieldInfo kPositionField{.help = "Position", .unit = "object units"};
inline constexpr FieldInfo kAxisField{.help = "Axis of the rotation, of length 1"};
inline constexpr FieldInfo kAngleField{.help = "Angle of the rotation", .unit = "degrees"};

[[nodiscard]] inline float degreesOf(const Pose& pose) {
    return glm::degrees(glm::angle(pose.rotation));
}

/// Of an optional field that is left out without a value.
[[nodiscard]] constexpr FieldInfo leftOut(FieldInfo info) {
    info.left_out = true;
    return info;
}

struct PoseKeyTable {
    const PoseKey& key = kNone<PoseKey>;
};

template <class Visitor, FieldsOf<PoseKeyTable> S>
void fields(Visitor& visit, S& settings) {
    const Pose& pose = settings.key.pose;
    visit("time", settings.key.time, {"Time", "s"});
    visit("position", pose.position, kPositionField);
    visit("axis", glm::axis(pose.rotation), kAxisField);
    visit("angle", degreesOf(pose), kAngleField);
}

inline constexpr FieldInfo kKeysField{.help = "Keys of its motion", .left_out = true};

struct ColliderTable {
    const SceneCollider& collider = kNone<SceneCollider>;

    [[nodiscard]] static std::vector<ColliderTable> kinds();  ///< of a container, and of a mesh that deforms
};

template <class Visitor, FieldsOf<ColliderTable> S>
void fields(Visitor& visit, S& settings) {
    const SceneCollider& collider = settings.collider;
    if (collider.live) {
        const Deformation& d = collider.live->deformation;
        const auto deform = [&](auto& visit_deform) {
            visit_deform("kind", d.kind, {"Deformation"});
            visit_deform("amplitude", d.kind == DeformKind::kWobble ? d.amplitude : glm::degrees(d.amplitude),
                         {"Amplitude, degrees; of a wobble object units"});
            visit_deform("frequency", d.frequency, {"Frequency", "1/s"});
        };
        visit("mesh", collider.path, {"Mesh of a collider that deforms"});
        visit("deform", group(deform), {"Its deformation"});
        visit("resolution", collider.resolution, {"Texels along the side of a map", {}, kFromOne});
    } else {
        visit("file", collider.path, {"Container"});
    }
    const bool posed = collider.posed;
    visit("position", onlyIf(posed, collider.pose.position), leftOut(kPositionField));
    visit("axis", onlyIf(posed, glm::axis(collider.pose.rotation)), leftOut(kAxisField));
    visit("angle", onlyIf(posed, degreesOf(collider.pose)), leftOut(kAngleField));
    visit("scale", onlyIf(posed, collider.pose.scale),
          {.help = "Scale of object space", .range = kFromZero, .left_out = true});
    visit("restitution", onlyIf(posed, collider.restitution),
          {.help = "Share of the normal speed that is kept", .left_out = true});
    visit("friction", onlyIf(posed, collider.friction),
          {.help = "Share of the tangential speed that is lost", .left_out = true});
    visit("key", viewsOf<PoseKeyTable>(collider.keys), kKeysField);
}

struct EmitterTable {
    const SceneEmitter& emitter = kNone<SceneEmitter>;

    [[nodiscard]] std::optional<std::variant<std::array<float, 2>, NormalSpeed>> speed() const;
};

template <class Visitor, FieldsOf<EmitterTable> S>
void fields(Visitor& visit, S& settings) {
    constexpr std::span kShapes(kWordsOf<EmitterShape>.begin(), 5);  // a point has become a box
    const SceneEmitter& e = settings.emitter;
    const EmitterAim& aim = aimOf(e);
    const bool is_box = e.shape == EmitterShape::kBox;
    const bool is_disc = e.shape == EmitterShape::kDisc;
    const bool is_round = is_disc || e.shape == EmitterShape::kSphere || e.shape == EmitterShape::kShell;
    visit("shape", wordOf(e.shape), {.help = "Where particles are born", .words = kShapes});
    visit("box_min", onlyIf(is_box, e.box_min),
          {.help = "Lower corner of a box", .unit = "object units", .left_out = true});
    visit("box_max", onlyIf(is_box, e.box_max),
          {.help = "Upper corner of a box", .unit = "object units", .left_out = true});
    visit("points", onlyIf(e.shape == EmitterShape::kPoints, e.points_file),
          {.help = "File of points", .left_out = true});
    visit("normal", onlyIf(is_disc, e.normal), {.help = "Normal of a disc", .left_out = true});
    visit("center", onlyIf(is_round, e.center), {.help = "Centre", .unit = "object units", .left_out = true});
    visit("radius", onlyIf(is_round, e.radius),
          {.help = "Radius", .unit = "object units", .range = kFromZero, .left_out = true});
    visit("start", e.start, {"Begin of the births", "s"});
    visit("rate", e.rate, {"Births per second", {}, kFromZero});
    visit("duration", finite(e.duration), {"Duration of the births; null: endless", "s", kFromZero});
    visit("burst", e.burst, {"Births at once"});
    visit("burst_every", onlyIf(e.burst_every > 0.0, e.burst_every),
          {.help = "Time from burst to burst", .unit = "s", .range = kFromZero, .left_out = true});
    visit("direction", onlyIf(e.aim.has_value(), aim.direction),
          {.help = "Direction of flight; null: outwards", .left_out = true});
    visit(
        "cone", onlyIf(e.aim.has_value(), aim.cone_degrees),
        {.help = "Half angle about the direction", .unit = "degrees", .range = kFromZero, .left_out = true});
    visit("speed", settings.speed(),
          {.help = "Least and greatest speed, object units per second; or a normal distribution",
           .left_out = true});
    visit("velocity", onlyIf(!e.aim, e.velocity),
          {.help = "Velocity", .unit = "object units per second", .left_out = true});
    visit("velocity_spread", e.velocity_spread,
          {"Largest deviation from the velocity", "object units per second"});
    visit("lifetime", std::array{e.lifetime_min, e.lifetime_max}, {"Least and greatest lifetime", "s"});
    visit("type", e.type, {"Index of the type"});
    visit("seed", e.seed, {"Seed of the births"});
    visit("spread", e.spread, {"Births are spread over their step"});
    visit("attach", e.attach, {.help = "Number of the collider in whose space it is", .left_out = true});
    visit("key", viewsOf<PoseKeyTable>(e.keys), kKeysField);
    visit("inherit", onlyIf(e.moves(), e.inherit),
          {.help = "Share of its own velocity that births inherit", .range = kFromZero, .left_out = true});
}

struct SpawnTable {
    const SceneSpawn& spawn = kNone<SceneSpawn>;
};

template <class Visitor, FieldsOf<SpawnTable> R>
void fields(Visitor& visit, R& report) {
    const SpawnSettings& s = report.spawn;
    const bool on_death = s.on == SpawnOn::kDeath;
    visit("on", s.on, {"Event"});
    visit("of", s.of, {"Index of the type that hits or dies; null: all"});
    visit("type", s.type, {"Index of the type that is born"});
    visit("count", std::array{s.count_min, s.count_max},
          {"Least and greatest number of births for each event"});
    visit("most", s.most, {"Births per step, at most", {}, kFromOne});
    visit("lifetime", std::array{s.lifetime_min, s.lifetime_max},
          {"Least and greatest lifetime", "s", kFromZero});
    visit("inherit", s.inherit, {"Share of the parent's velocity", {}, kFromZero});
    visit("speed", std::array{s.speed_min, s.speed_max},
          {"Least and greatest speed", "world units per second", kFromZero});
    visit("kick", s.kick, {"Share of the speed of the hit, added to speed", {}, kFromZero});
    visit("cone", s.cone_degrees, {"Half angle", "degrees", {0.0, 180.0}});
    visit("seed", report.spawn.seed, {"Seed of the births"});
    visit("min_speed", onlyIf(!on_death, s.min_speed),
          {.help = "Slower hits spawn nothing",
           .unit = "world units per second",
           .range = kFromZero,
           .left_out = true});
}

struct CameraKeyTable {
    const SceneCameraKey& key = kNone<SceneCameraKey>;
    glm::vec3 target{0.0F};  ///< where the key has none
    float fov = 0.0F;
};

template <class Visitor, FieldsOf<CameraKeyTable> S>
void fields(Visitor& visit, S& settings) {
    const SceneCameraKey& key = settings.key;
    visit("time", key.time, {"Time", "s"});
    visit("eye", key.eye, {"Position of the eye", "object units"});
    visit("target", key.target.value_or(settings.target), {"Point looked at", "object units"});
    visit("fov", key.fov.value_or(settings.fov), {"Vertical field of view", "degrees"});
}

enum class GroundWord : std::uint8_t { kGround };
template <>
inline constexpr std::array<std::string_view, 1> kWordsOf<GroundWord>{"ground"};

struct TypeTable {
    const Scene& scene = kNone<Scene>;
    const SceneType& type = kNone<SceneType>;

    [[nodiscard]] std::vector<std::variant<std::size_t, GroundWord>> collides() const;
};

/// A key of a track: [age, value].
inline std::array<float, 2> partsOf(const AgeKey<float>& key) {
    return {key.age, key.value};
}
inline std::array<float, 4> partsOf(const AgeKey<glm::vec3>& key) {
    return {key.age, key.value.x, key.value.y, key.value.z};
}
template <class T>
[[nodiscard]] Json jsonField(const AgeKey<T>& key) {
    return jsonOf(partsOf(key));
}
template <class T>
[[nodiscard]] Json schemaField(const AgeKey<T>& key) {
    return schemaOf(partsOf(key));
}

template <class Visitor, FieldsOf<TypeTable> S>
void fields(Visitor& visit, S& settings) {
    const SceneType& type = settings.type;
    fields(visit, type.look);
    visit("name", type.name, {.help = "Name of the type", .left_out = true});
    fields(visit, baseOf<ParticleType>(type));
    visit("collides", settings.collides(),
          {"Bodies that it collides with: numbers of colliders, and \"ground\""});
}

/// One, or a list of several.
template <class View>
using OneOrSeveral = std::variant<View, std::vector<View>>;

template <class View, class T>
[[nodiscard]] OneOrSeveral<View> oneOrSeveral(const std::vector<T>& all) {
    return all.size() == 1 ? OneOrSeveral<View>(View{all.front()}) : OneOrSeveral<View>(viewsOf<View>(all));
}

struct SceneSettings {
    const Scene& scene = kNone<Scene>;

    [[nodiscard]] std::vector<TypeTable> types() const;
};

template <class Visitor>
void airFields(Visitor& visit, const Scene& scene) {
    const AirSettings& air = scene.air;
    visit("attractor", air.attractors, {.help = "[[attractor]]", .left_out = true});
    visit("vortex", air.vortices, {.help = "[[vortex]]", .left_out = true});
    const auto flow = [&](auto& visit_flow) {
        const FlowFile& file = scene.flow ? *scene.flow : kNone<FlowFile>;
        visit_flow("raw", file.path, {"Raw grid"});
        visit_flow("size", file.size, {"Nodes along x, y and z"});
        visit_flow("components", file.components, {"Numbers per node"});
        visit_flow("box_min", file.box_min, {"Lower corner of the box", "object units"});
        visit_flow("box_max", file.box_max, {"Upper corner of the box", "object units"});
        visit_flow("outside", file.outside, {"Flow outside the box"});
        visit_flow("gain", file.gain, {"Factor of the velocity"});
    };
    visit("flow", groupIf(scene.flow.has_value(), flow), {.help = "[flow]", .left_out = true});
    visit("curl_noise", air.curl_noise, {.help = "[curl_noise]", .left_out = true});
}

template <class Visitor>
void cameraFields(Visitor& visit, const Scene& scene) {
    const auto& camera = scene.camera;
    const bool moves = !camera.keys.empty();
    const glm::vec3 target = camera.target.value_or(glm::vec3(0.0F));
    visit("eye", onlyIf(!moves, camera.eye.value_or(glm::vec3(0.0F))),
          {.help = "Position of the eye", .unit = "object units", .left_out = true});
    visit("target", target, {"Point looked at", "object units"});
    visit("fov", camera.fov, {"Vertical field of view", "degrees"});
    visit("path", onlyIf(moves, camera.curve), {.help = "Curve between keys", .left_out = true});
    visit("key", viewsOf<CameraKeyTable>(camera.keys, target, camera.fov),
          {.help = "Keys of its motion", .left_out = true});
}

template <class Visitor>
void renderFields(Visitor& visit, const Scene& scene) {
    const auto& render = scene.render;
    const bool has_atlas = !render.atlas.empty();
    visit("size", std::array{render.width, render.height}, {"Width and height", "pixels"});
    visit("point_size", render.point_size.value_or(0.0F), {"Diameter of a particle", "object units"});
    visit("color", render.color, {"Red, green and blue, 0 to 1"});
    visit("opacity", render.opacity, {"Opacity, 0 to 1"});
    visit("background", render.background, {"Red, green and blue, 0 to 1"});
    visit("every", render.every, {"Steps from frame to frame"});
    visit("first", firstFrame(scene), {"Step of the first frame"});
    visit("last", lastFrame(scene), {"Step of the last frame"});
    visit("sort_frames", render.sort_frames,
          {"Frames that sorting is spread over, on the fragment path; 0: no sorting"});
    visit("sprite", render.sprite, {"Primitive for a particle"});
    visit("blend", render.blend, {"Blending"});
    visit("soft", render.soft, {"Distance from the collider over which sprites fade", "object units"});
    visit("atlas", onlyIf(has_atlas, render.atlas), {.help = "Image of the atlas", .left_out = true});
    visit("atlas_cells", onlyIf(has_atlas, std::array{render.atlas_columns, render.atlas_rows}),
          {.help = "Columns and rows of the atlas", .left_out = true});
    visit("mesh", onlyIf(!render.mesh.empty(), render.mesh),
          {.help = "Mesh drawn instead of the collider", .left_out = true});
}

template <class Visitor, FieldsOf<SceneSettings> S>
void fields(Visitor& visit, S& settings) {
    const Scene& scene = settings.scene;
    visit("collider", oneOrSeveral<ColliderTable>(scene.colliders),
          {.help = "One, or several", .items = {2.0}});
    visit("time", scene.time, {"[time]"});
    visit("particles", scene.particles, {"[particles]"});
    visit("emitter", oneOrSeveral<EmitterTable>(scene.emitters), {.help = "One, or several", .items = {2.0}});
    visit("spawn", viewsOf<SpawnTable>(scene.spawns), {.help = "[[spawn]]", .left_out = true});
    const auto forces = [&](auto& visit_forces) {
        const bool viscous = scene.air.viscosity.has_value();
        visit_forces("gravity", scene.forces.gravity.value_or(glm::vec3(0.0F)),
                     {"Gravity", "object units per second squared"});
        visit_forces("wind", scene.forces.wind, {"Wind", "object units per second"});
        visit_forces("drag", onlyIf(!viscous, scene.forces.drag),
                     {.help = "Drag", .unit = "1/s", .left_out = true});
        visit_forces("viscosity", scene.air.viscosity,
                     {.help = "Viscosity, instead of drag", .left_out = true});
    };
    visit("forces", group(forces), {"[forces]"});
    visit("collision", scene.collision, {"[collision]"});
    const auto ground = [&](auto& visit_ground) {
        visit_ground("enabled", scene.ground.enabled, {"There is a ground"});
        visit_ground("height", scene.ground.enabled ? scene.ground.height : std::nullopt,
                     {.help = "Height", .unit = "object units", .left_out = true});
    };
    visit("ground", group(ground), {"[ground]"});
    visit("camera", group([&](auto& visit_camera) { cameraFields(visit_camera, scene); }), {"[camera]"});
    visit("render", group([&](auto& visit_render) { renderFields(visit_render, scene); }), {"[render]"});
    airFields(visit, scene);
    visit("type", settings.types(), {.help = "[[type]]", .left_out = true});
}

}  // namespace relief
