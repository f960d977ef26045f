#include "runtime/player/report.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "formats/base/file_io.h"
#include "runtime/player/report_air.h"
#include "runtime/player/stage_json.h"
#include "runtime/tool/json_text.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

void addPlace(const SceneEmitter& emitter, Json& json) {
    static constexpr const char* kShapes[] = {"box", "sphere", "shell", "disc", "points"};
    json["shape"] = kShapes[static_cast<std::size_t>(emitter.shape)];
    switch (emitter.shape) {
        case EmitterShape::kBox:
            json["box_min"] = jsonVector(*emitter.box_min);
            json["box_max"] = jsonVector(*emitter.box_max);
            return;
        case EmitterShape::kPoints:
            json["points"] = emitter.points.native();
            return;
        case EmitterShape::kDisc:
            json["normal"] = jsonVector(emitter.normal);
            [[fallthrough]];
        case EmitterShape::kSphere:
        case EmitterShape::kShell:
            json["center"] = jsonVector(emitter.center);
            json["radius"] = jsonNumber(emitter.radius);
            return;
    }
}

void addPose(const Pose& pose, Json& json) {
    json["position"] = jsonVector(pose.position);
    const glm::vec3 axis = glm::axis(pose.rotation);
    json["axis"] = jsonVector(axis);
    json["angle"] = jsonNumber(glm::degrees(glm::angle(pose.rotation)));
}

Json keyJson(const PoseKey& key) {
    Json json{{"time", key.time}};
    addPose(key.pose, json);
    return json;
}

Json emitterSettings(const SceneEmitter& emitter) {
    Json json;
    addPlace(emitter, json);
    json["start"] = emitter.start;
    json["rate"] = *emitter.rate;
    json["duration"] = emitter.duration ? Json(*emitter.duration) : Json();
    json["burst"] = emitter.burst;
    if (emitter.burst_every > 0.0) {
        json["burst_every"] = emitter.burst_every;
    }
    if (emitter.aimed) {
        json["direction"] = emitter.direction ? jsonVector(*emitter.direction) : Json();
        json["cone"] = jsonNumber(emitter.cone);
        json["speed"] = {jsonNumber(*emitter.speed_min), jsonNumber(*emitter.speed_max)};
        if (emitter.speed_deviation > 0.0F) {
            json["speed"] = {{"mean", jsonNumber(*emitter.speed_min)},
                             {"deviation", jsonNumber(emitter.speed_deviation)}};
        }
    } else {
        json["velocity"] = jsonVector(*emitter.velocity);
    }
    json["velocity_spread"] = jsonVector(*emitter.velocity_spread);
    json["lifetime"] = {jsonNumber(emitter.lifetime_min), jsonNumber(emitter.lifetime_max)};
    json["type"] = emitter.type;
    json["seed"] = emitter.seed;
    json["spread"] = emitter.spread;
    if (emitter.attach) {
        json["attach"] = *emitter.attach;
    }
    for (const PoseKey& key : emitter.keys) {
        json["key"].push_back(keyJson(key));
    }
    if (emitter.moves()) {
        json["inherit"] = jsonNumber(emitter.inherit);
    }
    return json;
}

template <class T, class Value>
Json overAge(const AgeTrack<T>& track, const Value& value) {
    Json keys = Json::array();
    for (const AgeKey<T>& key : track) {
        Json one = Json::array({jsonNumber(key.age)});
        for (const Json& number : value(key.value)) {
            one.push_back(number);
        }
        keys.push_back(one);
    }
    return keys;
}

/// A look as its [[type]]; what it leaves open is left out, for it is [render]'s.
Json lookJson(const ParticleLook& look) {
    const auto number = [](float value) { return Json::array({jsonNumber(value)}); };
    Json json = Json::object();
    const auto add = [&](const char* key, const AgeTrack<float>& track) {
        if (!track.empty()) {
            json[key] = overAge(track, number);
        }
    };
    add("size", look.size);
    if (!look.color.empty()) {
        json["color"] = overAge(look.color, jsonVector);
    }
    add("opacity", look.opacity);
    add("rotation", look.rotation);
    json["turn"] = jsonNumber(look.turn);
    json["spin"] = jsonNumber(look.spin);
    json["stretch"] = jsonNumber(look.stretch);
    if (look.cell_first) {
        json["cell"] = {*look.cell_first, look.cell_last};
    }
    json["lit"] = look.lit;
    if (look.fade_in && look.fade_out) {
        json["fade"] = {jsonNumber(*look.fade_in), jsonNumber(*look.fade_out)};
    }
    return json;
}

Json collidesSettings(const ParticleType& type, const Scene& scene) {
    Json json = Json::array();
    for (std::size_t i = 0; i < scene.colliders.size(); ++i) {
        if ((type.collides >> i & 1U) != 0) {
            json.push_back(i);
        }
    }
    if (scene.ground.enabled && (type.collides & kCollidesWithGround) != 0) {
        json.push_back("ground");
    }
    return json;
}

Json physicsSettings(const ParticleType& type, const Scene& scene) {
    static constexpr const char* kOnCollision[] = {"bounce", "stop", "slide", "die"};
    return {{"gravity", jsonNumber(type.gravity)},
            {"mass", jsonNumber(type.mass)},
            {"radius", jsonNumber(type.radius)},
            {"restitution", jsonNumber(type.restitution)},
            {"friction", jsonNumber(type.friction)},
            {"friction_threshold", jsonNumber(type.friction_threshold)},
            {"on_collision", kOnCollision[static_cast<std::size_t>(type.on_collision)]},
            {"lifetime_loss", jsonNumber(type.lifetime_loss)},
            {"collides", collidesSettings(type, scene)}};
}

void addPictures(const Scene& scene, Json& json) {
    Json& render = json["render"];
    render["sprite"] = scene.render.sprite == Sprite::kQuad ? "quad" : "point";
    render["blend"] = scene.render.blend == Blend::kAdditive ? "additive" : "alpha";
    render["soft"] = jsonNumber(scene.render.soft);
    if (!scene.render.atlas.empty()) {
        render["atlas"] = scene.render.atlas.native();
        render["atlas_cells"] = {scene.render.atlas_columns, scene.render.atlas_rows};
    }
    if (!scene.render.mesh.empty()) {
        render["mesh"] = scene.render.mesh.native();
    }
    for (std::size_t i = 0; i < scene.render.looks.size(); ++i) {
        Json one = lookJson(scene.render.looks[i]);
        if (!scene.type_names[i].empty()) {
            one["name"] = scene.type_names[i];
        }
        one.update(physicsSettings(scene.types[i], scene));
        json["type"].push_back(one);
    }
    if (scene.camera.keys.empty()) {
        return;
    }
    Json& camera = json["camera"];
    camera.erase("eye");  // each key has its own
    camera["path"] = scene.camera.curve == CameraCurve::kSmooth ? "smooth" : "linear";
    for (const SceneCameraKey& key : scene.camera.keys) {
        camera["key"].push_back({{"time", key.time},
                                 {"eye", jsonVector(key.eye)},
                                 {"target", jsonVector(key.target.value_or(*scene.camera.target))},
                                 {"fov", jsonNumber(key.fov.value_or(scene.camera.fov))}});
    }
}

Json colliderSettings(const SceneCollider& collider) {
    Json json{{collider.live ? "mesh" : "file", collider.path.native()}};
    if (collider.live) {
        const Deformation& d = collider.live->deformation;
        constexpr const char* kKinds[] = {"bend", "twist", "wobble"};
        const float amplitude = d.kind == DeformKind::kWobble ? d.amplitude : glm::degrees(d.amplitude);
        json["deform"] = {{"kind", kKinds[static_cast<int>(d.kind)]},
                          {"amplitude", jsonNumber(amplitude)},
                          {"frequency", jsonNumber(d.frequency)}};
        json["resolution"] = collider.live->resolution;
    }
    if (!collider.posed) {
        return json;
    }
    addPose(collider.pose, json);
    json["scale"] = jsonNumber(collider.pose.scale);
    json["restitution"] = jsonNumber(collider.restitution);
    json["friction"] = jsonNumber(collider.friction);
    for (const PoseKey& key : collider.keys) {
        json["key"].push_back(keyJson(key));
    }
    return json;
}

Json spawnSettings(const SceneSpawn& spawn) {
    const SpawnSettings& s = spawn.settings;
    Json json{{"on", s.on == SpawnOn::kDeath ? "death" : "collision"},
              {"of", s.of ? Json(*s.of) : Json()},
              {"type", s.type},
              {"count", {s.count_min, s.count_max}},
              {"most", s.most},
              {"lifetime", {jsonNumber(s.lifetime_min), jsonNumber(s.lifetime_max)}},
              {"inherit", jsonNumber(s.inherit)},
              {"speed", {jsonNumber(s.speed_min), jsonNumber(s.speed_max)}},
              {"kick", jsonNumber(s.kick)},
              {"cone", jsonNumber(s.cone_degrees)},
              {"seed", spawn.seed}};
    if (s.on == SpawnOn::kCollision) {
        json["min_speed"] = jsonNumber(s.min_speed);
    }
    return json;
}

Json settings(const Scene& scene) {
    Json json;
    for (const SceneCollider& collider : scene.colliders) {
        json["collider"].push_back(colliderSettings(collider));
    }
    if (scene.colliders.size() == 1) {
        json["collider"] = colliderSettings(scene.colliders.front());
    }
    json["time"] = {{"dt", jsonNumber(scene.dt)},
                    {"steps", scene.steps},
                    {"prewarm", scene.prewarm},
                    {"integrator", scene.integrator == Integrator::kVerlet ? "verlet" : "euler"}};
    json["particles"] = {{"capacity", scene.capacity}};
    for (const SceneEmitter& emitter : scene.emitters) {
        json["emitter"].push_back(emitterSettings(emitter));
    }
    if (scene.emitters.size() == 1) {
        json["emitter"] = emitterSettings(scene.emitters.front());
    }
    for (const SceneSpawn& spawn : scene.spawns) {
        json["spawn"].push_back(spawnSettings(spawn));
    }
    json["forces"] = {{"gravity", jsonVector(*scene.forces.gravity)},
                      {"wind", jsonVector(scene.forces.wind)},
                      {"drag", jsonNumber(scene.forces.drag)}};
    json["collision"] = {{"restitution", jsonNumber(scene.collision.restitution)},
                         {"friction", jsonNumber(scene.collision.friction)},
                         {"friction_threshold", jsonNumber(scene.collision.friction_threshold)},
                         {"sweep", jsonNumber(scene.sweep)}};
    json["ground"]["enabled"] = scene.ground.enabled;
    if (scene.ground.enabled) {
        json["ground"]["height"] = jsonNumber(*scene.ground.height);
    }
    json["camera"] = {{"eye", jsonVector(*scene.camera.eye)},
                      {"target", jsonVector(*scene.camera.target)},
                      {"fov", jsonNumber(scene.camera.fov)}};
    json["render"] = {{"size", {scene.render.width, scene.render.height}},
                      {"point_size", jsonNumber(*scene.render.point_size)},
                      {"color", jsonVector(scene.render.color)},
                      {"opacity", jsonNumber(scene.render.opacity)},
                      {"background", jsonVector(scene.render.background)},
                      {"every", scene.render.every},
                      {"first", firstFrame(scene)},
                      {"last", lastFrame(scene)},
                      {"sort_frames", scene.render.sort_frames}};
    addAirSettings(scene, json);
    addPictures(scene, json);
    return json;
}

const char* pathName(StepPath path) {
    return path == StepPath::kCompute ? "compute" : "fragment";
}

}  // namespace

std::string reportJson(const PlayerReport& report) {
    Json json;
    json["settings"] = settings(report.scene);
    json["device"] = report.device;
    json["path"] = pathName(report.path);
    json["collider"] = {{"maps", report.collider_maps}, {"gpu_bytes", report.collider_bytes}};
    json["particles"] = {{"alive", report.counts.alive},
                         {"born", report.counts.born},
                         {"died", report.counts.died},
                         {"refused", report.counts.refused}};
    json["particles"]["in_contact"] = report.in_contact ? Json(*report.in_contact) : Json();
    json["particles"]["collisions"] = report.collisions ? Json(*report.collisions) : Json();
    json["steps"] = report.scene.steps;
    json["ms_per_step"] = report.ms_per_step;
    json["ms_per_step_median"] = report.ms_per_step_median;
    json["ms_per_stage"] = report.stage_times ? stageJson(*report.stage_times) : Json();
    json["frames"] = report.frames_written;
    json["dumps"] = report.dumps_written;
    json["warnings"] = report.warnings;
    // A file name that is no UTF-8 must not end the program.
    return jsonText(json);
}

std::string reportText(const PlayerReport& report) {
    char text[256];
    std::snprintf(text, sizeof(text),
                  "%u steps, %.2f ms each; %llu born, %llu died, %u alive, %llu found no room; %u frames\n",
                  report.scene.steps, report.ms_per_step, static_cast<unsigned long long>(report.counts.born),
                  static_cast<unsigned long long>(report.counts.died), report.counts.alive,
                  static_cast<unsigned long long>(report.counts.refused), report.frames_written);
    return report.device + ", " + pathName(report.path) + " path\n" + text;
}

}  // namespace relief
