#include "bake/import/import_gltf.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "formats/base/text.h"

namespace relief {
namespace {

using Json = nlohmann::json;

constexpr int kJsonDepthMax = 256;
constexpr std::uint64_t kNumberMax = std::uint64_t{1} << 53;

// Required extensions that change no position, or that assimp decodes (Draco).
constexpr std::array<std::string_view, 8> kHarmless = {
    "KHR_draco_mesh_compression", "KHR_texture_transform", "KHR_technique_webgl", "KHR_techniques_webgl",
    "KHR_texture_basisu",         "KHR_lights_punctual",   "EXT_texture_webp",    "MSFT_texture_dds"};

/// Thrown and caught in this file: checks are many and deep.
struct Refusal {
    ErrorCode code;
    std::string what;
};

[[noreturn]] void invalid(const std::string& what) {
    throw Refusal{ErrorCode::kInvalidInput, what};
}

/// The JSON text: the file's, or a .glb's first chunk.
std::string_view jsonText(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (!text.starts_with("glTF")) {
        return text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text;
    }
    std::array<std::uint32_t, 5> header{};  // magic, version, length; the chunk's length and type
    if (bytes.size() < sizeof(header)) {
        invalid("the file is cut off");
    }
    std::memcpy(header.data(), bytes.data(), sizeof(header));
    if (header[1] != 2) {
        throw Refusal{ErrorCode::kUnsupported, "binary glTF of version " + std::to_string(header[1]) +
                                                   " is not read; save it as glTF 2.0"};
    }
    if (header[4] != 0x4E4F534AU || header[3] > bytes.size() - sizeof(header)) {
        invalid("the file is cut off, or its first chunk is no JSON");
    }
    return text.substr(sizeof(header), header[3]);
}

/// The callback of the parser. It refuses deep nesting, because other parsers, and documents, recurse.
bool checkDepth(int depth, Json::parse_event_t event, Json& /*parsed*/) {
    using Event = Json::parse_event_t;
    if (depth >= kJsonDepthMax && (event == Event::object_start || event == Event::array_start)) {
        throw Refusal{ErrorCode::kLimit,
                      "its JSON is nested more than " + std::to_string(kJsonDepthMax) + " deep"};
    }
    return true;
}

class GltfCheck {
  public:
    explicit GltfCheck(Json document) : document_(std::move(document)) {}

    std::vector<std::string> run() {
        checkVersion();
        checkExtensions();
        checkBuffers();
        checkMeshes();
        checkNodes();
        warnOfUnplacedMeshes();
        return std::move(warnings_);
    }

  private:
    /// A member that must be an array if it is there; an empty one otherwise.
    static const Json& list(const Json& object, const char* name) {
        static const Json kEmpty = Json::array();
        const auto found = object.find(name);
        if (found == object.end()) {
            return kEmpty;
        }
        if (!found->is_array()) {
            invalid(std::string(name) + " is not an array");
        }
        return *found;
    }
    static std::optional<std::uint64_t> number(const Json& object, const char* name) {
        const auto found = object.find(name);
        if (found == object.end()) {
            return std::nullopt;
        }
        // 24.0 is a whole number to JSON.
        if (found->is_number_unsigned() && found->get<std::uint64_t>() <= kNumberMax) {
            return found->get<std::uint64_t>();
        }
        if (found->is_number_float()) {
            const double value = found->get<double>();
            if (value >= 0.0 && value <= static_cast<double>(kNumberMax) &&
                value == static_cast<double>(static_cast<std::uint64_t>(value))) {
                return static_cast<std::uint64_t>(value);
            }
        }
        invalid(std::string(name) + " is not a whole number");
    }
    static std::uint64_t needed(const Json& object, const char* name, const std::string& where) {
        const std::optional<std::uint64_t> value = number(object, name);
        if (!value) {
            invalid(where + " has no " + name);
        }
        return *value;
    }
    const Json& element(const char* name, std::uint64_t index, const std::string& where) const {
        const Json& all = list(document_, name);
        if (index >= all.size() || !all[index].is_object()) {
            invalid(where + " names " + name + "[" + std::to_string(index) + "], which does not exist");
        }
        return all[index];
    }
    void warn(const std::string& text) {
        if (std::find(warnings_.begin(), warnings_.end(), text) == warnings_.end()) {
            warnings_.push_back(text);
        }
    }

    void checkVersion() const {
        if (!document_.is_object()) {
            invalid("its JSON is no object");
        }
        const auto asset = document_.find("asset");
        const bool has = asset != document_.end() && asset->is_object() && asset->contains("version") &&
                         (*asset)["version"].is_string();
        const std::string version = has ? (*asset)["version"].get<std::string>() : "";
        if (!version.starts_with("2.")) {
            throw Refusal{
                has ? ErrorCode::kUnsupported : ErrorCode::kInvalidInput,
                has ? "glTF of version '" + cleanUtf8(version, 20) + "' is not read; save it as glTF 2.0"
                    : "it names no glTF version"};
        }
    }

    void checkExtensions() {
        for (const Json& name : list(document_, "extensionsRequired")) {
            const std::string text = name.is_string() ? name.get<std::string>() : "";
            const bool harmless = text.starts_with("KHR_materials_") || text.starts_with("KHR_xmp") ||
                                  std::find(kHarmless.begin(), kHarmless.end(), text) != kHarmless.end();
            if (!harmless) {
                throw Refusal{ErrorCode::kUnsupported, "it requires the extension '" + cleanUtf8(text, 100) +
                                                           "', which is not read; export it without"};
            }
        }
        for (const Json& name : list(document_, "extensionsUsed")) {
            if (name.is_string() && name.get<std::string>() == "EXT_mesh_gpu_instancing") {
                warn("instances by EXT_mesh_gpu_instancing are left out; export them as nodes");
            }
        }
    }

    void checkBuffers() const {
        for (const Json& buffer : list(document_, "buffers")) {
            const auto uri = buffer.is_object() ? buffer.find("uri") : buffer.end();
            if (!buffer.is_object() || uri == buffer.end()) {
                continue;
            }
            if (!uri->is_string()) {
                invalid("the uri of a buffer is no string");
            }
            const std::string text = uri->get<std::string>();
            if (text.starts_with("data:")) {
                continue;
            }
            const std::vector<std::string_view> parts = split(text, '/');
            if (text.empty() || text.starts_with('/') || text.starts_with('\\') ||
                text.find(':') != std::string::npos ||
                std::find(parts.begin(), parts.end(), "..") != parts.end()) {
                invalid("it refers to '" + cleanUtf8(text, 200) +
                        "', which is not below its folder; put the buffer beside it");
            }
        }
        std::size_t index = 0;
        for (const Json& view : list(document_, "bufferViews")) {
            const std::string where = "bufferViews[" + std::to_string(index++) + "]";
            if (!view.is_object()) {
                invalid(where + " is no object");
            }
            const Json& buffer = element("buffers", needed(view, "buffer", where), where);
            const std::uint64_t end =
                number(view, "byteOffset").value_or(0) + needed(view, "byteLength", where);
            if (end > needed(buffer, "byteLength", "its buffer")) {
                invalid(where + " ends behind its buffer");
            }
        }
    }

    /// \param types  component types that are read.
    void checkAccessor(std::uint64_t index, const std::string& type, std::span<const std::uint64_t> types,
                       std::uint64_t components) const {
        const std::string where = "accessors[" + std::to_string(index) + "]";
        const Json& accessor = element("accessors", index, "a primitive");
        if (accessor.contains("sparse")) {
            throw Refusal{ErrorCode::kUnsupported,
                          where + " is sparse, which is not read; export it without sparse accessors"};
        }
        if (!accessor.contains("type") || accessor["type"] != type) {
            invalid(where + " is not of type " + type);
        }
        const std::uint64_t component = needed(accessor, "componentType", where);
        if (std::find(types.begin(), types.end(), component) == types.end()) {
            throw Refusal{ErrorCode::kUnsupported, where + " has components of type " +
                                                       std::to_string(component) +
                                                       ", which is not read for this (quantised?); export it "
                                                       "as floats, with unsigned indices"};
        }
        const std::uint64_t size = components * (component == 5121 ? 1U : component == 5123 ? 2U : 4U);
        const std::uint64_t count = needed(accessor, "count", where);
        const std::optional<std::uint64_t> view_index = number(accessor, "bufferView");
        if (!view_index) {
            throw Refusal{ErrorCode::kUnsupported, where + " has no data of its own; export it uncompressed"};
        }
        const Json& view = element("bufferViews", *view_index, where);
        if (view.contains("extensions") && view["extensions"].is_object() &&
            view["extensions"].contains("EXT_meshopt_compression")) {
            throw Refusal{
                ErrorCode::kUnsupported,
                "it is compressed by EXT_meshopt_compression, which is not read; export it without"};
        }
        const std::uint64_t stride = number(view, "byteStride").value_or(size);
        const std::uint64_t offset = number(accessor, "byteOffset").value_or(0);
        const std::uint64_t length = needed(view, "byteLength", where);
        // Divided, not multiplied: no overflow.
        const bool fits = count == 0 || (offset <= length && size <= length - offset && stride >= size &&
                                         count - 1 <= (length - offset - size) / stride);
        if (!fits) {
            invalid(where + " ends behind its buffer view");
        }
    }

    void checkPrimitive(const Json& primitive) {
        if (!primitive.is_object() || !primitive.contains("attributes") ||
            !primitive["attributes"].is_object()) {
            invalid("a primitive has no attributes");
        }
        if (!list(primitive, "targets").empty()) {
            warn("it is morphed; baked as it is modelled, without its targets");
        }
        const bool draco = primitive.contains("extensions") && primitive["extensions"].is_object() &&
                           primitive["extensions"].contains("KHR_draco_mesh_compression");
        if (draco) {
            return;  // its accessors only describe what the decoder will find
        }
        const std::optional<std::uint64_t> positions = number(primitive["attributes"], "POSITION");
        if (!positions) {
            return;
        }
        constexpr std::array<std::uint64_t, 1> kFloat = {5126};
        constexpr std::array<std::uint64_t, 3> kIndexTypes = {5121, 5123, 5125};
        checkAccessor(*positions, "VEC3", kFloat, 3);
        if (const std::optional<std::uint64_t> indices = number(primitive, "indices")) {
            checkAccessor(*indices, "SCALAR", kIndexTypes, 1);
        }
    }

    void checkMeshes() {
        for (const Json& mesh : list(document_, "meshes")) {
            if (!mesh.is_object()) {
                invalid("a mesh is no object");
            }
            for (const Json& primitive : list(mesh, "primitives")) {
                checkPrimitive(primitive);
            }
        }
    }

    /// A node with two parents would be there twice for each node on the way, 2ⁿ times in n nodes.
    void checkNodes() {
        const Json& nodes = list(document_, "nodes");
        std::vector<std::uint32_t> parents(nodes.size(), 0);
        for (const Json& node : nodes) {
            if (!node.is_object()) {
                invalid("a node is no object");
            }
            if (node.contains("skin") && node.contains("mesh")) {
                warn("it is skinned; baked as it is modelled, without its skeleton");
            }
            for (const Json& child : list(node, "children")) {
                if (!child.is_number_unsigned() || child.get<std::uint64_t>() >= nodes.size()) {
                    invalid("a node names a child that does not exist");
                }
                if (++parents[child.get<std::uint64_t>()] > 1) {
                    invalid("nodes[" + std::to_string(child.get<std::uint64_t>()) +
                            "] has two parents; nodes must form trees");
                }
            }
        }
        // Each node has at most one parent, so a node that no root leads to is part of a ring.
        std::vector<std::uint64_t> open;
        for (std::uint64_t i = 0; i < parents.size(); ++i) {
            if (parents[i] == 0) {
                open.push_back(i);
            }
        }
        std::size_t reached = 0;
        while (!open.empty()) {
            const std::uint64_t node = open.back();
            open.pop_back();
            ++reached;
            for (const Json& child : list(nodes[node], "children")) {
                open.push_back(child.get<std::uint64_t>());
            }
        }
        if (reached != nodes.size()) {
            invalid("its nodes are their own parents; nodes must form trees");
        }
        for (const Json& scene : list(document_, "scenes")) {
            std::vector<std::uint64_t> roots;
            if (!scene.is_object()) {
                invalid("a scene is no object");
            }
            for (const Json& root : list(scene, "nodes")) {
                if (!root.is_number_unsigned() || root.get<std::uint64_t>() >= nodes.size() ||
                    parents[root.get<std::uint64_t>()] != 0) {
                    invalid("a scene names a node that does not exist, or that has a parent");
                }
                roots.push_back(root.get<std::uint64_t>());
            }
            std::sort(roots.begin(), roots.end());
            if (std::adjacent_find(roots.begin(), roots.end()) != roots.end()) {
                invalid("a scene names a node twice");
            }
        }
    }

    /// assimp reads what the scene shows, and no other mesh. Nodes form trees: checkNodes.
    void warnOfUnplacedMeshes() {
        const Json& nodes = list(document_, "nodes");
        const Json& scenes = list(document_, "scenes");
        const std::uint64_t shown = number(document_, "scene").value_or(0);
        if (shown >= scenes.size()) {
            return;
        }
        std::vector<bool> placed(list(document_, "meshes").size(), false);
        std::vector<std::uint64_t> open;
        const auto open_all = [&open](const Json& indices) {
            for (const Json& index : indices) {
                open.push_back(index.get<std::uint64_t>());
            }
        };
        open_all(list(scenes[shown], "nodes"));
        while (!open.empty()) {
            const Json& node = nodes[open.back()];
            open.pop_back();
            if (const auto mesh = number(node, "mesh"); mesh && *mesh < placed.size()) {
                placed[*mesh] = true;
            }
            open_all(list(node, "children"));
        }
        if (const auto left = std::count(placed.begin(), placed.end(), false); left > 0) {
            warn("left out " + std::to_string(left) + " of its " + std::to_string(placed.size()) +
                 " meshes: its scene does not show them");
        }
    }

    Json document_;
    std::vector<std::string> warnings_;
};

}  // namespace

Result<std::vector<std::string>> checkGltf(std::span<const std::byte> bytes, const std::string& shown) {
    const auto refused = [&shown](ErrorCode code, const std::string& what) {
        return fail(code,
                    "cannot read the mesh " + shown + ": " + what +
                        (what.find(';') == std::string::npos ? "; repair the file or export it again" : ""));
    };
    try {
        const std::string_view text = jsonText(bytes);
        Json document = Json::parse(text.begin(), text.end(), checkDepth, false);
        if (document.is_discarded()) {
            return refused(ErrorCode::kInvalidInput, "it is no valid JSON");
        }
        return GltfCheck(std::move(document)).run();
    } catch (const Refusal& refusal) {
        return refused(refusal.code, refusal.what);
    } catch (const Json::exception& error) {
        return refused(ErrorCode::kInvalidInput, cleanUtf8(error.what(), 200));
    }
}

}  // namespace relief
