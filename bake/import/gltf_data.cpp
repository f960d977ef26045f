// SPDX-License-Identifier: Apache-2.0
#include "bake/import/gltf_data.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "formats/base/text.h"

namespace relief {
namespace {

// --- bytes ---

constexpr std::size_t kHeader = 12;      // GLB: magic, version, length
constexpr std::size_t kChunkHeader = 8;  // length and type
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr const char* kCutOff = "and was probably cut off; copy or export it again";

/// Loads a value; assumes a little-endian machine.
template <class T>
T load(const std::byte* at) {
    T value{};
    std::memcpy(&value, at, sizeof(value));
    return value;
}

Result<std::string> percentDecoded(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            out += text[i];
            continue;
        }
        const std::string_view digits = text.substr(i + 1, 2);
        std::uint8_t byte = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
        if (digits.size() != 2 || end != digits.data() + 2 || error != std::errc()) {
            return invalidInput(
                "has a % without two hexadecimal digits after it; write %25 for a percent sign");
        }
        out += static_cast<char>(byte);
        i += 2;
    }
    return out;
}

/// Decodes base64, with or without padding.
std::optional<std::vector<std::byte>> base64Bytes(std::string_view text) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<std::uint8_t, 256> values{};
    values.fill(64);
    for (std::size_t i = 0; i < kDigits.size(); ++i) {
        values[static_cast<unsigned char>(kDigits[i])] = static_cast<std::uint8_t>(i);
    }
    if (text.size() % 4 == 0) {
        text.remove_suffix(text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0);
    }
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    unsigned count = 0;
    for (const char c : text) {
        const std::uint8_t digit = values[static_cast<unsigned char>(c)];
        if (digit > 63 || text.size() % 4 == 1) {
            return std::nullopt;
        }
        bits = bits << 6U | digit;
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes.push_back(static_cast<std::byte>(bits >> count & 0xFFU));
        }
    }
    return bytes;
}

bool isDataUri(std::string_view uri) {
    return lowerCase(uri.substr(0, 5)) == "data:";
}

// --- numbers ---

// Component types.
constexpr std::uint64_t kByte = 5120;
constexpr std::uint64_t kUnsignedByte = 5121;
constexpr std::uint64_t kShort = 5122;
constexpr std::uint64_t kUnsignedShort = 5123;
constexpr std::uint64_t kUnsignedInt = 5125;
constexpr std::uint64_t kFloat = 5126;

struct Rules {
    const char* type;
    std::array<std::uint64_t, 5> components;
    bool normalized;  ///< integers may be normalized
};
constexpr std::array<Rules, 10> kRules = {
    {{"VEC3", {kByte, kUnsignedByte, kShort, kUnsignedShort, kFloat}, true},
     {"SCALAR", {kUnsignedByte, kUnsignedShort, kUnsignedInt}, false},
     {"VEC4", {kUnsignedByte, kUnsignedShort}, false},
     {"VEC4", {kUnsignedByte, kUnsignedShort, kFloat}, true},
     {"MAT4", {kFloat}, false},
     {"VEC3", {kFloat}, false},
     {"VEC4", {kByte, kShort, kFloat}, true},
     {"VEC3", {kByte, kUnsignedByte, kShort, kUnsignedShort, kFloat}, true},
     {"SCALAR", {kFloat}, false},
     {"SCALAR", {kByte, kUnsignedByte, kShort, kUnsignedShort, kFloat}, true}}};

std::uint64_t sizeOf(std::uint64_t type) {
    return type <= kUnsignedByte ? 1 : type <= kUnsignedShort ? 2 : 4;
}

/// Loads a value; a normalized byte of 127 is 1.
template <class T>
float loadQuantised(const std::byte* at, bool normalized) {
    const auto value = static_cast<float>(load<T>(at));
    return normalized ? std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0F) : value;
}

void loadComponent(const std::byte* at, std::uint64_t type, bool normalized, float& out) {
    out = type == kByte            ? loadQuantised<std::int8_t>(at, normalized)
          : type == kUnsignedByte  ? loadQuantised<std::uint8_t>(at, normalized)
          : type == kShort         ? loadQuantised<std::int16_t>(at, normalized)
          : type == kUnsignedShort ? loadQuantised<std::uint16_t>(at, normalized)
                                   : load<float>(at);
}

void loadComponent(const std::byte* at, std::uint64_t type, bool /*normalized*/, std::uint32_t& out) {
    out = type == kUnsignedByte    ? load<std::uint8_t>(at)
          : type == kUnsignedShort ? load<std::uint16_t>(at)
                                   : load<std::uint32_t>(at);
}

/// Elements in a view, `stride` bytes apart.
struct Elements {
    const std::byte* first = nullptr;
    std::uint64_t stride = 0;

    [[nodiscard]] const std::byte* at(std::uint64_t index) const { return first + index * stride; }
};

/// Returns `count` elements of `size` bytes in the view that `owner` references. \param strided  the view may have a
/// stride.
Result<Elements> elementsOf(const GltfValue& owner, GltfBuffers& buffers, std::uint64_t count,
                            std::uint64_t size, bool strided) {
    const GltfView view = RELIEF_TRY(buffers.view(owner));
    const std::uint64_t stride = view.stride.value_or(size);
    const std::uint64_t offset = RELIEF_TRY(owner.get<std::uint64_t>("byteOffset", 0));
    if (stride < size || (!strided && stride != size)) {
        return owner.wrong("has a buffer view with a stride of " + std::to_string(stride) +
                           " bytes, which does not fit elements of " + std::to_string(size) + " bytes");
    }
    const std::uint64_t length = view.bytes.size();
    // Division cannot overflow.
    const bool fits = count == 0 || (offset <= length && size <= length - offset &&
                                     count - 1 <= (length - offset - size) / stride);
    if (!fits) {
        return owner.wrong("extends beyond its buffer view");
    }
    return Elements{view.bytes.data() + (count == 0 ? 0 : offset), stride};
}

/// Calls replace(index, bytes) for each element that a sparse accessor replaces.
template <class Replace>
Result<void> replaceSparse(const GltfValue& sparse, GltfBuffers& buffers, std::uint64_t all,
                           std::uint64_t size, const Replace& replace) {
    const std::uint64_t count = RELIEF_TRY(sparse.number("count"));
    const std::optional<GltfValue> indices = RELIEF_TRY(sparse.object("indices"));
    const std::optional<GltfValue> values = RELIEF_TRY(sparse.object("values"));
    if (count == 0 || count > all || !indices || !values) {
        return sparse.wrong("has no indices, no values, or a count that is 0 or exceeds the accessor's");
    }
    const std::uint64_t type = RELIEF_TRY(indices->number("componentType"));
    if (type != kUnsignedByte && type != kUnsignedShort && type != kUnsignedInt) {
        return indices->wrong("has components of type " + std::to_string(type) +
                              ", which is not valid for indices");
    }
    const Elements where = RELIEF_TRY(elementsOf(*indices, buffers, count, sizeOf(type), false));
    const Elements what = RELIEF_TRY(elementsOf(*values, buffers, count, size, false));
    std::uint64_t next = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        std::uint32_t index = 0;
        loadComponent(where.at(i), type, false, index);
        if (index < next || index >= all) {
            return indices->wrong("are not in ascending order, or reference a missing element");
        }
        replace(index, what.at(i));
        next = std::uint64_t{index} + 1;
    }
    return {};
}

/// Splits a GLB into its chunks; any other file is JSON.
Result<GltfChunks> gltfChunks(std::span<const std::byte> bytes) {
    const std::string_view text = textOf(bytes);
    GltfChunks chunks{text, std::nullopt, {}};
    if (!text.starts_with("glTF")) {
        return chunks;
    }
    if (bytes.size() < kHeader + kChunkHeader) {
        return invalidInput(std::string("it ends within its header, ") + kCutOff);
    }
    const auto word = [bytes](std::size_t at) { return load<std::uint32_t>(bytes.data() + at); };
    if (word(4) != 2) {
        return fail(ErrorCode::kUnsupported, "binary glTF version " + std::to_string(word(4)) +
                                                 " is not supported; save it as glTF 2.0");
    }
    const std::size_t length = word(8);
    if (length > bytes.size()) {
        return invalidInput("it has " + std::to_string(bytes.size()) + " of the " + std::to_string(length) +
                            " bytes that its header declares, " + kCutOff);
    }
    if (length < bytes.size()) {
        chunks.warnings.push_back(std::to_string(bytes.size() - length) +
                                  " bytes after the end that its header declares are left out");
    }
    std::size_t number = 0;
    for (std::size_t at = kHeader; at < length; ++number) {
        const std::string chunk = "its chunk " + std::to_string(number);
        if (length - at < kChunkHeader || word(at) > length - at - kChunkHeader) {
            return invalidInput(chunk + " extends beyond the end of the file; export it again");
        }
        const std::size_t size = word(at);
        const std::uint32_t type = word(at + 4);
        at += kChunkHeader;
        if (size % 4 != 0 && at + size < length) {
            return invalidInput("the length of " + chunk + " is not a multiple of 4; export it again");
        }
        if ((number == 0) != (type == kJsonChunk) || (number > 1 && type == kBinaryChunk)) {
            return invalidInput(
                "its first chunk is not JSON, or its second chunk is not binary; export it again");
        }
        if (type == kJsonChunk) {
            chunks.json = text.substr(at, size);
        } else if (type == kBinaryChunk) {
            chunks.binary = bytes.subspan(at, size);
        }
        at += size;
    }
    return number > 0 ? Result<GltfChunks>(std::move(chunks))
                      : invalidInput(std::string("it has no JSON, ") + kCutOff);
}

}  // namespace

Result<GltfDocument> openGltf(std::span<const std::byte> bytes) {
    GltfDocument document{RELIEF_TRY(gltfChunks(bytes)), {}};
    document.json = std::make_shared<nlohmann::json>(RELIEF_TRY(parseGltfJson(document.chunks.json)));
    return document.json->is_object() ? Result<GltfDocument>(std::move(document))
                                      : invalidInput("its JSON is not an object");
}

Result<std::vector<std::byte>> dataUriBytes(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (!isDataUri(uri) || comma == std::string_view::npos ||
        !lowerCase(uri.substr(0, comma)).ends_with(";base64")) {
        return invalidInput("is a data URI without base64 data; export it as GLB");
    }
    std::optional<std::vector<std::byte>> bytes =
        base64Bytes(RELIEF_TRY(percentDecoded(uri.substr(comma + 1))));
    return bytes ? Result<std::vector<std::byte>>(*std::move(bytes)) : invalidInput("is not valid base64");
}

Result<GltfView> GltfBuffers::view(const GltfValue& from) {
    const GltfValue place = RELIEF_TRY(from.needed("bufferView", "bufferViews"));
    const std::optional<std::uint64_t> stride = RELIEF_TRY(place.get<std::uint64_t>("byteStride"));
    if (stride == std::uint64_t{0}) {
        return place.wrong("has a byteStride of 0");
    }
    const std::optional<GltfValue> extensions = RELIEF_TRY(place.object("extensions"));
    if (extensions && extensions->has("KHR_meshopt_compression")) {
        return place.wrong(
            "uses KHR_meshopt_compression, which is not supported; export it uncompressed, or with "
            "EXT_meshopt_compression",
            ErrorCode::kUnsupported);
    }
    const std::optional<GltfValue> packed =
        extensions ? RELIEF_TRY(extensions->object("EXT_meshopt_compression")) : std::nullopt;
    if (!packed) {
        return GltfView{RELIEF_TRY(part(place)), stride};
    }
    if (!unpacked_.contains(place.index())) {
        const std::uint64_t size = RELIEF_TRY(place.number("byteLength"));
        const std::span<const std::byte> bytes = RELIEF_TRY(part(*packed));
        unpacked_[place.index()] = RELIEF_TRY(unpackMeshopt(*packed, bytes, size));
    }
    return GltfView{unpacked_[place.index()], stride};
}

/// \param place  an object that references a part of a buffer.
Result<std::span<const std::byte>> GltfBuffers::part(const GltfValue& place) {
    const GltfValue buffer = RELIEF_TRY(place.needed("buffer", "buffers"));
    const std::uint64_t offset = RELIEF_TRY(place.get<std::uint64_t>("byteOffset", 0));
    const std::uint64_t length = RELIEF_TRY(place.number("byteLength"));
    const std::uint64_t declared = RELIEF_TRY(buffer.number("byteLength"));
    if (offset > declared || length > declared - offset) {
        return place.wrong("extends beyond its buffer");
    }
    const std::optional<std::string> uri = RELIEF_TRY(buffer.get<std::string>("uri"));
    if (!uri && (buffer.index() != 0 || !chunks_.binary)) {
        return buffer.wrong("has no uri, and the file contains no bytes for it");
    }
    if (uri && !read_.contains(buffer.index())) {
        Result<std::vector<std::byte>> bytes = read(*uri);
        if (!bytes) {
            return buffer.wrong(bytes.error().message, bytes.error().code);
        }
        read_[buffer.index()] = *std::move(bytes);
    }
    const std::span<const std::byte> bytes = uri ? read_[buffer.index()] : *chunks_.binary;
    if (bytes.size() < declared) {
        return buffer.wrong("has " + std::to_string(bytes.size()) + " of the " + std::to_string(declared) +
                            " bytes that it declares, " + kCutOff);
    }
    return bytes.subspan(offset, length);
}

Result<std::vector<std::byte>> GltfBuffers::read(const std::string& uri) {
    if (isDataUri(uri)) {
        return dataUriBytes(uri);
    }
    constexpr std::size_t kShownUri = 200;  // bytes
    const std::string path = RELIEF_TRY(percentDecoded(uri));
    if (files_.isMesh(path)) {
        return std::vector<std::byte>(files_.meshBytes().begin(), files_.meshBytes().end());
    }
    std::optional<std::vector<std::byte>> bytes;
    if (uri.find(':') == std::string::npos) {
        bytes = files_.open(path);
    }
    return bytes ? Result<std::vector<std::byte>>(*std::move(bytes))
                 : invalidInput("refers to " +
                                (files_.refused().empty() ? "'" + cleanUtf8(path, kShownUri) + "'"
                                                          : files_.refused().back()) +
                                "; put the buffer beside the mesh");
}

template <class T>
Result<std::vector<T>> readAccessor(const GltfValue& accessor, GltfUse use, GltfBuffers& buffers,
                                    std::uint64_t count_max) {
    using Component = std::conditional_t<std::is_same_v<T, std::uint32_t>, std::uint32_t, float>;
    constexpr std::size_t kComponents = sizeof(T) / sizeof(Component);
    const Rules& rules = kRules.at(static_cast<std::size_t>(use));
    if (RELIEF_TRY(accessor.get<std::string>("type")) != rules.type) {
        return accessor.wrong(std::string("is not of type ") + rules.type);
    }
    const std::uint64_t type = RELIEF_TRY(accessor.number("componentType"));
    if (type == 0 || std::ranges::find(rules.components, type) == rules.components.end()) {
        return accessor.wrong("has components of type " + std::to_string(type) +
                                  ", which is not supported here; export it as floats, with unsigned indices",
                              ErrorCode::kUnsupported);
    }
    const bool normalized = RELIEF_TRY(accessor.get("normalized", false));
    if (normalized && (!rules.normalized || type == kFloat)) {
        return accessor.wrong("is normalized, but only integer attributes can be");
    }
    if ((use == GltfUse::kWeights || use == GltfUse::kMorphs) && !normalized && type != kFloat) {
        return accessor.wrong("is not normalized, but integer weights must be");
    }
    const std::uint64_t count = RELIEF_TRY(accessor.number("count"));
    const std::uint64_t size = kComponents * sizeOf(type);
    const std::optional<GltfValue> sparse = RELIEF_TRY(accessor.object("sparse"));
    std::optional<Elements> elements;
    if (accessor.has("bufferView")) {
        // Only attributes may have a stride.
        elements = RELIEF_TRY(elementsOf(accessor, buffers, count, size, kComponents > 1));
    } else if (!sparse && use != GltfUse::kDeltas) {
        return accessor.wrong("has no data; export it uncompressed", ErrorCode::kUnsupported);
    }
    if (count > count_max) {
        return accessor.wrong("has " + std::to_string(count) + " elements, but only " +
                                  std::to_string(count_max) +
                                  " are left; simplify the mesh, or raise --max-triangles",
                              ErrorCode::kLimit);
    }
    std::vector<T> values(count, T{});
    const auto take = [&](std::uint64_t index, const std::byte* at) {
        auto* const components = reinterpret_cast<Component*>(&values[index]);
        for (std::size_t k = 0; k < kComponents; ++k) {
            loadComponent(at + k * sizeOf(type), type, normalized, components[k]);
        }
    };
    for (std::uint64_t i = 0; elements && i < count; ++i) {
        take(i, elements->at(i));
    }
    if (sparse) {
        RELIEF_TRY(replaceSparse(*sparse, buffers, count, size, take));
    }
    return values;
}

template Result<std::vector<float>> readAccessor(const GltfValue&, GltfUse, GltfBuffers&, std::uint64_t);
template Result<std::vector<glm::vec3>> readAccessor(const GltfValue&, GltfUse, GltfBuffers&, std::uint64_t);
template Result<std::vector<glm::vec4>> readAccessor(const GltfValue&, GltfUse, GltfBuffers&, std::uint64_t);
template Result<std::vector<glm::mat4>> readAccessor(const GltfValue&, GltfUse, GltfBuffers&, std::uint64_t);
template Result<std::vector<std::uint32_t>> readAccessor(const GltfValue&, GltfUse, GltfBuffers&,
                                                         std::uint64_t);

}  // namespace relief
