// SPDX-License-Identifier: Apache-2.0
#include "tests/bake/import/animated_cases.h"

#include <array>
#include <cmath>
#include <map>

namespace relief::test {
namespace {

using Json = nlohmann::json;

const std::map<std::string, std::size_t> kComponents = {
    {"SCALAR", 1}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};

template <class T>
std::string bytesOfValues(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

}  // namespace

GltfBuilder::GltfBuilder()
    : json({{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", Json::array({{{"nodes", {0}}}})}}) {}

std::size_t GltfBuilder::accessor(const char* type, int component, std::size_t count, const std::string& data,
                                  bool normalized) {
    buffer_.resize((buffer_.size() + 3) / 4 * 4, '\0');
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", data.size()}});
    buffer_ += data;
    Json accessor = {{"bufferView", json["bufferViews"].size() - 1},
                     {"componentType", component},
                     {"type", type},
                     {"count", count / kComponents.at(type)}};
    if (normalized) {
        accessor["normalized"] = true;
    }
    json["accessors"].push_back(accessor);
    return json["accessors"].size() - 1;
}

std::size_t GltfBuilder::floats(const char* type, const std::vector<float>& values) {
    return accessor(type, 5126, values.size(), bytesOfValues(values), false);
}

std::size_t GltfBuilder::bytes(const char* type, const std::vector<int>& values, bool normalized) {
    return accessor(type, 5121, values.size(),
                    bytesOfValues(std::vector<std::uint8_t>(values.begin(), values.end())), normalized);
}

std::size_t GltfBuilder::shares(const char* type, const std::vector<double>& values) {
    std::vector<std::int16_t> quantised;
    for (const double value : values) {
        quantised.push_back(static_cast<std::int16_t>(std::lround(32767.0 * value)));
    }
    return accessor(type, 5122, values.size(), bytesOfValues(quantised), true);
}

std::size_t GltfBuilder::indices(const std::vector<int>& values) {
    return accessor("SCALAR", 5123, values.size(),
                    bytesOfValues(std::vector<std::uint16_t>(values.begin(), values.end())), false);
}

glm::vec3 boxCorner(const glm::vec3& low, const glm::vec3& high, int i) {
    return {i % 2 == 0 ? low.x : high.x, i / 2 % 2 == 0 ? low.y : high.y, i < 4 ? low.z : high.z};
}

std::size_t GltfBuilder::box(const glm::vec3& low, const glm::vec3& high) {
    std::vector<float> positions;
    for (int i = 0; i < 8; ++i) {
        const glm::vec3 corner = boxCorner(low, high, i);
        positions.insert(positions.end(), {corner.x, corner.y, corner.z});
    }
    const std::size_t position = floats("VEC3", positions);
    const std::size_t index = indices({0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                       2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5});
    json["meshes"].push_back(
        {{"primitives", Json::array({{{"attributes", {{"POSITION", position}}}, {"indices", index}}})}});
    return json["meshes"].size() - 1;
}

std::size_t GltfBuilder::animate(std::size_t node, const char* path, std::size_t times, std::size_t values,
                                 const char* curve, const char* name) {
    Json animation = {
        {"samplers", Json::array({{{"input", times}, {"output", values}, {"interpolation", curve}}})},
        {"channels", Json::array({{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}})}};
    if (name != nullptr) {
        animation["name"] = name;
    }
    json["animations"].push_back(animation);
    return json["animations"].size() - 1;
}

GltfCase GltfBuilder::file() const {
    GltfCase file{json, buffer_, GltfContainer::kBinary};
    file.document["buffers"] = Json::array({{{"byteLength", buffer_.size()}}});
    return file;
}

GltfBuilder bendingBar() {
    GltfBuilder out;
    std::vector<float> positions;
    std::vector<int> joints;
    std::vector<int> weights;
    for (std::size_t ring = 0; ring < 3; ++ring) {
        for (const auto& [x, z] : {std::pair(-0.5F, -0.5F), {0.5F, -0.5F}, {0.5F, 0.5F}, {-0.5F, 0.5F}}) {
            positions.insert(positions.end(), {x, static_cast<float>(ring), z});
            joints.insert(joints.end(), {0, 1, 0, 0});
            weights.insert(weights.end(),
                           {std::array{255, 128, 0}.at(ring), std::array{0, 128, 255}.at(ring), 0, 0});
        }
    }
    std::vector<int> corners = {0, 1, 2, 0, 2, 3, 8, 10, 9, 8, 11, 10};
    for (int ring = 0; ring < 2; ++ring) {
        for (int k = 0; k < 4; ++k) {
            const int a = 4 * ring + k;
            const int b = 4 * ring + (k + 1) % 4;
            corners.insert(corners.end(), {a, a + 4, b, b, a + 4, b + 4});
        }
    }
    const std::size_t position = out.floats("VEC3", positions);
    const std::size_t joint = out.bytes("VEC4", joints);
    const std::size_t weight = out.bytes("VEC4", weights, true);
    const std::size_t index = out.indices(corners);
    out.json["meshes"].push_back(
        {{"primitives",
          Json::array({{{"attributes", {{"POSITION", position}, {"JOINTS_0", joint}, {"WEIGHTS_0", weight}}},
                        {"indices", index}}})}});
    // The transform of the mesh's own node must not matter.
    out.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {7, 8, 9}}},
                         {{"name", "upper"}, {"translation", {0, 1, 0}}},
                         {{"name", "lower"}, {"children", {1}}}};
    out.json["scenes"][0]["nodes"] = {0, 2};
    const std::size_t binds = out.floats("MAT4", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                                                  1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1});
    out.json["skins"] = Json::array({{{"joints", {2, 1}}, {"inverseBindMatrices", binds}}});
    const std::size_t times = out.floats("SCALAR", {0, 1});
    const double half = std::sqrt(0.5);
    out.animate(1, "rotation", times, out.shares("VEC4", {0, 0, 0, 1, 0, 0, half, half}), "LINEAR", "bend");
    return out;
}

GltfBuilder robot() {
    GltfBuilder out;
    const std::size_t mesh = out.box({0, 0, 0}, {1, 2, 3});
    // Children precede their parents.
    out.json["nodes"] = {
        {{"name", "hand"}, {"mesh", mesh}, {"translation", {0, 2, 0}}, {"scale", {-1, 1, 1}}},
        {{"name", "arm"}, {"mesh", mesh}, {"translation", {1, 2, 0}}, {"children", {0}}},
        {{"name", "base"}, {"mesh", mesh}, {"children", {1}}}};
    out.json["scenes"][0]["nodes"] = {2};
    const std::size_t times = out.floats("SCALAR", {0.5F, 1.5F, 3.5F});
    out.animate(2, "translation", times, out.floats("VEC3", {0, 0, 0, 4, 0, 0, 4, 0, 8}), "LINEAR", "drive");
    const double half = std::sqrt(0.5);
    out.animate(1, "rotation", times, out.shares("VEC4", {0, 0, 0, 1, 0, 0, half, half, 0, 0, 1, 0}), "STEP",
                "turn");
    return out;
}

GltfBuilder morphingCube() {
    GltfBuilder out;
    const std::size_t mesh = out.box({-1, -1, -1}, {1, 1, 1});
    std::vector<float> deltas;
    for (int i = 0; i < 8; ++i) {
        deltas.insert(deltas.end(), {i % 2 == 0 ? 0.0F : 2.0F, 0, 0});
    }
    const std::size_t target = out.floats("VEC3", deltas);
    const std::size_t normals = out.floats("VEC3", std::vector<float>(24, 0.0F));
    out.json["meshes"][mesh]["primitives"][0]["targets"] = {{{"POSITION", target}}, {{"NORMAL", normals}}};
    out.json["meshes"][mesh]["weights"] = {1, 1};
    out.json["nodes"] = Json::array({{{"name", "cube"}, {"mesh", mesh}, {"weights", {0.5, 0}}}});
    const std::size_t times = out.floats("SCALAR", {0, 2});
    out.animate(0, "weights", times, out.bytes("SCALAR", {0, 255, 255, 0}, true), "LINEAR", "stretch");
    return out;
}

}  // namespace relief::test
