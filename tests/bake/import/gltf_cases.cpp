// SPDX-License-Identifier: Apache-2.0
#include "tests/bake/import/gltf_cases.h"

#include <array>
#include <cstring>

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
