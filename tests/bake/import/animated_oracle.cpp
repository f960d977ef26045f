#include "tests/bake/import/animated_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <glm/glm.hpp>
#include <iterator>
#include <map>

namespace relief::test {
namespace {

using Json = nlohmann::json;

std::string contentsOf(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string base64Decoded(const std::string& text) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text.substr(0, text.find('='))) {
        bits = bits << 6U | static_cast<std::uint32_t>(digits.find(c));
        count += 6;
        if (count >= 8) {
            count -= 8;
            out += static_cast<char>(bits >> static_cast<unsigned>(count) & 255U);
        }
    }
    return out;
}

std::uint32_t wordAt(const std::string& text, std::size_t at) {
    std::uint32_t word = 0;
    std::memcpy(&word, text.data() + at, 4);
    return word;
}

std::size_t componentsOf(const std::string& type) {
    const std::map<std::string, std::size_t> counts = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    return counts.at(type);
}

double componentAt(const std::string& bytes, std::size_t at, int type, bool normalized) {
    const auto load = [&](auto value) {
        std::memcpy(&value, bytes.data() + at, sizeof(value));
        return static_cast<double>(value);
    };
    switch (type) {
        case 5120:
            return normalized ? std::max(load(std::int8_t{}) / 127.0, -1.0) : load(std::int8_t{});
        case 5121:
            return normalized ? load(std::uint8_t{}) / 255.0 : load(std::uint8_t{});
        case 5122:
            return normalized ? std::max(load(std::int16_t{}) / 32767.0, -1.0) : load(std::int16_t{});
        case 5123:
            return normalized ? load(std::uint16_t{}) / 65535.0 : load(std::uint16_t{});
        case 5125:
            return load(std::uint32_t{});
        default:
            return load(0.0F);
    }
}

glm::dvec4 unit(const glm::dvec4& q) {
    return q / std::sqrt(glm::dot(q, q));
}

glm::dmat4 matrixOf(const std::vector<double>& t, const std::vector<double>& q,
                    const std::vector<double>& s) {
    const glm::dvec4 u = unit({q[0], q[1], q[2], q[3]});
    const double x = u.x;
    const double y = u.y;
    const double z = u.z;
    const double w = u.w;
    glm::dmat4 m(1.0);
    m[0] = glm::dvec4(1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0) * s[0];
    m[1] = glm::dvec4(2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0) * s[1];
    m[2] = glm::dvec4(2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0) * s[2];
    m[3] = glm::dvec4(t[0], t[1], t[2], 1);
    return m;
}

glm::dmat4 matrixOf(const double* m) {
    glm::dmat4 matrix;
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            matrix[column][row] = m[4 * column + row];
        }
    }
    return matrix;
}

/// Appendix C of the specification.
std::vector<double> valueAt(const std::vector<double>& times, const std::vector<double>& values,
                            const std::string& curve, bool rotation, double seconds) {
    const bool cubic = curve == "CUBICSPLINE";
    const std::size_t n = values.size() / times.size() / (cubic ? 3 : 1);
    const auto value = [&](std::size_t key, std::size_t part) {
        const std::size_t at = (cubic ? 3 * key + part : key) * n;
        return std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(at),
                                   values.begin() + static_cast<std::ptrdiff_t>(at + n));
    };
    if (seconds <= times.front()) {
        return value(0, 1);
    }
    if (seconds >= times.back()) {
        return value(times.size() - 1, 1);
    }
    std::size_t key = 0;
    while (times[key + 1] <= seconds) {
        ++key;
    }
    const double length = times[key + 1] - times[key];
    const double t = (seconds - times[key]) / length;
    std::vector<double> a = value(key, 1);
    std::vector<double> b = value(key + 1, 1);
    std::vector<double> out = a;
    if (curve == "STEP") {
        return a;
    }
    if (cubic) {
        const std::vector<double> leaves = value(key, 2);
        const std::vector<double> arrives = value(key + 1, 0);
        for (std::size_t i = 0; i < n; ++i) {
            out[i] = (2 * std::pow(t, 3) - 3 * t * t + 1) * a[i] +
                     length * (std::pow(t, 3) - 2 * t * t + t) * leaves[i] +
                     (-2 * std::pow(t, 3) + 3 * t * t) * b[i] +
                     length * (std::pow(t, 3) - t * t) * arrives[i];
        }
        return out;
    }
    double from = 1 - t;
    double to = t;
    if (rotation) {
        const glm::dvec4 p = unit({a[0], a[1], a[2], a[3]});
        const glm::dvec4 q = unit({b[0], b[1], b[2], b[3]});
        const double angle = std::acos(std::min(1.0, std::abs(glm::dot(p, q))));
        if (angle > 1e-6) {
            from = std::sin((1 - t) * angle) / std::sin(angle);
            to = std::sin(t * angle) / std::sin(angle);
        }
        to = glm::dot(p, q) < 0 ? -to : to;
        for (int i = 0; i < 4; ++i) {
            out[static_cast<std::size_t>(i)] = from * p[i] + to * q[i];
        }
        return out;
    }
    for (std::size_t i = 0; i < n; ++i) {
        out[i] = from * a[i] + to * b[i];
    }
    return out;
}

}  // namespace

GltfPoser::GltfPoser(const std::filesystem::path& path) {
    std::string text = contentsOf(path);
    std::string binary;
    if (text.starts_with("glTF")) {
        const std::size_t json = wordAt(text, 12);
        if (text.size() > 28 + json) {
            binary = text.substr(28 + json, wordAt(text, 20 + json));
        }
        text = text.substr(20, json);
    }
    document_ = Json::parse(text);
    for (const Json& buffer : document_.value("buffers", Json::array())) {
        const std::string uri = buffer.value("uri", "");
        buffers_.push_back(uri.empty()                ? binary
                           : uri.starts_with("data:") ? base64Decoded(uri.substr(uri.find(',') + 1))
                                                      : contentsOf(path.parent_path() / uri));
    }
}

std::size_t GltfPoser::animations() const {
    return document_.value("animations", Json::array()).size();
}

double GltfPoser::seconds(std::size_t animation) const {
    double last = 0.0;
    const Json& from = document_.at("animations").at(animation);
    for (const Json& channel : from.at("channels")) {
        last = std::max(
            last,
            accessor(from.at("samplers").at(channel.at("sampler").get<std::size_t>()).at("input")).back());
    }
    return last;
}

std::vector<double> GltfPoser::accessor(std::size_t index) const {
    const Json& from = document_.at("accessors").at(index);
    const std::size_t n = componentsOf(from.at("type"));
    const std::size_t count = from.at("count");
    std::vector<double> values(n * count, 0.0);
    if (from.contains("bufferView")) {
        const Json& view = document_.at("bufferViews").at(from.at("bufferView").get<std::size_t>());
        const int type = from.at("componentType");
        const std::size_t size = type <= 5121 ? 1 : type <= 5123 ? 2 : 4;
        const std::size_t stride = view.value("byteStride", n * size);
        const std::size_t first =
            view.value("byteOffset", std::size_t{0}) + from.value("byteOffset", std::size_t{0});
        for (std::size_t i = 0; i < values.size(); ++i) {
            values[i] =
                componentAt(buffers_.at(view.at("buffer").get<std::size_t>()),
                            first + i / n * stride + i % n * size, type, from.value("normalized", false));
        }
    }
    return values;
}

std::vector<glm::dvec3> GltfPoser::corners(std::optional<std::size_t> animation, double seconds) const {
    Json nodes = document_.at("nodes");
    if (animation) {
        const Json& from = document_.at("animations").at(*animation);
        for (const Json& channel : from.at("channels")) {
            const Json& sampler = from.at("samplers").at(channel.at("sampler").get<std::size_t>());
            const std::string path = channel.at("target").at("path");
            nodes.at(channel.at("target").at("node").get<std::size_t>())[path] =
                valueAt(accessor(sampler.at("input")), accessor(sampler.at("output")),
                        sampler.value("interpolation", "LINEAR"), path == "rotation", seconds);
        }
    }
    const auto local = [&](std::size_t index) {
        const Json& node = nodes.at(index);
        return node.contains("matrix") ? matrixOf(node.at("matrix").get<std::vector<double>>().data())
                                       : matrixOf(node.value("translation", std::vector<double>{0, 0, 0}),
                                                  node.value("rotation", std::vector<double>{0, 0, 0, 1}),
                                                  node.value("scale", std::vector<double>{1, 1, 1}));
    };
    std::vector<std::ptrdiff_t> parents(nodes.size(), -1);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (const std::size_t child : nodes[i].value("children", std::vector<std::size_t>())) {
            parents.at(child) = static_cast<std::ptrdiff_t>(i);
        }
    }
    const auto global = [&](std::size_t index) {
        glm::dmat4 matrix = local(index);
        for (std::ptrdiff_t above = parents[index]; above >= 0;
             above = parents[static_cast<std::size_t>(above)]) {
            matrix = local(static_cast<std::size_t>(above)) * matrix;
        }
        return matrix;
    };
    std::vector<glm::dvec3> out;
    const auto draw = [&](std::size_t index) {
        const Json& node = nodes.at(index);
        const Json& mesh = document_.at("meshes").at(node.at("mesh").get<std::size_t>());
        const std::vector<double> weights =
            node.value("weights", mesh.value("weights", std::vector<double>(1000, 0.0)));
        std::vector<glm::dmat4> joints;
        if (node.contains("skin")) {
            const Json& skin = document_.at("skins").at(node.at("skin").get<std::size_t>());
            const std::vector<std::size_t> of = skin.at("joints");
            const std::vector<double> binds = skin.contains("inverseBindMatrices")
                                                  ? accessor(skin.at("inverseBindMatrices"))
                                                  : std::vector<double>();
            for (std::size_t i = 0; i < of.size(); ++i) {
                joints.push_back(global(of[i]) *
                                 (binds.empty() ? glm::dmat4(1.0) : matrixOf(&binds[16 * i])));
            }
        }
        const glm::dmat4 own = global(index);
        for (const Json& primitive : mesh.at("primitives")) {
            const Json& attributes = primitive.at("attributes");
            std::vector<double> p = accessor(attributes.at("POSITION"));
            std::size_t target = 0;
            for (const Json& deltas : primitive.value("targets", Json::array())) {
                const std::vector<double> d = deltas.contains("POSITION") ? accessor(deltas.at("POSITION"))
                                                                          : std::vector<double>(p.size());
                for (std::size_t i = 0; i < p.size(); ++i) {
                    p[i] += weights.at(target) * d[i];
                }
                ++target;
            }
            const bool skinned = !joints.empty() && attributes.contains("JOINTS_0");
            const std::vector<double> by =
                skinned ? accessor(attributes.at("JOINTS_0")) : std::vector<double>();
            const std::vector<double> share =
                skinned ? accessor(attributes.at("WEIGHTS_0")) : std::vector<double>();
            std::vector<glm::dvec3> placed;
            for (std::size_t v = 0; v < p.size() / 3; ++v) {
                const glm::dvec4 at(p[3 * v], p[3 * v + 1], p[3 * v + 2], 1);
                glm::dvec4 sum = skinned || !joints.empty() ? glm::dvec4(0) : own * at;
                double all = 0;
                for (std::size_t k = 4 * v; skinned && k < 4 * v + 4; ++k) {
                    sum += share[k] * (joints.at(static_cast<std::size_t>(by[k])) * at);
                    all += share[k];
                }
                placed.emplace_back(skinned ? sum / all : joints.empty() ? sum : at);
            }
            if (primitive.contains("indices")) {
                for (const double corner : accessor(primitive.at("indices"))) {
                    out.push_back(placed.at(static_cast<std::size_t>(corner)));
                }
            } else {
                out.insert(out.end(), placed.begin(), placed.end());
            }
        }
    };
    const std::function<void(std::size_t)> visit = [&](std::size_t index) {
        if (nodes.at(index).contains("mesh")) {
            draw(index);
        }
        for (const std::size_t child : nodes[index].value("children", std::vector<std::size_t>())) {
            visit(child);
        }
    };
    for (const std::size_t root : document_.at("scenes")
                                      .at(document_.value("scene", std::size_t{0}))
                                      .at("nodes")
                                      .get<std::vector<std::size_t>>()) {
        visit(root);
    }
    return out;
}

}  // namespace relief::test
