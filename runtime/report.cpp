#include "runtime/report.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "formats/file_io.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

/// A float as the shortest decimal that reads back as it, rather than as the double beside it.
Json shortest(float value) {
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
    return Json::array({shortest(v.x), shortest(v.y), shortest(v.z)});
}

template <class T, class Value>
Json overAge(const AgeTrack<T>& track, const Value& value) {
    Json keys = Json::array();
    for (const AgeKey<T>& key : track) {
        Json one = Json::array({shortest(key.age)});
        for (const Json& number : value(key.value)) {
            one.push_back(number);
        }
        keys.push_back(one);
    }
    return keys;
}

/// A look as its [[type]]; what it leaves open is left out, for it is [render]'s.
Json lookJson(const ParticleLook& look) {
    const auto number = [](float value) { return Json::array({shortest(value)}); };
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
    json["turn"] = shortest(look.turn);
    json["spin"] = shortest(look.spin);
    if (look.cell_first) {
        json["cell"] = {*look.cell_first, look.cell_last};
    }
    json["lit"] = look.lit;
    if (look.fade_in && look.fade_out) {
        json["fade"] = {shortest(*look.fade_in), shortest(*look.fade_out)};
    }
    return json;
}

void addPictures(const Scene& scene, Json& json) {
    Json& render = json["render"];
    render["sprite"] = scene.render.sprite == Sprite::kQuad ? "quad" : "point";
    render["blend"] = scene.render.blend == Blend::kAdditive ? "additive" : "alpha";
    render["soft"] = shortest(scene.render.soft);
    if (!scene.render.atlas.empty()) {
        render["atlas"] = scene.render.atlas.native();
        render["atlas_cells"] = {scene.render.atlas_columns, scene.render.atlas_rows};
    }
    if (!scene.render.mesh.empty()) {
        render["mesh"] = scene.render.mesh.native();
    }
    for (const ParticleLook& look : scene.render.looks) {
        json["type"].push_back(lookJson(look));
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
                                 {"fov", shortest(key.fov.value_or(scene.camera.fov))}});
    }
}

Json settings(const Scene& scene) {
    Json json;
    json["collider"]["file"] = scene.collider.native();
    json["time"] = {{"dt", shortest(scene.dt)}, {"steps", scene.steps}};
    json["particles"] = {{"capacity", scene.capacity}};
    json["emitter"] = {
        {"box_min", triple(*scene.emitter.box_min)},
        {"box_max", triple(*scene.emitter.box_max)},
        {"rate", *scene.emitter.rate},
        {"duration", scene.emitter.duration ? Json(*scene.emitter.duration) : Json()},
        {"burst", scene.emitter.burst},
        {"velocity", triple(*scene.emitter.velocity)},
        {"velocity_spread", triple(*scene.emitter.velocity_spread)},
        {"lifetime", {shortest(scene.emitter.lifetime_min), shortest(scene.emitter.lifetime_max)}},
        {"seed", scene.emitter.seed}};
    json["forces"] = {{"gravity", triple(*scene.forces.gravity)},
                      {"wind", triple(scene.forces.wind)},
                      {"drag", shortest(scene.forces.drag)}};
    json["collision"] = {{"restitution", shortest(scene.collision.restitution)},
                         {"friction", shortest(scene.collision.friction)},
                         {"friction_threshold", shortest(scene.collision.friction_threshold)}};
    json["ground"]["enabled"] = scene.ground.enabled;
    if (scene.ground.enabled) {
        json["ground"]["height"] = shortest(*scene.ground.height);
    }
    json["camera"] = {{"eye", triple(*scene.camera.eye)},
                      {"target", triple(*scene.camera.target)},
                      {"fov", shortest(scene.camera.fov)}};
    json["render"] = {{"size", {scene.render.width, scene.render.height}},
                      {"point_size", shortest(*scene.render.point_size)},
                      {"color", triple(scene.render.color)},
                      {"opacity", shortest(scene.render.opacity)},
                      {"background", triple(scene.render.background)},
                      {"every", scene.render.every}};
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
    json["frames"] = report.frames_written;
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
