#include "runtime/player/report.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "formats/base/file_io.h"
#include "runtime/player/report_air.h"
#include "runtime/player/report_number.h"
#include "runtime/player/stage_json.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

Json shortestJson(float value) {
    char text[32];
    for (int digits = 6; digits <= 9; ++digits) {
        std::snprintf(text, sizeof(text), "%.*g", digits, static_cast<double>(value));
        if (std::strtof(text, nullptr) == value) {
            break;
        }
    }
    return std::strtod(text, nullptr);
}

Json triple(const glm::vec3& v) {
    return Json::array({shortestJson(v.x), shortestJson(v.y), shortestJson(v.z)});
}

namespace {

void addPlace(const SceneEmitter& emitter, Json& json) {
    static constexpr const char* kShapes[] = {"box", "sphere", "shell", "disc", "points"};
    json["shape"] = kShapes[static_cast<std::size_t>(emitter.shape)];
    switch (emitter.shape) {
        case EmitterShape::kBox:
            json["box_min"] = triple(*emitter.box_min);
            json["box_max"] = triple(*emitter.box_max);
            return;
        case EmitterShape::kPoints:
            json["points"] = emitter.points.native();
            return;
        case EmitterShape::kDisc:
            json["normal"] = triple(emitter.normal);
            [[fallthrough]];
        case EmitterShape::kSphere:
        case EmitterShape::kShell:
            json["center"] = triple(emitter.center);
            json["radius"] = shortestJson(emitter.radius);
            return;
    }
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
        json["direction"] = emitter.direction ? triple(*emitter.direction) : Json();
        json["cone"] = shortestJson(emitter.cone);
        json["speed"] = {shortestJson(*emitter.speed_min), shortestJson(*emitter.speed_max)};
        if (emitter.speed_deviation > 0.0F) {
            json["speed"] = {{"mean", shortestJson(*emitter.speed_min)},
                             {"deviation", shortestJson(emitter.speed_deviation)}};
        }
    } else {
        json["velocity"] = triple(*emitter.velocity);
    }
    json["velocity_spread"] = triple(*emitter.velocity_spread);
    json["lifetime"] = {shortestJson(emitter.lifetime_min), shortestJson(emitter.lifetime_max)};
    json["type"] = emitter.type;
    json["seed"] = emitter.seed;
    json["spread"] = emitter.spread;
    return json;
}

template <class T, class Value>
Json overAge(const AgeTrack<T>& track, const Value& value) {
    Json keys = Json::array();
    for (const AgeKey<T>& key : track) {
        Json one = Json::array({shortestJson(key.age)});
        for (const Json& number : value(key.value)) {
            one.push_back(number);
        }
        keys.push_back(one);
    }
    return keys;
}

/// A look as its [[type]]; what it leaves open is left out, for it is [render]'s.
Json lookJson(const ParticleLook& look) {
    const auto number = [](float value) { return Json::array({shortestJson(value)}); };
    Json json = Json::object();
    const auto add = [&](const char* key, const AgeTrack<float>& track) {
        if (!track.empty()) {
            json[key] = overAge(track, number);
        }
    };
    add("size", look.size);
    if (!look.color.empty()) {
        json["color"] = overAge(look.color, triple);
    }
    add("opacity", look.opacity);
    add("rotation", look.rotation);
    json["turn"] = shortestJson(look.turn);
    json["spin"] = shortestJson(look.spin);
    if (look.cell_first) {
        json["cell"] = {*look.cell_first, look.cell_last};
    }
    json["lit"] = look.lit;
    if (look.fade_in && look.fade_out) {
        json["fade"] = {shortestJson(*look.fade_in), shortestJson(*look.fade_out)};
    }
    return json;
}

Json physicsSettings(const ParticleType& type) {
    static constexpr const char* kOnCollision[] = {"bounce", "stop", "slide", "die"};
    return {{"mass", shortestJson(type.mass)},
            {"radius", shortestJson(type.radius)},
            {"restitution", shortestJson(type.restitution)},
            {"friction", shortestJson(type.friction)},
            {"friction_threshold", shortestJson(type.friction_threshold)},
            {"on_collision", kOnCollision[static_cast<std::size_t>(type.on_collision)]},
            {"lifetime_loss", shortestJson(type.lifetime_loss)}};
}

void addPictures(const Scene& scene, Json& json) {
    Json& render = json["render"];
    render["sprite"] = scene.render.sprite == Sprite::kQuad ? "quad" : "point";
    render["blend"] = scene.render.blend == Blend::kAdditive ? "additive" : "alpha";
    render["soft"] = shortestJson(scene.render.soft);
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
        one.update(physicsSettings(scene.types[i]));
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
                                 {"eye", triple(key.eye)},
                                 {"target", triple(key.target.value_or(*scene.camera.target))},
                                 {"fov", shortestJson(key.fov.value_or(scene.camera.fov))}});
    }
}

void addPose(const Pose& pose, Json& json) {
    json["position"] = triple(pose.position);
    const glm::vec3 axis = glm::axis(pose.rotation);
    json["axis"] = triple(axis);
    json["angle"] = shortestJson(glm::degrees(glm::angle(pose.rotation)));
}

Json colliderSettings(const SceneCollider& collider) {
    Json json{{collider.live ? "mesh" : "file", collider.path.native()}};
    if (collider.live) {
        const Deformation& d = collider.live->deformation;
        constexpr const char* kKinds[] = {"bend", "twist", "wobble"};
        const float amplitude = d.kind == DeformKind::kWobble ? d.amplitude : glm::degrees(d.amplitude);
        json["deform"] = {{"kind", kKinds[static_cast<int>(d.kind)]},
                          {"amplitude", shortestJson(amplitude)},
                          {"frequency", shortestJson(d.frequency)}};
        json["resolution"] = collider.live->resolution;
    }
    if (!collider.posed) {
        return json;
    }
    addPose(collider.pose, json);
    json["scale"] = shortestJson(collider.pose.scale);
    json["restitution"] = shortestJson(collider.restitution);
    json["friction"] = shortestJson(collider.friction);
    for (const SceneColliderKey& key : collider.keys) {
        Json one{{"time", key.time}};
        addPose(key.pose, one);
        json["key"].push_back(one);
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
    json["time"] = {{"dt", shortestJson(scene.dt)},
                    {"steps", scene.steps},
                    {"integrator", scene.integrator == Integrator::kVerlet ? "verlet" : "euler"}};
    json["particles"] = {{"capacity", scene.capacity}};
    for (const SceneEmitter& emitter : scene.emitters) {
        json["emitter"].push_back(emitterSettings(emitter));
    }
    if (scene.emitters.size() == 1) {
        json["emitter"] = emitterSettings(scene.emitters.front());
    }
    json["forces"] = {{"gravity", triple(*scene.forces.gravity)},
                      {"wind", triple(scene.forces.wind)},
                      {"drag", shortestJson(scene.forces.drag)}};
    json["collision"] = {{"restitution", shortestJson(scene.collision.restitution)},
                         {"friction", shortestJson(scene.collision.friction)},
                         {"friction_threshold", shortestJson(scene.collision.friction_threshold)},
                         {"sweep", shortestJson(scene.sweep)}};
    json["ground"]["enabled"] = scene.ground.enabled;
    if (scene.ground.enabled) {
        json["ground"]["height"] = shortestJson(*scene.ground.height);
    }
    json["camera"] = {{"eye", triple(*scene.camera.eye)},
                      {"target", triple(*scene.camera.target)},
                      {"fov", shortestJson(scene.camera.fov)}};
    json["render"] = {{"size", {scene.render.width, scene.render.height}},
                      {"point_size", shortestJson(*scene.render.point_size)},
                      {"color", triple(scene.render.color)},
                      {"opacity", shortestJson(scene.render.opacity)},
                      {"background", triple(scene.render.background)},
                      {"every", scene.render.every},
                      {"sort_frames", scene.render.sort_frames}};
    addAirSettings(scene, json);
    addPictures(scene, json);
    return json;
}

}  // namespace

std::string reportJson(const PlayerReport& report) {
    Json json;
    json["settings"] = settings(report.scene);
    json["device"] = report.device;
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
    // A file name that is no UTF-8 must not end the program.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string reportText(const PlayerReport& report) {
    char text[256];
    std::snprintf(text, sizeof(text),
                  "%u steps, %.2f ms each; %llu born, %llu died, %u alive, %llu found no room; %u frames\n",
                  report.scene.steps, report.ms_per_step, static_cast<unsigned long long>(report.counts.born),
                  static_cast<unsigned long long>(report.counts.died), report.counts.alive,
                  static_cast<unsigned long long>(report.counts.refused), report.frames_written);
    return report.device + "\n" + text;
}

}  // namespace relief
