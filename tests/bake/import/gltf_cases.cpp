// SPDX-License-Identifier: Apache-2.0
#include "tests/bake/import/gltf_cases.h"

#include <array>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "tests/bake/import/import_meshes.h"

namespace relief::test {
namespace {

using Json = nlohmann::json;

template <class T>
std::string bytesOf(T value) {
    std::string bytes(sizeof(value), '\0');
    std::memcpy(bytes.data(), &value, sizeof(value));
    return bytes;
}

/// \param kind  componentType: 5120 to 5125 are integers of 1, 1, 2, 2 and 4 bytes; 5126 is float
std::string componentBytes(int kind, int value) {
    const std::size_t size = kind <= 5121 ? 1 : kind <= 5123 ? 2 : 4;
    return kind == 5126 ? bytesOf(static_cast<float>(value)) : bytesOf(value).substr(0, size);
}

class Maker {
  public:
    explicit Maker(Dice& dice) : dice_(dice) {}

    GltfCase make() {
        json_["asset"] = {{"version", "2.0"}, {"generator", "a test"}};
        json_["materials"] = Json::array({{{"name", "paint"}}, Json::object()});
        if (dice_.once(4)) {
            json_["asset"]["minVersion"] = "2.0";
        }
        joints_ = dice_.from(1, 2);
        meshes_ = dice_.from(1, 3);
        for (int i = 0; i < meshes_; ++i) {
            Json primitives = Json::array();
            for (int k = dice_.from(1, 2); k > 0; --k) {
                // The first primitive is a surface.
                primitives.push_back(primitive(primitives.empty() && i == 0));
            }
            json_["meshes"].push_back({{"primitives", primitives}, {"name", "mesh"}});
        }
        makeNodes();
        makeSkin();
        if (quantised_) {
            json_["extensionsRequired"] = Json::array({"KHR_mesh_quantization"});
            json_["extensionsUsed"] = json_["extensionsRequired"];
        }
        json_["buffers"].push_back({{"byteLength", buffer_.size()}});
        return {std::move(json_), std::move(buffer_), static_cast<GltfContainer>(dice_.roll(3))};
    }

  private:
    /// Appends values, packed or with a stride. \return the index of their buffer view
    std::size_t addView(int kind, std::size_t components, const std::vector<int>& values, bool apart,
                        std::size_t& offset) {
        buffer_.resize((buffer_.size() + 3) / 4 * 4, '\x7f');
        const std::size_t begin = buffer_.size();
        offset = 4 * dice_.roll(3);
        buffer_.append(offset, '\x7f');
        const std::size_t tight = components * componentBytes(kind, 0).size();
        const std::size_t stride = apart ? (tight + 3) / 4 * 4 + 4 * dice_.roll(3) : tight;
        for (std::size_t i = 0; i < values.size(); ++i) {
            buffer_ += componentBytes(kind, values[i]);
            if ((i + 1) % components == 0 && i + 1 < values.size()) {
                buffer_.append(stride - tight, '\x7f');
            }
        }
        Json view = {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", buffer_.size() - begin}};
        if (apart) {
            view["byteStride"] = stride;
        }
        if (dice_.once(3)) {
            buffer_.append(dice_.roll(8), '\x7f');
        }
        json_["bufferViews"].push_back(view);
        return json_["bufferViews"].size() - 1;
    }

    std::size_t addAccessor(const char* type, int kind, std::size_t components, std::vector<int> values) {
        const std::size_t count = values.size() / components;
        Json json = {{"type", type}, {"componentType", kind}, {"count", count}};
        if (components == 3 && kind != 5126 && dice_.once(2)) {
            json["normalized"] = true;
        }
        if (count > 0 && dice_.once(4)) {
            json["sparse"] = addSparse(kind, components, values);
        }
        if (!json.contains("sparse") || dice_.once(2)) {
            if (json.contains("sparse")) {
                for (const int i : replaced_) {  // the sparse values must replace these
                    values[static_cast<std::size_t>(i) * components] ^= 1;
                }
            }
            std::size_t offset = 0;
            json["bufferView"] = addView(kind, components, values, components == 3 && dice_.once(2), offset);
            if (offset > 0 || dice_.once(2)) {
                json["byteOffset"] = offset;
            }
        } else {
            json["sparse"] = addSparse(kind, components, values, true);
        }
        json_["accessors"].push_back(json);
        return json_["accessors"].size() - 1;
    }

    Json addSparse(int kind, std::size_t components, const std::vector<int>& values, bool all = false) {
        replaced_.clear();
        std::vector<int> replacing;
        const std::size_t count = values.size() / components;
        for (std::size_t i = 0; i < count; ++i) {
            if (all || dice_.once(3) || (i + 1 == count && replaced_.empty())) {
                replaced_.push_back(static_cast<int>(i));
                for (std::size_t k = 0; k < components; ++k) {
                    replacing.push_back(values[i * components + k]);
                }
            }
        }
        const int index_kind = std::array{5121, 5123, 5125}.at(dice_.roll(3));
        std::size_t at = 0;
        Json sparse = {{"count", replaced_.size()}};
        sparse["indices"]["componentType"] = index_kind;
        sparse["indices"]["bufferView"] = addView(index_kind, 1, replaced_, false, at);
        sparse["indices"]["byteOffset"] = at;
        sparse["values"]["bufferView"] = addView(kind, components, replacing, false, at);
        sparse["values"]["byteOffset"] = at;
        return sparse;
    }

    Json primitive(bool surface) {
        const int mode = surface || !dice_.once(4) ? dice_.from(4, 6) : dice_.from(0, 3);
        const int kind = std::array{5126, 5126, 5126, 5120, 5121, 5122, 5123}.at(dice_.roll(7));
        quantised_ = quantised_ || kind != 5126;
        const bool indexed = !dice_.once(3);
        const int vertices = indexed ? dice_.from(3, 12) : 3 * dice_.from(1, 4);
        std::vector<int> positions;
        for (int i = 0; i < 3 * vertices; ++i) {
            positions.push_back(kind == 5121 || kind == 5123 ? dice_.from(0, 127) : dice_.from(-60, 60));
        }
        Json json = {{"attributes", {{"POSITION", addAccessor("VEC3", kind, 3, positions)}}}};
        if (dice_.once(2)) {
            addInfluences(json["attributes"], vertices);
        }
        if (indexed) {
            std::vector<int> indices;
            for (int i = 3 * dice_.from(1, 6); i > 0; --i) {
                indices.push_back(dice_.from(0, vertices - 1));
            }
            json["indices"] =
                addAccessor("SCALAR", std::array{5121, 5123, 5125}.at(dice_.roll(3)), 1, indices);
        }
        if (mode != 4 || dice_.once(2)) {
            json["mode"] = mode;
        }
        if (dice_.once(3)) {
            json["material"] = dice_.roll(2);
        }
        return json;
    }

    /// One set of influences, as floats or as bytes. A byte of 255 is 1.
    void addInfluences(Json& attributes, int vertices) {
        const bool bytes = dice_.once(2);
        const int one = bytes ? 255 : 1;
        std::vector<int> joints;
        std::vector<int> weights;
        for (int i = 0; i < vertices; ++i) {
            const int first = dice_.from(0, joints_ - 1);
            joints.insert(joints.end(), {first, dice_.from(0, joints_ - 1), dice_.from(0, 3), 0});
            weights.insert(weights.end(), {one, dice_.once(2) ? one : 0, 0, 0});
        }
        attributes["JOINTS_0"] = addAccessor("VEC4", dice_.once(2) ? 5121 : 5123, 4, joints);
        attributes["WEIGHTS_0"] = addAccessor("VEC4", bytes ? 5121 : 5126, 4, weights);
        if (bytes) {
            json_["accessors"].back()["normalized"] = true;
        }
    }

    void makeSkin() {
        Json skin = {{"joints", Json::array({0})}};
        if (joints_ == 2) {
            skin["joints"].push_back(1);
        }
        if (dice_.once(2)) {
            std::vector<int> matrices;
            for (int i = 0; i < joints_; ++i) {
                matrices.insert(matrices.end(), {1, 0, 0, 0, 0, 2, 0, 0, 0, dice_.from(0, 1), 1, 0,
                                                 dice_.from(-9, 9), dice_.from(-9, 9), 3, 1});
            }
            skin["inverseBindMatrices"] = addAccessor("MAT4", 5126, 16, matrices);
        }
        json_["skins"] = Json::array({skin});
    }

    Json place() {
        Json node = Json::object();
        if (dice_.once(3)) {
            const int scale = dice_.from(-2, 3);
            const int shear = dice_.from(-1, 1);
            const int far = dice_.from(-9, 9);
            node["matrix"] = {scale, shear, 0.25, 0, 0.5, 2, -shear, 0, 0, -0.5, 1.5, 0, far, -2, 3.5, 1};
            return node;
        }
        if (dice_.once(2)) {
            node["translation"] = {dice_.from(-20, 20), dice_.from(-20, 20), 0.125};
        }
        if (dice_.once(2)) {
            glm::dvec4 q;
            for (int k = 0; k < 4; ++k) {
                q[k] = dice_.from(-5, 5) + 0.5;
            }
            q = glm::normalize(q);
            node["rotation"] = {q.x, q.y, q.z, q.w};
        }
        if (dice_.once(2)) {
            node["scale"] = {dice_.from(1, 3), 0.5, dice_.once(3) ? -1 : 2};
        }
        return node;
    }

    /// Each node is a child of an earlier node or a root. Nodes of a second scene are not visible.
    void makeNodes() {
        const int count = dice_.from(2, 6);
        Json roots = Json::array();
        for (int i = 0; i < count; ++i) {
            Json node = place();
            if (i == 0 || !dice_.once(3)) {
                node["mesh"] = i == 0 ? 0 : dice_.from(0, meshes_ - 1);
                if (dice_.once(5)) {
                    node["skin"] = 0;
                }
            }
            if (dice_.once(2)) {
                node["name"] = "node" + std::to_string(i);
            }
            if (i == 0 || dice_.once(3)) {
                roots.push_back(i);
            } else {
                json_["nodes"][static_cast<std::size_t>(dice_.from(0, i - 1))]["children"].push_back(i);
            }
            json_["nodes"].push_back(node);
        }
        json_["scenes"] = Json::array({{{"nodes", roots}}});
        if (dice_.once(4)) {
            json_["scenes"].insert(json_["scenes"].begin(), Json::object());
            json_["scene"] = 1;
        } else if (dice_.once(2)) {
            json_["scene"] = 0;
        }
    }

    Dice& dice_;
    Json json_;
    std::string buffer_;
    std::vector<int> replaced_;  // elements replaced by the last sparse accessor
    int meshes_ = 0;
    int joints_ = 1;
    bool quantised_ = false;
};

/// A different value of any type.
Json otherValue(const Json& value, Dice& dice) {
    if (value.is_number_integer() && dice.once(4)) {
        const int number = value.get<int>();
        return std::array{number - 1, number + 1, 2 * number}.at(dice.roll(3));
    }
    const std::array<Json, 12> others = {
        nullptr, "2",   -1, 0.5, 9007199254740993ULL, Json::array(), Json::object(), true,
        255,     1e300, "", 5126};
    return others.at(dice.roll(12));
}

}  // namespace

std::uint64_t Dice::roll(std::uint64_t sides) {
    // SplitMix64.
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return (z ^ (z >> 31U)) % sides;
}

int Dice::from(int least, int most) {
    return least + static_cast<int>(roll(static_cast<std::uint64_t>(most - least + 1)));
}

GltfCase makeGltf(Dice& dice) {
    return Maker(dice).make();
}

std::string mutateGltf(Json& document, Dice& dice) {
    Json* at = &document;
    std::string path;
    while (at->is_structured() && !at->empty() && (path.empty() || !dice.once(4))) {
        auto child = at->begin();
        std::advance(child, static_cast<std::ptrdiff_t>(dice.roll(at->size())));
        Json& next = *child;
        const bool end = !next.is_structured() || next.empty() || dice.once(4);
        path += "/" + (at->is_object() ? child.key() : std::to_string(child - at->begin()));
        if (end && dice.once(5)) {
            at->erase(child);
            return path + " is gone";
        }
        if (end && at->is_array() && dice.once(3)) {
            at->push_back(Json(next));
            return path + " is there twice";
        }
        at = &next;
    }
    *at = otherValue(*at, dice);
    return path + " is " + at->dump();
}

std::filesystem::path writeGltf(const GltfCase& gltf, const TemporaryFolder& folder,
                                const std::string& name) {
    Json document = gltf.document;
    const bool place = document.contains("buffers") && document["buffers"].is_array() &&
                       !document["buffers"].empty() && document["buffers"][0].is_object() &&
                       !document["buffers"][0].contains("uri");
    if (gltf.container != GltfContainer::kBinary && place) {
        document["buffers"][0]["uri"] = gltf.container == GltfContainer::kDataUri
                                            ? "data:application/octet-stream;base64," + base64(gltf.buffer)
                                            : "a%20%C3%A4%25 b.bin";
    }
    if (gltf.container == GltfContainer::kFileBeside) {
        folder.write("a \xc3\xa4% b.bin", gltf.buffer);
    }
    std::string text = document.dump();
    if (gltf.container != GltfContainer::kBinary) {
        return folder.write(name + ".gltf", text);
    }
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string buffer = gltf.buffer;
    buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
    const auto word = [](std::size_t value) { return bytesOf(static_cast<std::uint32_t>(value)); };
    return folder.write(name + ".glb", "glTF" + word(2) + word(28 + text.size() + buffer.size()) +
                                           word(text.size()) + "JSON" + text + word(buffer.size()) +
                                           std::string("BIN\0", 4) + buffer);
}

}  // namespace relief::test
