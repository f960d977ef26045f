#include "runtime/player/report_air.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "runtime/player/report_number.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

Json flowSettings(const FlowFile& flow) {
    constexpr const char* kSources[] = {"file", "files", "raw"};  // as in FlowFileKind
    Json json;
    json[kSources[static_cast<std::size_t>(flow.kind)]] = flow.path.native();
    if (flow.kind == FlowFileKind::kRaw) {
        json["size"] = flow.size;
        json["components"] = flow.components;
    }
    json["box_min"] = triple(flow.box_min);
    json["box_max"] = triple(flow.box_max);
    json["outside"] = flow.outside == FlowOutside::kEdge ? "edge" : "zero";
    json["gain"] = shortestJson(flow.gain);
    return json;
}

}  // namespace

void addAirSettings(const Scene& scene, Json& settings) {
    const AirSettings& air = scene.air;
    if (air.viscosity) {
        settings["forces"].erase("drag");  // the viscosity takes its place
        settings["forces"]["viscosity"] = shortestJson(*air.viscosity);
    }
    for (const Attractor& one : air.attractors) {
        Json json = {{"position", triple(one.position)},
                     {"strength", shortestJson(one.strength)},
                     {"radius", shortestJson(one.radius)},
                     {"falloff", one.falloff}};
        if (one.reach < std::numeric_limits<float>::max()) {
            json["reach"] = shortestJson(one.reach);
        }
        settings["attractor"].push_back(std::move(json));
    }
    for (const Vortex& one : air.vortices) {
        settings["vortex"].push_back({{"center", triple(one.center)},
                                      {"axis", triple(one.axis)},
                                      {"strength", shortestJson(one.strength)},
                                      {"radius", shortestJson(one.radius)},
                                      {"falloff", one.falloff}});
    }
    if (scene.flow) {
        settings["flow"] = flowSettings(*scene.flow);
    }
    if (air.curl_noise) {
        settings["curl_noise"] = {{"amplitude", shortestJson(air.curl_noise->amplitude)},
                                  {"scale", shortestJson(air.curl_noise->scale)},
                                  {"octaves", air.curl_noise->octaves},
                                  {"drift", shortestJson(air.curl_noise->drift)},
                                  {"seed", air.curl_noise->seed}};
    }
}

}  // namespace relief
