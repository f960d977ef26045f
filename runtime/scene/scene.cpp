// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene.h"

#include <algorithm>
#include <cmath>

#include "formats/base/file_io.h"
#include "formats/config/toml_reader.h"
#include "runtime/picture/camera.h"

namespace relief {
namespace {

constexpr std::uint64_t kSceneBytesMax = std::uint64_t{1} << 20;

/// Returns the fault of a camera at `eye`, or nullptr.
const char* cameraFault(const glm::vec3& eye, const glm::vec3& target) {
    const glm::vec3 d = eye - target;
    if (!(glm::length(d) > 0.0F)) {
        return "is at camera.target; move one of them";
    }
    if (std::hypot(d.x, d.z) <= 1e-4F * std::abs(d.y)) {
        return "is directly above or below camera.target; move it sideways";
    }
    return nullptr;
}

std::string nth(const char* list, std::size_t i, const std::string& key) {
    return std::string(list) + "[" + std::to_string(i) + "]" + key;
}

std::optional<FieldFault> checkAirOf(Scene& scene, const GivenFields& given) {
    scene.air.wind = scene.forces.wind;
    scene.air.viscosity = scene.forces.viscosity;
    const bool viscous = scene.air.viscosity.has_value();
    const float drag = scene.air.viscosity.value_or(scene.forces.drag);
    for (const char* table : {"flow", "curl_noise"}) {
        if (given(table) && drag == 0.0F) {
            return FieldFault{table, std::string("has no effect without drag; raise ") +
                                         (viscous ? "forces.viscosity" : "forces.drag")};
        }
    }
    return std::nullopt;
}

/// Checks that the frames are within the steps.
std::optional<FieldFault> checkFrames(const Scene& scene) {
    const SceneRender& render = scene.render;
    for (const auto& [path, step] :
         {std::pair("render.first_frame", render.first_frame), {"render.last_frame", render.last_frame}}) {
        if (step && *step > scene.time.steps) {
            return FieldFault{path, "= " + std::to_string(*step) + " is out of range; choose 0 to " +
                                        std::to_string(scene.time.steps)};
        }
    }
    if (render.last_frame && *render.last_frame < render.first_frame.value_or(0)) {
        return FieldFault{"render.last_frame", "comes before render.first_frame; swap them"};
    }
    return std::nullopt;
}

/// Checks render.mesh, which is drawn once, in its own space.
std::optional<FieldFault> checkMesh(const Scene& scene) {
    if (scene.render.mesh.empty()) {
        return std::nullopt;
    }
    if (!scene.world.empty()) {
        return FieldFault{"render.mesh", "cannot be used with a world; remove it"};
    }
    const SceneCollider& first = scene.colliders.front();
    if (scene.colliders.size() > 1 || !first.keys.empty() || !(first.pose == Pose{})) {
        return FieldFault{
            "render.mesh",
            "only works with a single collider without a pose; remove it, or the position, angle, "
            "scale and keys of the collider"};
    }
    if (first.play) {
        return FieldFault{"render.mesh", "cannot follow the clip; remove it to draw the maps"};
    }
    if (first.live && scene.render.mesh != first.path) {
        return FieldFault{"render.mesh", "is not the deforming mesh; use the file of collider.mesh"};
    }
    return std::nullopt;
}

std::optional<FieldFault> checkCells(const Scene& scene) {
    const SceneRender& render = scene.render;
    const std::uint32_t cells = render.atlas.empty() ? 0 : render.atlas_columns * render.atlas_rows;
    bool any = false;
    for (std::size_t i = 0; i < scene.types.size(); ++i) {
        const ParticleLook& look = scene.types[i].look;
        any = any || look.cell_first;
        if (look.cell_first && look.cell_last >= cells) {
            return FieldFault{nth("type", i, ".cell"),
                              cells == 0 ? "has no effect without render.atlas; add a PNG there, or remove it"
                                         : "is out of range; choose 0 to " + std::to_string(cells - 1)};
        }
    }
    if (cells > 0 && !any) {
        return FieldFault{
            "render.atlas",
            "has no effect unless a [[type]] has a cell; add 'cell = 0' to one, or remove the atlas"};
    }
    return std::nullopt;
}

/// Returns the number of colliders with their own index; further tiles of a mesh have none.
std::size_t numbered(const Scene& scene) {
    return static_cast<std::size_t>(std::count_if(scene.colliders.begin(), scene.colliders.end(),
                                                  [](const SceneCollider& c) { return !c.tile_of; }));
}

/// Returns all bodies as bits of ParticleType::collides_with.
std::uint32_t bodiesOf(const Scene& scene) {
    const auto groups = std::min<std::size_t>(numbered(scene), WorldTextures::kGroups);
    return (1U << groups) - 1U + (scene.ground.enabled ? kCollidesWithGround : 0U);
}

/// Fills missing values of the types from [collision], and checks them against the other tables.
std::optional<FieldFault> completeTypes(Scene& scene, const GivenFields& given) {
    for (std::size_t i = 0; i < scene.types.size(); ++i) {
        SceneType& type = scene.types[i];
        const auto inherit = [&](const char* key, float& value, float from) {
            value = given(nth("type", i, key)) ? value : from;
        };
        inherit(".restitution", type.restitution, scene.collision.restitution);
        inherit(".friction", type.friction, scene.collision.friction);
        inherit(".friction_threshold", type.friction_threshold, scene.collision.friction_threshold);
        if (const char* key = type.look.needsQuads(); key && scene.render.sprite == Sprite::kPoint) {
            return FieldFault{nth("type", i, "." + std::string(key)),
                              "has no effect on points; set render.sprite = \"quad\""};
        }
        for (const char* const key : {".rotation", ".rotation_spread", ".spin_spread"}) {
            if (type.look.stretch > 0.0F && given(nth("type", i, key))) {
                return FieldFault{nth("type", i, key), "has no effect with stretch; remove one of them"};
            }
        }
        for (std::size_t k = 0; k < i && !type.name.empty(); ++k) {
            if (scene.types[k].name == type.name) {
                return FieldFault{nth("type", i, ".name"), "is already used; choose another"};
            }
        }
    }
    return checkCells(scene);
}

}  // namespace

std::optional<FieldFault> check(SceneTime& time, const GivenFields& /*given*/) {
    if (time.prewarm > kStepsMax * static_cast<double>(time.dt)) {
        return FieldFault{"prewarm", "is more than " + numberText(kStepsMax) +
                                         " steps of time.dt; shorten it, or raise time.dt"};
    }
    return std::nullopt;
}

std::optional<FieldFault> check(SceneForces& forces, const GivenFields& /*given*/) {
    forces.has_drag = !forces.viscosity;
    if (forces.wind != glm::vec3(0.0F) && forces.viscosity.value_or(forces.drag) == 0.0F) {
        return FieldFault{"wind",
                          forces.viscosity
                              ? "has no effect while forces.viscosity is 0; raise it, or remove the wind"
                              : "has no effect while forces.drag is 0; raise the drag, or remove the wind"};
    }
    return std::nullopt;
}

std::optional<FieldFault> check(SceneCamera& camera, const GivenFields& /*given*/) {
    double before = -1.0;
    for (std::size_t i = 0; i < camera.keys.size(); ++i) {
        const SceneCameraKey& key = camera.keys[i];
        if (key.time <= before) {
            return FieldFault{nth("key", i, ".time"),
                              "= " + numberText(key.time) + " is not ascending; sort the keys by time"};
        }
        before = key.time;
        const glm::vec3 target =
            key.target.value_or(camera.target.value_or(key.eye + glm::vec3(0.0F, 0.0F, 1.0F)));
        if (cameraFault(key.eye, target) != nullptr) {
            return FieldFault{nth("key", i, ".eye"),
                              "is at its target, or directly above or below it; move it sideways"};
        }
    }
    const char* const problem =
        camera.eye && camera.target ? cameraFault(*camera.eye, *camera.target) : nullptr;
    return problem != nullptr ? std::optional(FieldFault{"eye", problem}) : std::nullopt;
}

std::optional<FieldFault> check(SceneRender& render, const GivenFields& /*given*/) {
    double before = -1.0;
    for (std::size_t i = 0; i < render.weather.size(); ++i) {
        if (render.weather[i].time <= before) {
            return FieldFault{nth("weather", i, ".time"), "= " + numberText(render.weather[i].time) +
                                                              " is not ascending; sort the list by time"};
        }
        before = render.weather[i].time;
    }
    if (render.sort_frames == 1) {
        // 1 would be a complete sort per frame, which spreading is meant to avoid.
        return FieldFault{"sort_frames", "= 1 is out of range; choose 0, for no sort, or 2 to 200"};
    }
    return std::nullopt;
}

std::optional<FieldFault> check(SceneType& type, const GivenFields& given) {
    ParticleLook& look = type.look;
    if (given("name") && type.name.empty()) {
        return FieldFault{"name", "is empty; set a name, or remove it"};
    }
    if (look.opacity.size() > 1 && !given("fade")) {  // the track defines the beginning and the end
        look.fade_in = 0.0F;
        look.fade_out = 0.0F;
    }
    return std::nullopt;
}

std::optional<FieldFault> check(Scene& scene, const GivenFields& given) {
    if (scene.colliders.empty() && scene.world.empty()) {
        return FieldFault{
            "", "a scene needs collider.file, the .relief file to collide with; bake one with 'relief bake'"};
    }
    if (scene.stream && scene.world.empty()) {
        return FieldFault{"stream", "needs 'world', a world.json to stream; add it"};
    }
    for (std::size_t i = 0; i < scene.colliders.size(); ++i) {
        if (!scene.colliders[i].node.empty() && scene.world.empty()) {
            return FieldFault{nth("collider", i, ".node"),
                              "needs 'world', the world.json with that node; add it"};
        }
    }
    if (const auto again = repeatedName(scene.materials)) {
        return FieldFault{nth("material", *again, ".name"),
                          "is already used; choose another, or merge the two"};
    }
    for (std::size_t i = 0; i < scene.emitters.size(); ++i) {
        const std::uint32_t capacity = scene.particles.capacity;
        if (scene.emitters[i].burst > capacity) {
            return FieldFault{nth("emitter", i, ".burst"),
                              "= " + std::to_string(scene.emitters[i].burst) +
                                  " is more than particles.capacity = " + std::to_string(capacity) +
                                  "; raise the capacity"};
        }
    }
    for (const auto& fault : {checkAirOf(scene, given), checkFrames(scene), checkMesh(scene)}) {
        if (fault) {
            return fault;
        }
    }
    return completeTypes(scene, given);
}

std::vector<ParticleType> particleTypes(const Scene& scene) {
    if (scene.types.empty()) {
        const SceneCollision& of = scene.collision;
        return {{.restitution = of.restitution,
                 .friction = of.friction,
                 .friction_threshold = of.friction_threshold}};
    }
    std::vector<ParticleType> types(scene.types.begin(), scene.types.end());
    for (ParticleType& type : types) {
        // Ignore bits of absent bodies: a type that collides with everything has a faster step.
        type.collides_with = type.collides_with == bodiesOf(scene) ? kCollidesWithAll : type.collides_with;
    }
    return types;
}

std::uint32_t prewarmSteps(const Scene& scene) {
    // Rounding must not add a step to a whole number of steps.
    return static_cast<std::uint32_t>(
        std::ceil(scene.time.prewarm / static_cast<double>(scene.time.dt) - 1e-6));
}

std::uint32_t firstFrame(const Scene& scene) {
    return std::min(scene.render.first_frame.value_or(scene.render.steps_per_frame), lastFrame(scene));
}

std::uint32_t lastFrame(const Scene& scene) {
    return std::min(scene.render.last_frame.value_or(scene.time.steps), scene.time.steps);
}

std::uint32_t frameCount(const Scene& scene) {
    const std::uint32_t first = firstFrame(scene);
    const std::uint32_t span = lastFrame(scene) - first;  // first is at most last
    return 1 + span / scene.render.steps_per_frame + (span % scene.render.steps_per_frame == 0 ? 0 : 1);
}

bool frameDue(const Scene& scene, std::uint32_t step) {
    const std::uint32_t first = firstFrame(scene);
    const std::uint32_t last = lastFrame(scene);
    return step >= first && step <= last &&
           ((step - first) % scene.render.steps_per_frame == 0 || step == last);
}

Result<Scene> withDefaults(Scene scene, const Bounds& bounds) {
    for (int i = 0; i < 3; ++i) {
        if (!(bounds.min[i] >= -kLengthMax && bounds.min[i] <= bounds.max[i] &&
              bounds.max[i] <= kLengthMax)) {
            return invalidInput("the collider's bounds are empty, or reach beyond " + numberText(kLengthMax) +
                                "; scale the mesh and bake it again");
        }
    }
    // If the collider has no extent, the scene still has a size that floats can resolve at its position.
    const glm::vec3 center = bounds.center();
    const float away = std::max({std::abs(center.x), std::abs(center.y), std::abs(center.z)});
    const float scale = std::max({bounds.longestSide(), 1e-3F * away, 1e-6F});
    const double run = static_cast<double>(scene.time.dt) *
                       (static_cast<double>(scene.time.steps) + static_cast<double>(prewarmSteps(scene)));
    for (std::size_t i = 0; i < scene.types.size(); ++i) {
        SceneType& type = scene.types[i];
        // Without a world, the reader has already checked this.
        const std::uint32_t absent = type.collides_with & ~(bodiesOf(scene) | kCollidesWithGround);
        if (!scene.world.empty() && type.collides_with != kCollidesWithAll && absent != 0) {
            return invalidInput(
                nth("type", i, ".collides_with") +
                " names a body that does not exist; the number of bodies, including the world's, is " +
                std::to_string(numbered(scene)) + "; the first is 0");
        }
        type.collides_with &= bodiesOf(scene);
    }
    RELIEF_TRY(completeEmitters(scene.emitters, bounds, scale, run, scene.particles.capacity));
    if (!scene.forces.gravity) {
        scene.forces.gravity = glm::vec3(0.0F, -3.0F * scale, 0.0F);
    }
    if (scene.ground.enabled && !scene.ground.height) {
        scene.ground.height = bounds.min.y;
    }
    if (!scene.camera.target) {
        scene.camera.target = center + glm::vec3(0.0F, 0.04F * scale, 0.0F);
    }
    for (SceneCameraKey& key : scene.camera.keys) {
        key.target = key.target.value_or(*scene.camera.target);
        key.fov = key.fov.value_or(scene.camera.fov);
    }
    if (!scene.camera.eye && scene.camera.keys.empty()) {
        const float aspect = static_cast<float>(scene.render.width) / static_cast<float>(scene.render.height);
        scene.camera.eye =
            scene.world.empty() || !(bounds.longestSide() >= scale)
                ? defaultEye(*scene.camera.target, std::max(0.5F * glm::length(bounds.size()), 0.5F * scale),
                             scene.camera.fov)
                : levelEye(*scene.camera.target, bounds, scene.camera.fov, aspect);
    }
    const char* const problem =
        scene.camera.eye ? cameraFault(*scene.camera.eye, *scene.camera.target) : nullptr;
    if (problem != nullptr) {
        return invalidInput(std::string("camera.eye ") + problem);
    }
    if (!scene.render.point_size) {
        scene.render.point_size = 0.0065F * scale;
    }
    scene.render.first_frame = firstFrame(scene);
    scene.render.last_frame = lastFrame(scene);
    return scene;
}

Result<Scene> parseScene(std::string_view text, const std::filesystem::path& path,
                         const std::filesystem::path& root) {
    Scene scene;
    RELIEF_TRY(readTomlFile(text, {oneLine(path.native()), path.parent_path(), root, "scene"},
                            [&](const TomlValue& top) { readToml(top, scene); }));
    return scene;
}

Result<Scene> loadScene(const std::filesystem::path& path, const std::filesystem::path& root) {
    const auto bytes = RELIEF_TRY(readFile(path, kSceneBytesMax));
    return parseScene({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path, root);
}

}  // namespace relief
