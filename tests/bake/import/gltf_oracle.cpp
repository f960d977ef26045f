// SPDX-License-Identifier: Apache-2.0
#include "tests/bake/import/gltf_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>

namespace relief::test {
namespace {

using Json = nlohmann::json;
using Placement = std::function<glm::dvec3(glm::dvec3)>;
using Numbers = std::vector<double>;

/// The purpose of an accessor. Each purpose allows different types.
enum class Use { kPositions, kIndices, kJoints, kWeights, kMatrices, kKeys };

void must(bool holds, const char* what) {
    if (!holds) {
        throw std::runtime_error(what);
    }
}

std::size_t whole(const Json& json) {
    must(json.is_number() && json.get<double>() >= 0 && json.get<double>() < 1e9 &&
             json.get<double>() == std::floor(json.get<double>()),
         "no whole number");
    return static_cast<std::size_t>(json.get<double>());
}

std::size_t whole(const Json& json, const char* name, std::size_t otherwise) {
    return json.contains(name) ? whole(json.at(name)) : otherwise;
}

const Json& list(const Json& json, const char* name) {
    static const Json kNone = Json::array();
    const Json& all = json.contains(name) ? json.at(name) : kNone;
    must(all.is_array(), "no array");
    return all;
}

const Json& element(const Json& json, const char* name, std::size_t index) {
    const Json& value = list(json, name).at(index);
    must(value.is_object(), "no object");
    return value;
}

Numbers numbers(const Json& json, const char* name, Numbers otherwise) {
    if (!json.contains(name)) {
        return otherwise;
    }
    const Json& all = list(json, name);
    must(all.size() == otherwise.size(), "another length");
    for (std::size_t i = 0; i < all.size(); ++i) {
        must(all[i].is_number(), "no number");
        otherwise[i] = all[i].get<double>();
    }
    return otherwise;
}

/// Appendix C of the specification.
Numbers valueAt(const Numbers& times, const Numbers& values, const std::string& curve, bool rotation,
                double seconds) {
    const bool cubic = curve == "CUBICSPLINE";
    const std::size_t n = values.size() / times.size() / (cubic ? 3 : 1);
    const auto value = [&](std::size_t key, std::size_t part) {
        const auto at = values.begin() + static_cast<std::ptrdiff_t>((cubic ? 3 * key + part : key) * n);
        return Numbers(at, at + static_cast<std::ptrdiff_t>(n));
    };
    if (seconds <= times.front() || seconds >= times.back()) {
        return value(seconds <= times.front() ? 0 : times.size() - 1, 1);
    }
    std::size_t key = 0;
    while (times[key + 1] <= seconds) {
        ++key;
    }
    const double length = times[key + 1] - times[key];
    const double t = (seconds - times[key]) / length;
    Numbers a = value(key, 1);
    Numbers b = value(key + 1, 1);
    if (curve == "STEP") {
        return a;
    }
    std::array<double, 2> shares = {1 - t, t};
    if (cubic) {
        shares = {2 * std::pow(t, 3) - 3 * t * t + 1, -2 * std::pow(t, 3) + 3 * t * t};
    } else if (rotation) {
        const glm::dvec4 p = glm::normalize(glm::dvec4(a[0], a[1], a[2], a[3]));
        const glm::dvec4 q = glm::normalize(glm::dvec4(b[0], b[1], b[2], b[3]));
        a = {p.x, p.y, p.z, p.w};
        b = {q.x, q.y, q.z, q.w};
        const double angle = std::acos(std::min(1.0, std::abs(glm::dot(p, q))));
        if (angle > 1e-6) {
            shares = {std::sin((1 - t) * angle) / std::sin(angle), std::sin(t * angle) / std::sin(angle)};
        }
        shares[1] *= glm::dot(p, q) < 0 ? -1 : 1;
    }
    const Numbers leaves = cubic ? value(key, 2) : Numbers(n);
    const Numbers arrives = cubic ? value(key + 1, 0) : Numbers(n);
    Numbers out(n);
    for (std::size_t i = 0; i < n; ++i) {
        out[i] = shares[0] * a[i] + shares[1] * b[i] + length * (std::pow(t, 3) - 2 * t * t + t) * leaves[i] +
                 length * (std::pow(t, 3) - t * t) * arrives[i];
    }
    return out;
}

class Book {
  public:
    explicit Book(const GltfCase& file) : document_(file.document), binary_(file.buffer) {
        binary_.resize(file.container == GltfContainer::kBinary ? (binary_.size() + 3) / 4 * 4
                                                                : binary_.size());
        must(document_.is_object(), "no document");
    }

    std::vector<Corners> read(const std::optional<GltfMoment>& moment) {
        const Json& asset = document_.at("asset");
        must(asset.at("version").get<std::string>().starts_with("2."), "version");
        must(!asset.contains("minVersion") || asset.at("minVersion") == "2.0", "minVersion");
        for (const Json& name : list(document_, "extensionsRequired")) {
            must(name == "KHR_mesh_quantization", "an extension");
        }
        if (moment) {
            const Json& animation = element(document_, "animations", moment->animation);
            for (const Json& channel : list(animation, "channels")) {
                const Json& sampler = element(animation, "samplers", whole(channel.at("sampler")));
                const Json& target = channel.at("target");
                const std::string path = target.at("path");
                const bool rotation = path == "rotation";
                Numbers value = valueAt(accessor(whole(sampler.at("input")), Use::kKeys),
                                        accessor(whole(sampler.at("output")), Use::kKeys),
                                        sampler.value("interpolation", "LINEAR"), rotation, moment->seconds);
                const double square = std::inner_product(value.begin(), value.end(), value.begin(), 0.0);
                for (double& part : value) {
                    part /= rotation ? std::sqrt(square) : 1.0;
                }
                document_["nodes"][whole(target.at("node"))][path] = value;
            }
        }
        countParents();
        const std::size_t scene = whole(document_, "scene", 0);
        std::set<std::size_t> roots;
        for (const Json& root : list(element(document_, "scenes", scene), "nodes")) {
            must(roots.insert(whole(root)).second && parents_.at(whole(root)) == 0, "a root");
            visit(whole(root), [](const glm::dvec3& p) { return p; });
        }
        must(!triangles_.empty(), "no triangles");
        return std::move(triangles_);
    }

    Numbers lengths() {
        Numbers all;
        for (const Json& animation : list(document_, "animations")) {
            all.push_back(0.0);
            for (const Json& sampler : list(animation, "samplers")) {
                all.back() = std::max(all.back(), accessor(whole(sampler.at("input")), Use::kKeys).back());
            }
        }
        return all;
    }

  private:
    void countParents() {
        parents_.assign(list(document_, "nodes").size(), 0);
        for (const Json& node : list(document_, "nodes")) {
            must(node.is_object(), "no object");
            for (const Json& child : list(node, "children")) {
                must(++parents_.at(whole(child)) == 1, "two parents");
            }
        }
    }

    /// \param m  16 numbers, column-major
    static Placement placeOfMatrix(const double* m) {
        must(std::abs(m[3]) + std::abs(m[7]) + std::abs(m[11]) + std::abs(m[15] - 1) < 3e-5, "the last row");
        glm::dmat4x3 matrix;
        for (int i = 0; i < 12; ++i) {
            matrix[i / 3][i % 3] = m[i / 3 * 4 + i % 3];
        }
        return [matrix](const glm::dvec3& p) { return matrix * glm::dvec4(p, 1.0); };
    }

    static Placement placeOf(const Json& node) {
        const Numbers m = numbers(node, "matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
        const Numbers t = numbers(node, "translation", {0, 0, 0});
        const Numbers q = numbers(node, "rotation", {0, 0, 0, 1});
        const Numbers s = numbers(node, "scale", {1, 1, 1});
        const bool parts =
            node.contains("translation") || node.contains("rotation") || node.contains("scale");
        must(!node.contains("matrix") || !parts, "a matrix and more");
        const Placement by = placeOfMatrix(m.data());
        must(std::abs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1) < 1e-3, "no unit");
        return [=](const glm::dvec3& p) {
            const glm::dvec3 scaled = by(p) * glm::dvec3(s[0], s[1], s[2]);
            const glm::dvec3 axis(q[0], q[1], q[2]);
            const glm::dvec3 across = glm::cross(axis, scaled);
            return scaled + 2.0 * (q[3] * across + glm::cross(axis, across)) + glm::dvec3(t[0], t[1], t[2]);
        };
    }

    void visit(std::size_t index, const Placement& above) {
        const Json& node = element(document_, "nodes", index);
        const Placement own = placeOf(node);
        const Placement place = [above, own](const glm::dvec3& p) { return above(own(p)); };
        if (node.contains("mesh")) {
            const Json* skin =
                node.contains("skin") ? &element(document_, "skins", whole(node.at("skin"))) : nullptr;
            const Json& mesh = element(document_, "meshes", whole(node.at("mesh")));
            const Numbers weights = node.value("weights", mesh.value("weights", Numbers(1000)));
            for (const Json& primitive : list(mesh, "primitives")) {
                addPrimitive(primitive, place, skin, weights);
            }
        }
        for (const Json& child : list(node, "children")) {
            visit(whole(child), place);
        }
    }

    Placement placeOf(std::size_t joint) {
        const Placement own = placeOf(element(document_, "nodes", joint));
        const Json& nodes = list(document_, "nodes");
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            for (const Json& child : list(nodes[i], "children")) {
                if (whole(child) == joint) {
                    const Placement above = placeOf(i);
                    return [above, own](const glm::dvec3& p) { return above(own(p)); };
                }
            }
        }
        return own;
    }

    /// Skinned positions of the vertices.
    std::vector<glm::dvec3> skinned(const std::vector<glm::dvec3>& points, const Json& attributes,
                                    const Json& skin) {
        const Json& joints = list(skin, "joints");
        must(!joints.empty(), "no joints");
        Numbers inverse;
        if (skin.contains("inverseBindMatrices")) {
            inverse = accessor(whole(skin.at("inverseBindMatrices")), Use::kMatrices);
            must(inverse.size() >= 16 * joints.size(), "too few matrices");
        }
        std::vector<Placement> places;
        for (std::size_t i = 0; i < joints.size(); ++i) {
            const Placement place = placeOf(whole(joints[i]));
            const Placement bind =
                inverse.empty() ? [](glm::dvec3 p) { return p; } : placeOfMatrix(&inverse[16 * i]);
            places.emplace_back([place, bind](const glm::dvec3& p) { return place(bind(p)); });
        }
        if (!attributes.contains("JOINTS_0") && !attributes.contains("WEIGHTS_0")) {
            return points;
        }
        const Numbers by = accessor(whole(attributes.at("JOINTS_0")), Use::kJoints);
        const Numbers weights = accessor(whole(attributes.at("WEIGHTS_0")), Use::kWeights);
        must(by.size() == 4 * points.size() && weights.size() == by.size(), "other counts");
        std::vector<glm::dvec3> posed;
        for (std::size_t i = 0; i < points.size(); ++i) {
            glm::dvec3 sum(0);
            double all = 0;
            for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) {
                must(weights[k] >= 0, "a weight");
                all += weights[k];
                if (weights[k] > 0 && by[k] >= static_cast<double>(places.size())) {
                    sum = glm::dvec3(std::nan(""));  // invalid only if a triangle uses it
                } else if (weights[k] > 0) {
                    sum += weights[k] * places.at(static_cast<std::size_t>(by[k]))(points[i]);
                }
            }
            must(all > 1e-5, "no weight");
            posed.push_back(sum / all);
        }
        return posed;
    }

    void addPrimitive(const Json& primitive, const Placement& place, const Json* skin,
                      const Numbers& weights) {
        const Json& attributes = primitive.at("attributes");
        must(attributes.is_object(), "no attributes");
        const std::size_t mode = whole(primitive, "mode", 4);
        must(mode <= 6, "mode");
        if (!attributes.contains("POSITION")) {
            return;
        }
        Numbers flat = accessor(whole(attributes.at("POSITION")), Use::kPositions);
        const Json& targets = list(primitive, "targets");
        for (std::size_t i = 0; i < targets.size(); ++i) {
            if (targets[i].contains("POSITION")) {
                const Numbers deltas = accessor(whole(targets[i].at("POSITION")), Use::kPositions);
                must(deltas.size() == flat.size(), "another count");
                for (std::size_t k = 0; k < flat.size(); ++k) {
                    flat[k] += weights.at(i) * deltas[k];
                }
            }
        }
        std::vector<glm::dvec3> points;
        for (std::size_t i = 0; i < flat.size(); i += 3) {
            points.push_back({flat[i], flat[i + 1], flat[i + 2]});
        }
        if (skin != nullptr) {
            points = skinned(points, attributes, *skin);
        } else {
            std::transform(points.begin(), points.end(), points.begin(), place);
        }
        std::vector<std::size_t> corners(points.size());
        std::iota(corners.begin(), corners.end(), std::size_t{0});
        if (primitive.contains("indices")) {
            corners.clear();
            for (const double index : accessor(whole(primitive.at("indices")), Use::kIndices)) {
                corners.push_back(static_cast<std::size_t>(index));
                must(corners.back() < points.size(), "an index");
            }
        }
        const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
            for (const std::size_t corner : {a, b, c}) {
                must(!std::isnan(points[corners[corner]].x), "a corner that is no number");
            }
            triangles_.push_back({points[corners[a]], points[corners[b]], points[corners[c]]});
        };
        must(mode != 4 || corners.size() % 3 == 0, "a part of a triangle");
        for (std::size_t i = 0; i + 2 < corners.size() && mode >= 4; i += mode == 4 ? 3 : 1) {
            if (mode == 4) {
                add(i, i + 1, i + 2);
            } else if (mode == 5) {
                add(i, i + (1 + i % 2), i + (2 - i % 2));
            } else {
                add(i + 1, i + 2, 0);
            }
        }
    }

    Numbers accessor(std::size_t index, Use use) {
        const Json& json = element(document_, "accessors", index);
        const std::string type = json.at("type");
        const std::map<std::string, std::size_t> counts = {
            {"SCALAR", 1}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
        const std::map<Use, std::string> types = {{Use::kPositions, "VEC3"}, {Use::kIndices, "SCALAR"},
                                                  {Use::kMatrices, "MAT4"},  {Use::kJoints, "VEC4"},
                                                  {Use::kWeights, "VEC4"},   {Use::kKeys, type}};
        must(types.at(use) == type, "type");
        const std::size_t components = counts.at(type);
        const std::size_t kind = whole(json.at("componentType"));
        const std::size_t count = whole(json.at("count"));
        const bool normalized = json.contains("normalized") && json.at("normalized").get<bool>();
        const bool small = kind == 5121 || kind == 5123;
        const bool number = small || kind == 5120 || kind == 5122 || kind == 5126;
        must(use == Use::kPositions || use == Use::kKeys ? number
             : use == Use::kIndices                      ? small || kind == 5125
             : use == Use::kJoints                       ? small
             : use == Use::kWeights                      ? small || kind == 5126
                                                         : kind == 5126,
             "componentType");
        must(!normalized || (use != Use::kIndices && use != Use::kJoints && kind != 5126), "normalized");
        must(use != Use::kWeights || normalized == small, "normalized weights");
        must(json.contains("bufferView") || json.contains("sparse"), "no data");
        Numbers values(count < 100000 ? count * components : throw std::runtime_error("count"));
        if (json.contains("bufferView")) {
            values = elements(json, kind, count, components, components > 1);
        }
        if (json.contains("sparse")) {
            const Json& sparse = json.at("sparse");
            const std::size_t replaced = whole(sparse.at("count"));
            must(replaced > 0 && replaced <= count, "sparse count");
            const std::size_t index_kind = whole(sparse.at("indices").at("componentType"));
            must(index_kind == 5121 || index_kind == 5123 || index_kind == 5125, "sparse indices");
            const auto where = elements(sparse.at("indices"), index_kind, replaced, 1, false);
            const auto what = elements(sparse.at("values"), kind, replaced, components, false);
            for (std::size_t i = 0; i < replaced; ++i) {
                must((i == 0 || where[i] > where[i - 1]) && where[i] < static_cast<double>(count), "order");
                for (std::size_t k = 0; k < components; ++k) {
                    values[static_cast<std::size_t>(where[i]) * components + k] = what[i * components + k];
                }
            }
        }
        const std::map<std::size_t, double> largest = {
            {5120, 127.0}, {5121, 255.0}, {5122, 32767.0}, {5123, 65535.0}, {5125, 4294967295.0}};
        for (double& value : values) {
            must(use != Use::kIndices || value != largest.at(kind), "restart");
            value = normalized ? std::max(value / largest.at(kind), -1.0) : value;
        }
        return values;
    }

    Numbers elements(const Json& owner, std::size_t kind, std::size_t count, std::size_t components,
                     bool strided) {
        const Json& view = element(document_, "bufferViews", whole(owner.at("bufferView")));
        must(!view.contains("extensions"), "an extension");
        const std::size_t size = kind <= 5121 ? 1 : kind <= 5123 ? 2 : 4;
        const std::size_t stride = whole(view, "byteStride", size * components);
        must(stride >= size * components && (strided || stride == size * components), "stride");
        const std::size_t buffer = whole(view.at("buffer"));
        const std::size_t most = whole(element(document_, "buffers", buffer).at("byteLength"));
        must(buffer == 0 && most <= binary_.size(), "no such buffer, or a short one");
        const std::size_t from = whole(view, "byteOffset", 0);
        const std::size_t length = whole(view.at("byteLength"));
        must(from + length <= most, "a view behind its buffer");
        const std::size_t offset = whole(owner, "byteOffset", 0);
        must(count < 100000 && (count == 0 || offset + (count - 1) * stride + size * components <= length),
             "an accessor behind its view");
        Numbers values;
        for (std::size_t i = 0; i < count * components; ++i) {
            const std::size_t at = from + offset + i / components * stride + i % components * size;
            std::uint32_t bits = 0;
            std::memcpy(&bits, binary_.data() + at, size);
            float real = 0;
            std::memcpy(&real, &bits, 4);
            values.push_back(kind == 5126   ? static_cast<double>(real)
                             : kind == 5120 ? static_cast<double>(static_cast<std::int8_t>(bits))
                             : kind == 5122 ? static_cast<double>(static_cast<std::int16_t>(bits))
                                            : static_cast<double>(bits));
        }
        return values;
    }

    Json document_;
    std::string binary_;
    std::vector<int> parents_;
    std::vector<Corners> triangles_;
};

}  // namespace

std::vector<Corners> readGltfReference(const GltfCase& file, const std::optional<GltfMoment>& moment) {
    return Book(file).read(moment);
}

std::vector<double> referenceClipLengths(const GltfCase& file) {
    return Book(file).lengths();
}

}  // namespace relief::test
