#include "bake/import/gltf_accessor.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <optional>

namespace relief {
namespace {

// Component types.
constexpr std::uint64_t kByte = 5120;
constexpr std::uint64_t kUnsignedByte = 5121;
constexpr std::uint64_t kShort = 5122;
constexpr std::uint64_t kUnsignedShort = 5123;
constexpr std::uint64_t kUnsignedInt = 5125;
constexpr std::uint64_t kFloat = 5126;
constexpr std::array kPositionTypes = {kByte, kUnsignedByte, kShort, kUnsignedShort, kFloat};
constexpr std::array kIndexTypes = {kUnsignedByte, kUnsignedShort, kUnsignedInt};
constexpr std::array kJointTypes = {kUnsignedByte, kUnsignedShort};
constexpr std::array kWeightTypes = {kUnsignedByte, kUnsignedShort, kFloat};
constexpr std::array kMatrixTypes = {kFloat};

std::uint64_t sizeOf(std::uint64_t type) {
    return type == kByte || type == kUnsignedByte ? 1 : type == kShort || type == kUnsignedShort ? 2 : 4;
}

/// Of a component type, as little-endian as this machine.
template <class T>
T load(const std::byte* at) {
    T value{};
    std::memcpy(&value, at, sizeof(value));
    return value;
}

std::uint32_t loadIndex(const std::byte* at, std::uint64_t type) {
    return type == kUnsignedByte    ? load<std::uint8_t>(at)
           : type == kUnsignedShort ? load<std::uint16_t>(at)
                                    : load<std::uint32_t>(at);
}

/// Whole numbers of a quantised attribute: 127 of a normalised byte is 1.
template <class T>
float loadQuantised(const std::byte* at, bool normalized) {
    const auto value = static_cast<float>(load<T>(at));
    return normalized ? std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0F) : value;
}

float loadComponent(const std::byte* at, std::uint64_t type, bool normalized) {
    switch (type) {
        case kByte:
            return loadQuantised<std::int8_t>(at, normalized);
        case kUnsignedByte:
            return loadQuantised<std::uint8_t>(at, normalized);
        case kShort:
            return loadQuantised<std::int16_t>(at, normalized);
        case kUnsignedShort:
            return loadQuantised<std::uint16_t>(at, normalized);
        default:
            return load<float>(at);
    }
}

/// Elements in a view, one every `stride` bytes.
struct Elements {
    const std::byte* first = nullptr;
    std::uint64_t stride = 0;

    [[nodiscard]] const std::byte* at(std::uint64_t index) const { return first + index * stride; }
};

struct Layout {
    std::uint64_t type = 0;
    std::uint64_t count = 0;
    std::uint64_t components = 0;
    bool normalized = false;

    [[nodiscard]] std::uint64_t size() const { return components * sizeOf(type); }
};

/// The `count` elements of `size` bytes in the view that `owner` names.
/// \param strided  whether the view may say a stride of its own.
Result<Elements> elementsOf(const GltfValue& owner, GltfBuffers& buffers, std::uint64_t count,
                            std::uint64_t size, bool strided) {
    const GltfView view = RELIEF_TRY(buffers.view(owner));
    const std::uint64_t stride = view.stride.value_or(size);
    const std::uint64_t offset = RELIEF_TRY(owner.whole("byteOffset")).value_or(0);
    if (stride < size || (!strided && stride != size)) {
        return owner.wrong("has a buffer view of " + std::to_string(stride) + " bytes from one element of " +
                           std::to_string(size) + " to the next");
    }
    const std::uint64_t length = view.bytes.size();
    // Divided, not multiplied: no overflow.
    const bool fits = count == 0 || (offset <= length && size <= length - offset &&
                                     count - 1 <= (length - offset - size) / stride);
    if (!fits) {
        return owner.wrong("ends behind its buffer view");
    }
    return Elements{view.bytes.data() + (count == 0 ? 0 : offset), stride};
}

Result<Layout> layoutOf(const GltfValue& accessor, const char* kind, std::uint64_t components,
                        std::span<const std::uint64_t> types) {
    Layout layout;
    layout.components = components;
    if (RELIEF_TRY(accessor.text("type")) != kind) {
        return accessor.wrong(std::string("is not of type ") + kind);
    }
    layout.type = RELIEF_TRY(accessor.neededWhole("componentType"));
    if (std::find(types.begin(), types.end(), layout.type) == types.end()) {
        return accessor.wrong("has components of type " + std::to_string(layout.type) +
                                  ", which is not read for this; export it as floats, with unsigned indices",
                              ErrorCode::kUnsupported);
    }
    layout.normalized = RELIEF_TRY(accessor.flag("normalized"));
    if (layout.normalized && (components == 1 || layout.type == kFloat)) {
        return accessor.wrong("is normalized, which only whole numbers of an attribute can be");
    }
    layout.count = RELIEF_TRY(accessorCount(accessor));
    return layout;
}

/// Calls base(elements) for the accessor's own data, if it has any, then replace(index, bytes) for each sparse element.
template <class Base, class Replace>
Result<void> forElements(const GltfValue& accessor, GltfBuffers& buffers, const Layout& layout,
                         std::uint64_t count_max, const Base& base, const Replace& replace) {
    const bool own = accessor.has("bufferView");
    const std::optional<GltfValue> sparse = RELIEF_TRY(accessor.object("sparse"));
    if (!own && !sparse) {
        return accessor.wrong("has no data of its own; export it uncompressed", ErrorCode::kUnsupported);
    }
    // Only attributes may lie apart.
    const bool strided = layout.components > 1;
    Elements elements;
    if (own) {
        elements = RELIEF_TRY(elementsOf(accessor, buffers, layout.count, layout.size(), strided));
    }
    if (layout.count > count_max) {
        return accessor.wrong("has " + std::to_string(layout.count) + " elements, more than the limit of " +
                                  std::to_string(count_max) +
                                  " for all together; simplify the mesh, or raise --max-triangles",
                              ErrorCode::kLimit);
    }
    if (own) {
        base(elements);
    }
    if (!sparse) {
        return {};
    }
    const std::uint64_t count = RELIEF_TRY(sparse->neededWhole("count"));
    const std::optional<GltfValue> indices = RELIEF_TRY(sparse->object("indices"));
    const std::optional<GltfValue> values = RELIEF_TRY(sparse->object("values"));
    if (count == 0 || count > layout.count || !indices || !values) {
        return sparse->wrong("has no indices, no values, or a count that is not 1 to the accessor's");
    }
    const std::uint64_t type = RELIEF_TRY(indices->neededWhole("componentType"));
    if (std::find(kIndexTypes.begin(), kIndexTypes.end(), type) == kIndexTypes.end()) {
        return indices->wrong("has components of type " + std::to_string(type) +
                              ", which is none for indices");
    }
    const Elements where = RELIEF_TRY(elementsOf(*indices, buffers, count, sizeOf(type), false));
    const Elements what = RELIEF_TRY(elementsOf(*values, buffers, count, layout.size(), false));
    std::uint64_t next = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t index = loadIndex(where.at(i), type);
        if (index < next || index >= layout.count) {
            return indices->wrong("are not in ascending order, or name an element that does not exist");
        }
        replace(index, what.at(i));
        next = index + 1;
    }
    return {};
}

/// All components of all elements.
Result<std::vector<float>> readFloats(const GltfValue& accessor, GltfBuffers& buffers, const Layout& layout,
                                      std::uint64_t count_max) {
    std::vector<float> values;
    const auto load = [&](const std::byte* at, std::uint64_t component) {
        return loadComponent(at + component * sizeOf(layout.type), layout.type, layout.normalized);
    };
    const auto base = [&](const Elements& elements) {
        values.reserve(layout.count * layout.components);
        for (std::uint64_t i = 0; i < layout.count; ++i) {
            for (std::uint64_t k = 0; k < layout.components; ++k) {
                values.push_back(load(elements.at(i), k));
            }
        }
    };
    const auto replace = [&](std::uint64_t index, const std::byte* at) {
        values.resize(layout.count * layout.components, 0.0F);
        for (std::uint64_t k = 0; k < layout.components; ++k) {
            values[index * layout.components + k] = load(at, k);
        }
    };
    RELIEF_TRY(forElements(accessor, buffers, layout, count_max, base, replace));
    return values;
}

}  // namespace

Result<std::uint64_t> accessorCount(const GltfValue& accessor) {
    return accessor.neededWhole("count");
}

Result<std::vector<glm::vec3>> readPositions(const GltfValue& accessor, GltfBuffers& buffers,
                                             std::uint64_t count_max) {
    const Layout layout = RELIEF_TRY(layoutOf(accessor, "VEC3", 3, kPositionTypes));
    const auto position = [&layout](const std::byte* at) {
        const std::uint64_t size = sizeOf(layout.type);
        return glm::vec3(loadComponent(at, layout.type, layout.normalized),
                         loadComponent(at + size, layout.type, layout.normalized),
                         loadComponent(at + 2 * size, layout.type, layout.normalized));
    };
    std::vector<glm::vec3> positions;
    const auto base = [&](const Elements& elements) {
        positions.reserve(layout.count);
        for (std::uint64_t i = 0; i < layout.count; ++i) {
            positions.push_back(position(elements.at(i)));
        }
    };
    const auto replace = [&](std::uint64_t index, const std::byte* at) {
        positions.resize(layout.count, glm::vec3(0.0F));
        positions[index] = position(at);
    };
    RELIEF_TRY(forElements(accessor, buffers, layout, count_max, base, replace));
    return positions;
}

Result<std::vector<std::uint32_t>> readIndices(const GltfValue& accessor, GltfBuffers& buffers,
                                               std::uint64_t count_max) {
    const Layout layout = RELIEF_TRY(layoutOf(accessor, "SCALAR", 1, kIndexTypes));
    std::vector<std::uint32_t> indices;
    const auto base = [&](const Elements& elements) {
        indices.reserve(layout.count);
        for (std::uint64_t i = 0; i < layout.count; ++i) {
            indices.push_back(loadIndex(elements.at(i), layout.type));
        }
    };
    const auto replace = [&](std::uint64_t index, const std::byte* at) {
        indices.resize(layout.count, 0);
        indices[index] = loadIndex(at, layout.type);
    };
    RELIEF_TRY(forElements(accessor, buffers, layout, count_max, base, replace));
    const std::uint32_t restart =
        std::numeric_limits<std::uint32_t>::max() >> (32U - 8U * sizeOf(layout.type));
    if (std::find(indices.begin(), indices.end(), restart) != indices.end()) {
        return accessor.wrong("holds the index " + std::to_string(restart) +
                              ", which is not allowed: it means a restart; export it with wider indices");
    }
    return indices;
}

Result<std::vector<float>> readJoints(const GltfValue& accessor, GltfBuffers& buffers,
                                      std::uint64_t count_max) {
    const Layout layout = RELIEF_TRY(layoutOf(accessor, "VEC4", 4, kJointTypes));
    if (layout.normalized) {
        return accessor.wrong("is normalized, which numbers of joints are not");
    }
    return readFloats(accessor, buffers, layout, count_max);
}

Result<std::vector<float>> readWeights(const GltfValue& accessor, GltfBuffers& buffers,
                                       std::uint64_t count_max) {
    const Layout layout = RELIEF_TRY(layoutOf(accessor, "VEC4", 4, kWeightTypes));
    if (layout.normalized != (layout.type != kFloat)) {
        return accessor.wrong("is not normalized, as weights of whole numbers are");
    }
    return readFloats(accessor, buffers, layout, count_max);
}

Result<std::vector<float>> readMatrices(const GltfValue& accessor, GltfBuffers& buffers,
                                        std::uint64_t count_max) {
    const Layout layout = RELIEF_TRY(layoutOf(accessor, "MAT4", 16, kMatrixTypes));
    return readFloats(accessor, buffers, layout, count_max);
}

}  // namespace relief
