// A scene file as plain structs. Every key is declared once, in fields() beside its struct; README.md beside this file lists
// them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/material_response.h"
#include "runtime/air/air.h"
#include "runtime/files/flow_file.h"
#include "runtime/particles/particle_system.h"
#include "runtime/picture/particle_renderer.h"
#include "runtime/scene/scene_collider.h"
#include "runtime/scene/scene_emitter.h"

namespace relief {

struct SceneTime {
    float dt = 1.0F / 60.0F;  ///< seconds
    std::uint32_t steps = 300;
    double prewarm = 0.0;  ///< seconds, in whole steps, that are played before time 0
    Integrator integrator = Integrator::kEuler;
};

template <class Visitor, FieldsOf<SceneTime> T>
void fields(Visitor& visit, T& time) {
    visit("dt", time.dt, {"Length of a step", "s", {1e-6, 1.0}, "1/60"});
    visit("steps", time.steps, {"Steps of the run", {}, {0.0, kStepsMax}});
    visit("prewarm", time.prewarm,
          {"Time that is played before time 0, in whole steps, at most 10⁷ of them", "s", kTimeRange});
    visit("integrator", time.integrator, {"Integration of positions: semi-implicit Euler, or Verlet"});
}
[[nodiscard]] std::optional<FieldFault> check(SceneTime& time, const GivenFields& given);

struct SceneParticles {
    std::uint32_t capacity = 65536;
};

template <class Visitor, FieldsOf<SceneParticles> P>
void fields(Visitor& visit, P& particles) {
    visit("capacity", particles.capacity,
          {"Particles alive at once", {}, {1.0, ParticleSystem::kCapacityMax}});
}

struct SceneForces {
    std::optional<glm::vec3> gravity;
    glm::vec3 wind{0.0F};
    float drag = 2.5F;
    bool has_drag = true;  ///< else viscosity
    std::optional<float> viscosity;
};

template <class Visitor, FieldsOf<SceneForces> F>
void fields(Visitor& visit, F& forces) {
    visit("gravity", forces.gravity,
          {"Acceleration of gravity", "[x, y, z]/s²", within(kAccelerationMax), "[0, −3 L, 0]"});
    visit("wind", forces.wind,
          {"Velocity of the air everywhere; it needs drag", "[x, y, z]/s", within(kSpeedMax)});
    visit("drag", FieldMaybe{forces.drag, forces.has_drag},
          leftOut({"Rate at which the air carries particles along", "1/s", {0.0, kDragMax}}));
    visit("viscosity", forces.viscosity,
          leftOut({"Dynamic viscosity: drag by Stokes' law",
                   "mass/(length·s)",
                   {0.0, 1e6},
                   "none",
                   {.instead_of = "drag"}}));
}
[[nodiscard]] std::optional<FieldFault> check(SceneForces& forces, const GivenFields& given);

struct SceneCollision : Collision {
    SceneCollision() : Collision{0.0F, 1.0F, 0.0F} {}
    float sweep = 0.0F;  ///< as ParticleSystem::setSweep
};

template <class Visitor, FieldsOf<SceneCollision> C>
void fields(Visitor& visit, C& c) {
    visit("restitution", c.restitution, {"Share of the normal speed that comes back", {}, {0.0, 1.0}});
    visit("friction", c.friction, {"Share of the tangential speed that is lost", {}, {0.0, 1.0}});
    visit("friction_threshold", c.friction_threshold,
          {"Speed below which there is no friction", "1/s", kSpeedRange});
    visit("sweep", c.sweep,
          {"Longest distance between two tests of a step; 0: only its ends are tested", {}, kLengthRange});
}

/// A world of which only a part is in full detail.
struct SceneStream {
    float radius = 0.0F;
    float memory = 256.0F;
    friend bool operator==(const SceneStream&, const SceneStream&) = default;
};

template <class Visitor, FieldsOf<SceneStream> T>
void fields(Visitor& visit, T& stream) {
    visit("radius", stream.radius,
          {"Distance from emitters and the camera up to which the world has full detail",
           {},
           kSizeRange,
           {},
           kRequired});
    visit("memory", stream.memory,
          {"Bytes of the GPU that the colliders may take, the coarse ones included", "MB", {0.001, 65536.0}});
}

struct SceneGround {
    bool enabled = true;
    std::optional<float> height;
};

template <class Visitor, FieldsOf<SceneGround> G>
void fields(Visitor& visit, G& ground) {
    visit("enabled", ground.enabled, {"There is a ground"});
    visit("height", ground.height,
          leftOut({"Its height; needs enabled", {}, kPointRange, "lower end of the bounds"}));
}

/// A [[camera.key]]; what it leaves open is [camera]'s.
struct SceneCameraKey {
    double time = 0.0;  ///< seconds
    glm::vec3 eye{0.0F};
    std::optional<glm::vec3> target;
    std::optional<float> fov;  ///< degrees
};

template <class Visitor, FieldsOf<SceneCameraKey> K>
void fields(Visitor& visit, K& key) {
    visit("time", key.time, {"Time since the beginning, rising", "s", {0.0, kKeySecondsMax}, {}, kRequired});
    visit("eye", key.eye,
          {"Place of the camera, instead of camera.eye", "[x, y, z]", kPointRange, {}, kRequired});
    visit("target", key.target, {"Point that it looks at", "[x, y, z]", kPointRange, "camera.target"});
    visit("fov", key.fov, {"Vertical field of view", "degrees", kFovRange, "camera.fov"});
}

struct SceneCamera {
    std::optional<glm::vec3> eye;
    std::optional<glm::vec3> target;
    float fov = 30.0F;                 ///< degrees
    std::vector<SceneCameraKey> keys;  ///< times rising; empty: the camera stands still
};

template <class Visitor, FieldsOf<SceneCamera> C>
void fields(Visitor& visit, C& camera) {
    visit("eye", camera.eye,
          leftOut({"Place of the camera",
                   "[x, y, z]",
                   kPointRange,
                   "in front and above, framing the bounds",
                   {.instead_of = "key"}}));
    visit("target", camera.target,
          {"Point that it looks at, not straight above or below the eye", "[x, y, z]", kPointRange,
           "middle of the bounds"});
    visit("fov", camera.fov, {"Vertical field of view", "degrees", kFovRange});
    visit("key", camera.keys, leftOut({"Places of the camera at times", {}, {}, {}, {.most = 10'000}}));
}
[[nodiscard]] std::optional<FieldFault> check(SceneCamera& camera, const GivenFields& given);

/// A [[render.weather]].
struct SceneWeather {
    double time = 0.0;
    float sun = 1.0F;
    float wet = 0.0F;
    float snow = 0.0F;
};

template <class Visitor, FieldsOf<SceneWeather> W>
void fields(Visitor& visit, W& weather) {
    visit("time", weather.time, {"Time since the beginning, rising", "s", {0.0, kKeySecondsMax}});
    visit("sun", weather.sun, {"Light of the sun; 0: clouds hide it", {}, {0.0, 1.0}});
    visit("wet", weather.wet, {"How wet is what rain reaches", {}, {0.0, 1.0}});
    visit("snow", weather.snow, {"How much snow lies where it reaches level ground", {}, {0.0, 1.0}});
}

struct SceneRender {
    std::uint32_t width = 960;
    std::uint32_t height = 720;
    std::optional<float> point_size;      ///< diameter, object units
    glm::vec3 color{0.97F, 0.98F, 1.0F};  ///< sRGB
    float opacity = 0.95F;
    glm::vec3 background{0.62F, 0.69F, 0.76F};  ///< sRGB
    std::uint32_t every = 10;                   ///< steps from frame to frame
    std::optional<std::uint32_t> first;         ///< step of the first frame; nullopt: `every`
    std::optional<std::uint32_t> last;          ///< of the last; nullopt: the end of the run
    std::uint32_t sort_frames = 0;              ///< that a depth sort is spread over, 2…200; 0: unsorted
    Sprite sprite = Sprite::kPoint;
    Blend blend = Blend::kAlpha;
    float soft = 0.0F;            ///< object units
    std::filesystem::path atlas;  ///< resolved; empty: none
    std::string atlas_origin;     ///< "scene.toml:3:8" of the key, for messages
    std::uint32_t atlas_columns = 1;
    std::uint32_t atlas_rows = 1;
    std::filesystem::path mesh;  ///< resolved; empty: the collider is drawn from its maps
    std::string mesh_origin;
    std::filesystem::path meshes;  ///< resolved; empty: none
    std::string meshes_origin;
    float fog = 0.0F;                   ///< world units; 0: none
    float metre = 1.0F;                 ///< world units
    std::optional<float> shadows;       ///< world units about camera.target
    std::vector<SceneWeather> weather;  ///< times rising
};

template <class Visitor, FieldsOf<SceneRender> R>
void fields(Visitor& visit, R& r) {
    visit("size", FieldPair{r.width, r.height},
          {"Size of the pictures, 2²⁶ pixels at most", "[width, height] pixels", {1.0, 65535.0}});
    visit("point_size", r.point_size, {"Diameter of particles", {}, kSizeRange, "0.0065 L"});
    visit("color", r.color, {"Colour of particles", "[r, g, b]", {0.0, 1.0}});
    visit("opacity", r.opacity, {"Opacity of particles", {}, {0.0, 1.0, false}});
    visit("background", r.background, {"Colour of the background", "[r, g, b]", {0.0, 1.0}});
    visit("every", r.every, {"Steps from frame to frame", {}, {1.0, kStepsMax}});
    visit("first", r.first,
          {"Step of the first frame; 0: before the first step", {}, {0.0, kStepsMax}, "every"});
    visit("last", r.last, {"Step of the last frame", {}, {0.0, kStepsMax}, "the last step"});
    visit("sort_frames", r.sort_frames,
          {"Frames that a whole depth sort is spread over, 2 or more; 0: no sort. On the compute "
           "path each frame has a whole one",
           {},
           {0.0, 200.0}});
    visit("sprite", r.sprite, {"Form of particles; a quad may be of any size and turns with its corners"});
    visit("blend", r.blend, {"Blending of particles"});
    visit("soft", r.soft,
          {"Distance before the collider and the floor over which sprites fade", {}, kLengthRange});
    visit("atlas", FieldFile{r.atlas, r.atlas_origin},
          leftOut({"PNG with alpha, sides up to 8192; needs a type with cell", {}, {}, "none"}));
    visit("atlas_cells", FieldPair{r.atlas_columns, r.atlas_rows},
          leftOut({"Cells of the atlas, dividing its sides",
                   "[columns, rows]",
                   {1.0, 4096.0},
                   {},
                   {.needs = "atlas"}}));
    visit("mesh", FieldFile{r.mesh, r.mesh_origin},
          leftOut({"The .obj or .ply that the collider was baked from: it is drawn, the maps still cast the "
                   "shadows",
                   {},
                   {},
                   "none: the maps are drawn"}));
    visit(
        "meshes", FieldFile{r.meshes, r.meshes_origin},
        leftOut(
            {"Folder of .ply and .obj files, which may have colours at their vertices: a world's mesh NAME "
             "is drawn as "
             "NAME.ply, the container NAME.relief too, with shadows of their own. What plays a clip is drawn "
             "from its container",
             {},
             {},
             "none: the maps are drawn",
             {.instead_of = "mesh"}}));
    visit("fog", r.fog,
          {"Distance over which 63 % is lost in the background's colour; 0: no fog",
           {},
           kLengthRange,
           {},
           {.needs = "meshes"}});
    visit("metre", r.metre,
          {"World units of a metre: of the meshes' grain, snow drifts and shaded corners",
           {},
           kSizeRange,
           {},
           {.needs = "meshes"}});
    visit("shadows", r.shadows,
          leftOut(
              {"Distance from camera.target, along x and z, up to which the meshes have shadows and shelter",
               {},
               kSizeRange,
               "the whole scene",
               {.needs = "meshes"}}));
    visit("weather", r.weather,
          leftOut({"Weather of the meshes at times; between them it changes evenly",
                   {},
                   {},
                   "sun, and nothing wet",
                   {.needs = "meshes", .most = 10'000}}));
}
[[nodiscard]] std::optional<FieldFault> check(SceneRender& render, const GivenFields& given);

/// ParticleType::collides as a list of bodies.
template <class Bits>
struct CollidesList {
    Bits& bits;
};
template <class Bits>
CollidesList(Bits&) -> CollidesList<Bits>;

/// A [[type]]: how its particles move, collide and look.
struct SceneType : ParticleType {
    std::string name;  ///< "": none
    ParticleLook look;
    std::string place;  ///< "file:line:column" of the table
};

template <class Visitor, FieldsOf<SceneType> T>
void fields(Visitor& visit, T& type) {
    visit("name", type.name, leftOut({"Name for emitter.type and spawn, not taken twice", {}, {}, "none"}));
    fields(visit, baseOf<ParticleType>(type));
    visit("collides", CollidesList{type.collides},
          {"The colliders it meets, by number from 0, 7 standing for all beyond 7 too, and \"ground\", as in "
           "[0, \"ground\"]; it passes through all others",
           {},
           {},
           "everything"});
    fields(visit, type.look);
}
[[nodiscard]] std::optional<FieldFault> check(SceneType& type, const GivenFields& given);

inline constexpr std::size_t kSceneMaterialsMax = 4096;

/// A value whose default depends on the collider's size is optional; withDefaults() fills it.
struct Scene {
    std::filesystem::path world;  ///< resolved; empty: none
    std::string world_origin;     ///< "scene.toml:3:8" of the key, for messages; empty without a scene file
    std::optional<SceneStream> stream;  ///< none: all of the world is there in full detail
    /// Those of the file's tables and, once loaded, behind them the bodies of the world that no table names; then at least
    /// one.
    std::vector<SceneCollider> colliders;
    std::vector<MaterialResponse> materials;  ///< of all colliders, by name
    SceneTime time;
    SceneParticles particles;
    std::vector<SceneEmitter> emitters{SceneEmitter{}};  ///< at least one
    std::vector<SceneSpawn> spawns;
    SceneForces forces;
    AirSettings
        air;  ///< wind and viscosity are those of `forces`; its flow is null: loadFlow() reads it from `flow`
    std::optional<FlowFile> flow;  ///< box in object units
    SceneCollision collision;
    std::vector<SceneType> types;  ///< empty: one that [collision] describes
    SceneGround ground;
    SceneCamera camera;
    SceneRender render;
};

template <class Visitor, FieldsOf<Scene> S>
void fields(Visitor& visit, S& scene) {
    visit("world", FieldFile{scene.world, scene.world_origin},
          leftOut({"The world.json whose bodies particles collide with, beside the colliders",
                   {},
                   {},
                   "none, and then a collider is required"}));
    visit(
        "collider", scene.colliders,
        {"What particles collide with", {}, {}, {}, {.most = ColliderTextures::kBodiesMax, .single = true}});
    visit("material", scene.materials,
          leftOut({"Responses of the colliders' materials", {}, {}, {}, {.most = kSceneMaterialsMax}}));
    visit("stream", scene.stream, leftOut({"Colliders of the world that are there when they are needed"}));
    visit("time", scene.time, {"Steps"});
    visit("particles", scene.particles, {"Room for particles"});
    visit("emitter", scene.emitters, {"Births", {}, {}, {}, {.most = kEmittersMax, .single = true}});
    visit("spawn", scene.spawns, leftOut({"Births by hits and deaths", {}, {}, {}, {.most = kSpawnsMax}}));
    visit("forces", scene.forces, {"Gravity, wind and drag"});
    fields(visit, scene.air);
    visit("flow", scene.flow, leftOut({"Velocities of the air on a grid; it needs drag"}));
    visit("collision", scene.collision, {"Collisions of particles without a type"});
    visit("type", scene.types,
          leftOut({"Types of particles; the first is type 0", {}, {}, {}, {.most = kLooksMax}}));
    visit("ground", scene.ground, {"The floor"});
    visit("camera", scene.camera, {"The camera"});
    visit("render", scene.render, {"Pictures"});
}
[[nodiscard]] std::optional<FieldFault> check(Scene& scene, const GivenFields& given);

/// The types as a particle system, and their looks as a renderer takes them.
[[nodiscard]] std::vector<ParticleType> particleTypes(const Scene& scene);
[[nodiscard]] std::vector<ParticleLook> particleLooks(const Scene& scene);

/// Steps that are played before time 0.
[[nodiscard]] std::uint32_t prewarmSteps(const Scene& scene);
/// The steps after which the first frame and the last are due; 0 is before the first step.
[[nodiscard]] std::uint32_t firstFrame(const Scene& scene);
[[nodiscard]] std::uint32_t lastFrame(const Scene& scene);
/// A frame is due every `render.every` steps from the first on, and at the last.
[[nodiscard]] bool frameDue(const Scene& scene, std::uint32_t step);
/// Frames of the whole run.
[[nodiscard]] std::uint32_t frameCount(const Scene& scene);

/// Every optional filled from the collider's bounds: snow that falls on it from above, seen from the front.
/// Errors: kInvalidInput (the eye straight above the target once defaults are in).
[[nodiscard]] Result<Scene> withDefaults(Scene scene, const Bounds& bounds);

}  // namespace relief
