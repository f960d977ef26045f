#include "runtime/player/report_air.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "runtime/tool/json_text.h"

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
    json["box_min"] = jsonVector(flow.box_min);
    json["box_max"] = jsonVector(flow.box_max);
    json["outside"] = flow.outside == FlowOutside::kEdge ? "edge" : "zero";
    json["gain"] = jsonNumber(flow.gain);
    return json;
}

}  // namespace

void addAirSettings(const Scene& scene, Json& settings) {
    const AirSettings& air = scene.air;
    if (air.viscosity) {
        settings["forces"].erase("drag");  // the viscosity takes its place
        settings["forces"]["viscosity"] = jsonNumber(*air.viscosity);
    }
    for (const Attractor& one : air.attractors) {
        Json json = {{"position", jsonVector(one.position)},
                     {"strength", jsonNumber(one.strength)},
                     {"radius", jsonNumber(one.radius)},
                     {"falloff", one.falloff}};
        if (one.reach < std::numeric_limits<float>::max()) {
            json["reach"] = jsonNumber(one.reach);
        }
        settings["attractor"].push_back(std::move(json));
    }
    for (const Vortex& one : air.vortices) {
        settings["vortex"].push_back({{"center", jsonVector(one.center)},
                                      {"axis", jsonVector(one.axis)},
                                      {"strength", jsonNumber(one.strength)},
                                      {"radius", jsonNumber(one.radius)},
                                      {"falloff", one.falloff}});
    }
    if (scene.flow) {
        settings["flow"] = flowSettings(*scene.flow);
    }
    if (air.curl_noise) {
        settings["curl_noise"] = {{"amplitude", jsonNumber(air.curl_noise->amplitude)},
                                  {"scale", jsonNumber(air.curl_noise->scale)},
                                  {"octaves", air.curl_noise->octaves},
                                  {"drift", jsonNumber(air.curl_noise->drift)},
                                  {"seed", air.curl_noise->seed}};
    }
}

}  // namespace relief
