// The scene's air and fields: [[attractor]], [[vortex]], [flow], [curl_noise] and forces.viscosity.
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "runtime/scene/scene_readers.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr double kViscosityMax = 1e6;
constexpr double kGainMax = 1e6;
constexpr SceneRange kAboveZero{0.0, kLengthMax, false};

/// Above zero in the file, above zero as a float.
bool length(SceneTable& table, std::string_view key, float& out) {
    const bool found = table.number(key, kAboveZero, out);
    out = std::max(out, std::numeric_limits<float>::min());
    return found;
}

[[noreturn]] void failMissing(const SceneTable& table, const toml::node& at, std::string_view key,
                              std::string_view cure) {
    table.failAt(at, table.full(key) + " is missing; " + std::string(cure));
}

/// The keys that attractors and vortices share.
void readStrength(SceneTable& table, const toml::node& at, float& strength, float& radius, int& falloff) {
    if (!table.number("strength", symmetric(kAccelerationMax), strength)) {
        failMissing(table, at, "strength", "give the acceleration at the radius");
    }
    if (strength == 0.0F) {
        table.failUseless("strength", "as 0; raise it or remove the table");
    }
    if (!length(table, "radius", radius)) {
        failMissing(table, at, "radius", "give the distance up to which the strength grows");
    }
    radius = std::max(radius, 1e-30F);  // the greatest strength over it stays a float
    table.integer("falloff", {0.0, 2.0}, falloff);
}

void readAttractors(SceneTable& top, std::string_view file, Scene& scene) {
    for (const toml::table* at : top.tables("attractor", AirSettings::kAttractorsMax)) {
        SceneTable table(at, "attractor", file);
        Attractor attractor;
        if (!table.vector("position", symmetric(kLengthMax), attractor.position)) {
            failMissing(table, *at, "position", "give a point [x, y, z]");
        }
        readStrength(table, *at, attractor.strength, attractor.radius, attractor.falloff);
        if (table.find("reach") != nullptr) {
            length(table, "reach", attractor.reach);
        }
        table.finish();
        scene.air.attractors.push_back(attractor);
    }
}

void readVortices(SceneTable& top, std::string_view file, Scene& scene) {
    for (const toml::table* at : top.tables("vortex", AirSettings::kVorticesMax)) {
        SceneTable table(at, "vortex", file);
        Vortex vortex;
        if (!table.vector("center", symmetric(kLengthMax), vortex.center)) {
            failMissing(table, *at, "center", "give a point [x, y, z] of its axis");
        }
        if (table.vector("axis", symmetric(kLengthMax), vortex.axis)) {
            // Tiny axes are as good as long ones, as long as a float can hold their squares.
            const float longest =
                std::max({std::abs(vortex.axis.x), std::abs(vortex.axis.y), std::abs(vortex.axis.z)});
            if (!(longest >= 1e-30F)) {
                table.failAt(*table.find("axis"), "vortex.axis has no direction; give one, as [0, 1, 0]");
            }
            vortex.axis = glm::normalize(vortex.axis / longest);
        }
        readStrength(table, *at, vortex.strength, vortex.radius, vortex.falloff);
        table.finish();
        scene.air.vortices.push_back(vortex);
    }
}

void readFlowBox(SceneTable& table, const toml::node& at, FlowFile& flow) {
    const bool low = table.vector("box_min", symmetric(kLengthMax), flow.box_min);
    const bool high = table.vector("box_max", symmetric(kLengthMax), flow.box_max);
    if (!low || !high) {
        failMissing(table, at, low ? "box_max" : "box_min", "say where the flow lies, in object units");
    }
    for (int i = 0; i < 3; ++i) {
        if (!(flow.box_min[i] < flow.box_max[i])) {
            table.failAt(*table.find("box_min"), "flow.box_min is not below flow.box_max on the " +
                                                     std::string(1, "xyz"[i]) + " axis; move one of them");
        }
    }
}

void readRawShape(SceneTable& table, const toml::node& at, FlowFile& flow) {
    const toml::node* size = table.find("size");
    const bool components = table.integer("components", {2.0, 3.0}, flow.components);
    if (flow.kind != FlowFileKind::kRaw) {
        if (size != nullptr || components) {
            table.failUseless(size != nullptr ? "size" : "components",
                              "without flow.raw: images have their own; remove it");
        }
        return;
    }
    if (size == nullptr) {
        failMissing(table, at, "size", "a raw volume does not say it: give [nx, ny, nz]");
    }
    const toml::array& sides = table.arrayOf(*size, "size", 3, "three whole numbers [nx, ny, nz]");
    for (std::size_t i = 0; i < 3; ++i) {
        flow.size[i] =
            static_cast<std::uint32_t>(table.integerOf(*sides.get(i), "size", {1.0, FlowField::kSideMax}));
    }
    if (auto checked = checkFlowSize({flow.size[0], flow.size[1], flow.size[2]}); !checked) {
        table.failAt(*size, "flow.size: " + checked.error().message);
    }
}

void readFlow(SceneTable table, const toml::node* at, const SceneFolder& folder, Scene& scene) {
    if (at == nullptr) {
        return;
    }
    FlowFile flow;
    std::string_view source;
    constexpr std::array<std::string_view, 3> kSources = {"file", "files", "raw"};  // as in FlowFileKind
    for (std::size_t i = 0; i < kSources.size(); ++i) {
        const toml::node* node = table.find(kSources[i]);
        if (node != nullptr && !source.empty()) {
            table.failAt(
                *node, table.full(kSources[i]) + " and " + table.full(source) + " are two flows; remove one");
        }
        if (table.path(kSources[i], folder, flow.path, flow.origin)) {
            source = kSources[i];
            flow.kind = static_cast<FlowFileKind>(i);
            flow.origin += ": " + table.full(source) + ": ";
        }
    }
    if (source.empty()) {
        failMissing(table, *at, "file",
                    "name one EXR image by file, numbered ones by files, or a raw volume by raw");
    }
    if (flow.kind == FlowFileKind::kSlices && !hasSliceNumber(flow.path.filename().native())) {
        table.failAt(*table.find("files"),
                     "flow.files needs one number, as in 'flow_%03d.exr', in its file name");
    }
    readRawShape(table, *at, flow);
    readFlowBox(table, *at, flow);
    table.word("outside", {"zero", "edge"}, flow.outside);
    if (table.number("gain", symmetric(kGainMax), flow.gain) && flow.gain == 0.0F) {
        table.failUseless("gain", "as 0: there is no flow then; raise it or remove [flow]");
    }
    table.finish();
    scene.flow = flow;
}

void readCurlNoise(SceneTable table, const toml::node* at, Scene& scene) {
    if (at == nullptr) {
        return;
    }
    CurlNoise noise;
    if (!table.number("amplitude", {0.0, kSpeedMax, false}, noise.amplitude)) {
        failMissing(table, *at, "amplitude", "give the mean speed of the turbulence");
    }
    if (!length(table, "scale", noise.scale)) {
        failMissing(table, *at, "scale", "give the size of the largest eddies");
    }
    noise.scale = std::max(noise.scale, 1e-9F);  // its reciprocal stays a float
    table.integer("octaves", {1.0, CurlNoise::kOctavesMax}, noise.octaves);
    if (table.number("drift", {0.0, kSpeedMax}, noise.drift) &&
        noise.drift / noise.scale > CurlNoise::kRateMax) {
        table.failAt(*table.find("drift"), "curl_noise.drift is more than " +
                                               numberText(CurlNoise::kRateMax) +
                                               " times curl_noise.scale a second; lower it");
    }
    table.integer("seed", {0.0, 4294967295.0}, noise.seed);
    table.finish();
    scene.air.curl_noise = noise;
}

}  // namespace

void nameAirTables(SceneTable& top) {
    for (const std::string_view name : {"attractor", "vortex", "flow", "curl_noise"}) {
        static_cast<void>(top.find(name));
    }
}

void readAir(SceneTable& top, const SceneFolder& folder, Scene& scene) {
    const toml::node* flow = top.find("flow");
    const toml::node* noise = top.find("curl_noise");
    readAttractors(top, top.file(), scene);
    readVortices(top, top.file(), scene);
    readFlow(top.sub("flow"), flow, folder, scene);
    readCurlNoise(top.sub("curl_noise"), noise, scene);
    scene.air.wind = scene.forces.wind;
    if (scene.air.viscosity == 0.0F && scene.air.wind != glm::vec3(0.0F)) {
        top.failAt(*top.find("forces")->as_table()->get("wind"),
                   "forces.wind does nothing while forces.viscosity is 0; raise it or remove the wind");
    }
    const bool drag = scene.air.viscosity ? *scene.air.viscosity > 0.0F : scene.forces.drag > 0.0F;
    for (const std::string_view name : {"flow", "curl_noise"}) {
        if (const toml::node* node = top.find(name); node != nullptr && !drag) {
            top.failAt(*node, std::string(name) +
                                  " does nothing without drag, which carries particles along; raise " +
                                  (scene.air.viscosity ? "forces.viscosity" : "forces.drag"));
        }
    }
}

void readViscosity(SceneTable& forces, Scene& scene) {
    if (forces.number("viscosity", {0.0, kViscosityMax}, scene.air.viscosity) &&
        forces.find("drag") != nullptr) {
        forces.failAt(*forces.find("viscosity"),
                      "forces.viscosity and forces.drag are two drags; remove one");
    }
}

}  // namespace relief
