// SPDX-License-Identifier: Apache-2.0
// A scene file as plain structs. Every key is declared once, in fields() of its struct; README.md in this folder lists
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
    double prewarm = 0.0;  ///< seconds simulated before time 0, in whole steps
    Integrator integrator = Integrator::kEuler;
};

void fields(FieldVisitor& visit, SceneTime& time);
[[nodiscard]] std::optional<FieldFault> check(SceneTime& time, const GivenFields& given);

struct SceneParticles {
    std::uint32_t capacity = 65536;
};

void fields(FieldVisitor& visit, SceneParticles& particles);

struct SceneForces {
    std::optional<glm::vec3> gravity;
    glm::vec3 wind{0.0F};
    float drag = 2.5F;
    bool has_drag = true;  ///< false: viscosity is used
    std::optional<float> viscosity;
};

void fields(FieldVisitor& visit, SceneForces& forces);
[[nodiscard]] std::optional<FieldFault> check(SceneForces& forces, const GivenFields& given);

struct SceneCollision {
    float restitution = 0.0F;  ///< this and the next two members: as in ParticleType
    float friction = 1.0F;
    float friction_threshold = 0.0F;
    std::optional<float> sweep;  ///< for ParticleSystem::setSweep(); nullopt: computed by SceneSweep
};

void fields(FieldVisitor& visit, SceneCollision& c);

/// [stream]: a world with full detail only near points of interest.
struct SceneStream {
    float radius = 0.0F;
    float memory = 256.0F;
    friend bool operator==(const SceneStream&, const SceneStream&) = default;
};

void fields(FieldVisitor& visit, SceneStream& stream);

struct SceneGround {
    bool enabled = true;
    std::optional<float> height;
};

void fields(FieldVisitor& visit, SceneGround& ground);

/// A [[camera.key]]; missing values are those of [camera].
struct SceneCameraKey {
    double time = 0.0;  ///< seconds
    glm::vec3 eye{0.0F};
    std::optional<glm::vec3> target;
    std::optional<float> fov;  ///< degrees
};

void fields(FieldVisitor& visit, SceneCameraKey& key);

struct SceneCamera {
    std::optional<glm::vec3> eye;
    std::optional<glm::vec3> target;
    float fov = 30.0F;                 ///< degrees
    std::vector<SceneCameraKey> keys;  ///< ascending times; empty: the camera is fixed
};

void fields(FieldVisitor& visit, SceneCamera& camera);
[[nodiscard]] std::optional<FieldFault> check(SceneCamera& camera, const GivenFields& given);

/// A [[render.weather]].
struct SceneWeather {
    double time = 0.0;
    float sun = 1.0F;
    float wet = 0.0F;
    float snow = 0.0F;
};

void fields(FieldVisitor& visit, SceneWeather& weather);

struct SceneRender {
    std::uint32_t width = 960;
    std::uint32_t height = 720;
    std::optional<float> point_size;      ///< diameter, object units
    glm::vec3 color{0.97F, 0.98F, 1.0F};  ///< sRGB
    float opacity = 0.95F;
    glm::vec3 background{0.62F, 0.69F, 0.76F};  ///< sRGB
    std::uint32_t steps_per_frame = 10;
    std::optional<std::uint32_t> first_frame;  ///< step of the first frame; nullopt: `steps_per_frame`
    std::optional<std::uint32_t> last_frame;   ///< step of the last frame; nullopt: the end of the run
    std::uint32_t sort_frames = 0;             ///< frames per depth sort, 2…200; 0: unsorted
    Sprite sprite = Sprite::kPoint;
    Blend blend = Blend::kAlpha;
    float soft_distance = 0.0F;   ///< object units
    std::filesystem::path atlas;  ///< resolved; empty: none
    std::string atlas_origin;     ///< position of the key, "scene.toml:3:8", for messages
    std::uint32_t atlas_columns = 1;
    std::uint32_t atlas_rows = 1;
    std::filesystem::path mesh;  ///< resolved; empty: draw the collider from its maps
    std::string mesh_origin;
    std::filesystem::path meshes;  ///< resolved; empty: none
    std::string meshes_origin;
    float fog_distance = 0.0F;             ///< world units; 0: none
    float units_per_meter = 1.0F;          ///< world units
    std::optional<float> shadow_distance;  ///< distance from camera.target, world units
    std::vector<SceneWeather> weather;     ///< ascending times
};

void fields(FieldVisitor& visit, SceneRender& r);
[[nodiscard]] std::optional<FieldFault> check(SceneRender& render, const GivenFields& given);

/// Reads and writes ParticleType::collides_with as a list such as [0, "ground"].
struct CollidesList {
    std::uint32_t& bits;
};
extern const FieldCustom kCollidesListField;
template <>
inline constexpr const FieldCustom* kFieldCustom<CollidesList> = &kCollidesListField;

// Tracks of a look: a single value, or keys [age, value…].
extern const FieldCustom kNumberTrackField;
extern const FieldCustom kColorTrackField;
extern const FieldCustom kNumberKeyField;
extern const FieldCustom kColorKeyField;
template <>
inline constexpr const FieldCustom* kFieldCustom<AgeTrack<float>> = &kNumberTrackField;
template <>
inline constexpr const FieldCustom* kFieldCustom<AgeTrack<glm::vec3>> = &kColorTrackField;
template <>
inline constexpr const FieldCustom* kFieldCustom<AgeKey<float>> = &kNumberKeyField;
template <>
inline constexpr const FieldCustom* kFieldCustom<AgeKey<glm::vec3>> = &kColorKeyField;
void fields(FieldVisitor& visit, ParticleLook& look);

/// A [[type]]: motion, collision and appearance of its particles.
struct SceneType : ParticleType {
    std::string name;  ///< "": none
    ParticleLook look;
    std::string place;  ///< "file:line:column" of the table
};

void fields(FieldVisitor& visit, SceneType& type);
[[nodiscard]] std::optional<FieldFault> check(SceneType& type, const GivenFields& given);

inline constexpr std::size_t kSceneMaterialsMax = 4096;

/// Values with a default that depends on the collider's size are optional; withDefaults() fills them.
struct Scene {
    std::filesystem::path world;  ///< resolved; empty: none
    /// Position of the key, "scene.toml:3:8", for messages; empty without a scene file.
    std::string world_origin;
    std::optional<SceneStream> stream;  ///< nullopt: the whole world has full detail
    /// Colliders of the scene file. Loading appends the other bodies of the world (placeBodies()). After loading, there
    /// is at least one collider.
    std::vector<SceneCollider> colliders;
    std::vector<MaterialResponse> materials;  ///< of all colliders, by name
    SceneTime time;
    SceneParticles particles;
    std::vector<SceneEmitter> emitters{SceneEmitter{}};  ///< at least one
    std::vector<SceneSpawn> spawns;
    SceneForces forces;
    /// Wind and viscosity are copied from `forces`; loadFlow() reads the flow from `flow`.
    AirSettings air;
    std::optional<FlowFile> flow;  ///< box in object units
    SceneCollision collision;
    std::vector<SceneType> types;  ///< empty: a single type, from [collision]
    SceneGround ground;
    SceneCamera camera;
    SceneRender render;
};

void fields(FieldVisitor& visit, Scene& scene);
[[nodiscard]] std::optional<FieldFault> check(Scene& scene, const GivenFields& given);

/// Returns the particle types of a scene; without [[type]], the single type of [collision].
[[nodiscard]] std::vector<ParticleType> particleTypes(const Scene& scene);

/// Returns the number of steps before time 0.
[[nodiscard]] std::uint32_t prewarmSteps(const Scene& scene);
/// Return the steps after which the first and the last frame are due; 0 is before the first step.
[[nodiscard]] std::uint32_t firstFrame(const Scene& scene);
[[nodiscard]] std::uint32_t lastFrame(const Scene& scene);
/// Returns whether a frame is due after a step: every `render.steps_per_frame` steps from the first frame on, and at
/// the last frame.
[[nodiscard]] bool frameDue(const Scene& scene, std::uint32_t step);
/// Returns the number of frames of the run.
[[nodiscard]] std::uint32_t frameCount(const Scene& scene);

/// Fills all optional values from the bounds of the collider. By default, snow falls on the collider, and the camera is
/// in front of it.
/// Errors: kInvalidInput (with defaults, the camera is directly above or below its target).
[[nodiscard]] Result<Scene> withDefaults(Scene scene, const Bounds& bounds);

/// Parses a scene file.
/// \param text    contents of the file; untrusted.
/// \param path    name of the file in messages. Paths in the scene are relative to its folder and may not leave it
///                (confined_path.h).
/// \param root    another folder in which the scene's files may lie; empty: none.
/// Errors: kInvalidInput, one line "file:line:column: what is wrong; what to do".
[[nodiscard]] Result<Scene> parseScene(std::string_view text, const std::filesystem::path& path,
                                       const std::filesystem::path& root = {});

/// Reads and parses a file. Errors: those of readFile() and parseScene(); kLimit above 1 MiB.
[[nodiscard]] Result<Scene> loadScene(const std::filesystem::path& path,
                                      const std::filesystem::path& root = {});

}  // namespace relief
