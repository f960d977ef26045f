// What a scene file says, as plain structs. Every key, its unit, default and range: README.md beside this
// file.
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
#include "runtime/air/air.h"
#include "runtime/files/flow_file.h"
#include "runtime/particles/particle_system.h"
#include "runtime/picture/camera_path.h"
#include "runtime/picture/particle_renderer.h"
#include "runtime/scene/scene_collider.h"
#include "runtime/scene/scene_emitter.h"
#include "runtime/scene/scene_spawn.h"

namespace relief {

/// A [[camera.key]]; what it leaves open is [camera]'s.
struct SceneCameraKey {
    double time = 0.0;  ///< seconds
    glm::vec3 eye{0.0F};
    std::optional<glm::vec3> target;
    std::optional<float> fov;  ///< degrees
};

/// What a scene file says. Where a default depends on the collider's size the value is optional, and
/// withDefaults() fills it.
struct Scene {
    std::vector<SceneCollider> colliders;  ///< at least one

    float dt = 1.0F / 60.0F;  ///< seconds
    std::uint32_t steps = 300;
    double prewarm = 0.0;  ///< seconds, in whole steps, that are played before time 0
    std::uint32_t capacity = 65536;
    Integrator integrator = Integrator::kEuler;

    std::vector<SceneEmitter> emitters{SceneEmitter{}};  ///< at least one
    std::vector<SceneSpawn> spawns;                      ///< of [[spawn]], in their order

    struct {
        std::optional<glm::vec3> gravity;
        glm::vec3 wind{0.0F};
        float drag = 2.5F;
    } forces;

    AirSettings air;               ///< its flow is null: loadFlow() reads it from `flow`
    std::optional<FlowFile> flow;  ///< box in object units

    Collision collision{0.0F, 1.0F, 0.0F};
    float sweep = 0.0F;               ///< as ParticleSystem::setSweep
    std::vector<ParticleType> types;  ///< of [[type]], in their order; empty: one that [collision] describes
    std::vector<std::string> type_names;   ///< as many; "" where a type has none
    std::vector<std::string> type_places;  ///< as many: "file:line:column" of the table

    struct {
        bool enabled = true;
        std::optional<float> height;
    } ground;

    struct {
        std::optional<glm::vec3> eye;
        std::optional<glm::vec3> target;
        float fov = 30.0F;                 ///< degrees
        std::vector<SceneCameraKey> keys;  ///< times rising; empty: the camera stands still
        CameraCurve curve = CameraCurve::kSmooth;
    } camera;

    struct {
        std::uint32_t width = 960;
        std::uint32_t height = 720;
        std::optional<float> point_size;      ///< diameter, object units
        glm::vec3 color{0.97F, 0.98F, 1.0F};  ///< sRGB
        float opacity = 0.95F;
        glm::vec3 background{0.62F, 0.69F, 0.76F};  ///< sRGB
        std::uint32_t every = 10;                   ///< steps from frame to frame
        std::optional<std::uint32_t> first;         ///< step of the first frame; nullopt: `every`
        std::optional<std::uint32_t> last;          ///< of the last; nullopt: the end of the run
        std::uint32_t sort_frames = 0;  ///< that a depth sort is spread over, 2…200; 0: unsorted
        Sprite sprite = Sprite::kPoint;
        Blend blend = Blend::kAlpha;
        float soft = 0.0F;            ///< object units
        std::filesystem::path atlas;  ///< resolved; empty: none
        std::string atlas_origin;     ///< as collider_origin
        std::uint32_t atlas_columns = 1;
        std::uint32_t atlas_rows = 1;
        std::filesystem::path mesh;  ///< resolved; empty: the collider is drawn from its maps
        std::string mesh_origin;
        std::vector<ParticleLook> looks;  ///< of [[type]], in their order
    } render;
};

/// Steps that are played before time 0.
[[nodiscard]] std::uint32_t prewarmSteps(const Scene& scene);
/// The steps after which the first frame and the last are due; 0 is before the first step.
[[nodiscard]] std::uint32_t firstFrame(const Scene& scene);
[[nodiscard]] std::uint32_t lastFrame(const Scene& scene);
/// Whether one is due after so many steps: every `render.every` from the first on, and at the last.
[[nodiscard]] bool frameDue(const Scene& scene, std::uint32_t step);
/// How many are due in the whole run.
[[nodiscard]] std::uint32_t frameCount(const Scene& scene);

/// What is wrong with a camera that looks from `eye` to `target`; "" if nothing is.
[[nodiscard]] std::string_view cameraProblem(const glm::vec3& eye, const glm::vec3& target);

/// Every optional filled from the collider's bounds: snow that falls on it from above, seen from the front.
/// Errors: kInvalidInput (the eye straight above the target once defaults are in).
[[nodiscard]] Result<Scene> withDefaults(Scene scene, const Bounds& bounds);

}  // namespace relief
