// SPDX-License-Identifier: Apache-2.0
#include "bake/import/source_properties.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <pugixml.hpp>

#include "formats/base/text.h"

namespace relief {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t kQuotedMax = 40;  // limit for quotes from the file, in bytes
constexpr std::string_view kLodGroup = "LodGroup";
static_assert(kLodGroupMark.size() == kLodGroup.size());

bool isBinary(std::string_view text) {
    return text.starts_with("Kaydara");
}

std::uint32_t lengthAt(std::string_view text, std::size_t at) {
    std::uint32_t length = 0;
    std::memcpy(&length, text.data() + at, sizeof(length));
    return length;
}

/// A string in an FBX document: quoted text, or 'S', length and bytes.
struct FbxString {
    std::size_t begin;  ///< offset of its first byte
    std::size_t size;
};

/// Returns the string after `at`; in text, skips blanks and a comma. nullopt if there is none.
std::optional<FbxString> stringAfter(std::string_view text, std::size_t at) {
    if (isBinary(text)) {
        const bool is_string =
            at + 5 <= text.size() && text[at] == 'S' && lengthAt(text, at + 1) <= text.size() - at - 5;
        return is_string ? std::optional(FbxString{at + 5, lengthAt(text, at + 1)}) : std::nullopt;
    }
    at = text.find_first_not_of(", \t\r\n", at);
    const std::size_t end =
        at < text.size() && text[at] == '"' ? text.find('"', at + 1) : std::string_view::npos;
    return end == std::string_view::npos ? std::nullopt : std::optional(FbxString{at + 1, end - at - 1});
}

/// Returns the offset after a string, including its closing quote.
std::size_t endOf(std::string_view text, const FbxString& string) {
    return string.begin + string.size + (isBinary(text) ? 0 : 1);
}

std::string quoted(std::string_view text, std::string_view word) {
    const auto size = static_cast<std::uint32_t>(word.size());
    std::string length(sizeof(size), '\0');
    std::memcpy(length.data(), &size, sizeof(size));
    return isBinary(text) ? "S" + length + std::string(word) : "\"" + std::string(word) + "\"";
}

/// Replaces two consecutive strings with two strings of the same total length.
void replacePair(std::string& text, const FbxString& first, std::string_view new_first,
                 const FbxString& second, std::string_view new_second) {
    const std::size_t before = isBinary(text) ? 5 : 1;
    const std::size_t begin = first.begin - before;
    const std::size_t between = endOf(text, first);
    const std::string separator = text.substr(between, second.begin - before - between);
    const std::string pair = quoted(text, new_first) + separator + quoted(text, new_second);
    if (pair.size() == endOf(text, second) - begin) {
        text.replace(begin, pair.size(), pair);
    }
}

/// Changes the type of the property `name` to a number. assimp does not support the original type, also called `name`.
bool typeAsNumber(std::string& text, std::string_view name) {
    const std::string start = quoted(text, name);
    bool any = false;
    for (std::size_t at = text.find(start); at != std::string::npos; at = text.find(start, at + 1)) {
        const auto type = stringAfter(text, at + start.size());
        const auto label = type ? stringAfter(text, endOf(text, *type)) : std::nullopt;
        const auto flags = label ? stringAfter(text, endOf(text, *label)) : std::nullopt;
        if (!flags || std::string_view(text).substr(type->begin, type->size) != name) {
            continue;
        }
        const std::size_t value = endOf(text, *flags);
        const char letter = value < text.size() ? text[value] : '\0';
        const std::string_view number = !isBinary(text) || letter == 'D' || letter == 'F' ? "double"sv
                                        : letter == 'I'                                   ? "int"sv
                                                                                          : ""sv;
        if (!number.empty()) {
            replacePair(text, *type, number, *label,
                        std::string(label->size + name.size() - number.size(), ' '));
            any = true;
        }
    }
    return any;
}

/// Returns the string of a binary document that ends before `end`.
std::optional<FbxString> stringBefore(std::string_view text, std::size_t end) {
    constexpr std::size_t kNameMax = 1024;
    for (std::size_t size = 0; size + 5 <= end && size <= kNameMax; ++size) {
        if (text[end - size - 5] == 'S' && lengthAt(text, end - size - 4) == size) {
            return FbxString{end - size, size};
        }
    }
    return std::nullopt;
}

bool markLodGroups(std::string& text) {
    const bool binary = isBinary(text);
    // Inside a model's name: at the end in binary files, at the start in text files.
    const std::string_view word = binary ? "\0\1Model"sv : "\"Model::"sv;
    bool any = false;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
        const std::size_t end = at + word.size();
        const auto written = binary ? std::nullopt : stringAfter(text, at);
        const auto node_class = stringAfter(text, written ? endOf(text, *written) : end);
        if (!node_class || std::string_view(text).substr(node_class->begin, node_class->size) != kLodGroup) {
            continue;
        }
        if (const auto name = binary ? stringBefore(text, end) : written) {
            std::string marked = text.substr(name->begin, name->size);
            marked.insert(marked.size() - (binary ? word.size() : 0), kLodGroupMark);
            replacePair(text, *name, marked, *node_class, "");
            any = true;
        }
    }
    return any;
}

class ColladaReader {
  public:
    explicit ColladaReader(std::span<const std::byte> document) : text_(textOf(document)) {
        xml_.load_buffer(document.data(), document.size());
    }

    Result<ColladaNodes> read() {
        const pugi::xml_node collada = xml_.child("COLLADA");
        addIds(collada);
        std::vector<std::uint32_t> scenes;
        RELIEF_TRY(visitInstances(collada.child("scene"), scenes));
        for (std::size_t i = 0; i < elements_.size(); ++i) {
            const pugi::xml_node element = elements_[i];
            std::vector<std::uint32_t> children;
            for (const pugi::xml_node child : element.children("node")) {
                children.push_back(indexOf(child));
            }
            RELIEF_TRY(visitInstances(element, children));
            nodes_.nodes[i].children = std::move(children);
        }
        nodes_.animates_visibility = text_.find("/visibility\"") != std::string_view::npos;
        if (missing_ > 1) {
            nodes_.missing = *nodes_.missing + ", and " + std::to_string(missing_ - 1) + " more like it";
        }
        return std::move(nodes_);
    }

  private:
    /// Collects the objects that nodes may instance.
    void addIds(const pugi::xml_node& collada) {
        std::vector<pugi::xml_node> pending;
        for (const pugi::xml_node library : collada.children()) {
            for (const pugi::xml_node object : library.children()) {
                pending.push_back(object);
            }
        }
        while (!pending.empty()) {
            const pugi::xml_node object = pending.back();
            pending.pop_back();
            const std::string_view name = object.name();
            if (name != "node" && name != "visual_scene" && name != "geometry" && name != "controller") {
                continue;
            }
            objects_.emplace(object.attribute("id").value(), object);
            for (const pugi::xml_node child : object.children("node")) {
                pending.push_back(child);
            }
        }
    }

    static bool isHidden(const pugi::xml_node& node) {
        for (const pugi::xml_node extra : node.children("extra")) {
            for (const pugi::xml_node technique : extra.children("technique")) {
                const std::string_view value = trimmed(technique.child("visibility").child_value());
                if (parseDouble(value) == 0.0 || lowerCase(std::string(value)) == "false") {
                    return true;
                }
            }
        }
        return false;
    }

    /// Returns the index of a node; a new node is read later.
    std::uint32_t indexOf(const pugi::xml_node& node) {
        const auto next = static_cast<std::uint32_t>(elements_.size());
        const auto [found, added] = indices_.try_emplace(node, next);
        if (added) {
            elements_.push_back(node);
            const std::string id = node.attribute("id").value();
            const std::string name = id.empty() ? node.attribute("sid").value() : id;
            nodes_.nodes.push_back(
                {name, name.empty() ? node.attribute("name").value() : name, isHidden(node), {}});
        }
        return found->second;
    }

    /// Visits the instances of a node or of <scene>. \param children  receives the indices of instanced nodes.
    Result<void> visitInstances(const pugi::xml_node& node, std::vector<std::uint32_t>& children) {
        for (const pugi::xml_node instance : node.children()) {
            const std::string_view element = instance.name();
            if (element == "instance_geometry" || element == "instance_controller" ||
                element == "instance_node" || element == "instance_visual_scene") {
                RELIEF_TRY(visit(node, instance, instance.attribute("url").value(), children));
            }
        }
        return {};
    }

    Result<void> visit(const pugi::xml_node& node, const pugi::xml_node& instance, const std::string& url,
                       std::vector<std::uint32_t>& children) {
        if (!url.starts_with('#')) {
            return fail(ErrorCode::kUnsupported, placeOf(node, instance) + " instantiates '" +
                                                     cleanUtf8(url, kUrlMax) +
                                                     "', which is in another file; merge the files");
        }
        const auto found = objects_.find(url.substr(1));
        const pugi::xml_node object = found == objects_.end() ? pugi::xml_node() : found->second;
        if (!object) {
            return addMissing(node, instance, url, "does not exist");
        }
        const std::string_view kind = object.name();
        if (kind == "geometry") {
            return object.child("mesh") ? Result<void>() : addMissing(node, instance, url, "has no <mesh>");
        }
        if (kind == "controller") {
            const char* const source = object.child("skin").attribute("source").as_string(
                object.child("morph").attribute("source").value());
            return controllers_.insert(object).second ? visit(node, instance, source, children)
                                                      : Result<void>();
        }
        children.push_back(indexOf(object));
        return {};
    }

    Result<void> addMissing(const pugi::xml_node& node, const pugi::xml_node& instance,
                            const std::string& url, const char* what) {
        if (missing_++ == 0) {
            nodes_.missing =
                placeOf(node, instance) + " instantiates '" + cleanUtf8(url, kUrlMax) + "', which " + what;
        }
        return {};
    }

    /// Returns "line 3: the node 'x'"; without a line for UTF-16.
    [[nodiscard]] std::string placeOf(const pugi::xml_node& node, const pugi::xml_node& instance) const {
        const std::string_view before =
            text_.substr(0, static_cast<std::size_t>(std::max<std::ptrdiff_t>(instance.offset_debug(), 0)));
        const std::string line = "line " + std::to_string(1 + std::ranges::count(before, '\n')) + ": ";
        const std::string name =
            cleanUtf8(node.attribute("name").as_string(node.attribute("id").value()), kUrlMax);
        return (text_.find('\0') == std::string_view::npos ? line : "") +
               (std::string_view(node.name()) == "scene" ? "the <scene>"
                : name.empty()                           ? "a node without a name"
                                                         : "the node '" + name + "'");
    }

    static constexpr std::size_t kUrlMax = 100;  // bytes in messages

    std::string_view text_;
    pugi::xml_document xml_;
    ColladaNodes nodes_;
    std::map<std::string, pugi::xml_node> objects_;  // by id
    std::map<pugi::xml_node, std::uint32_t> indices_;
    std::vector<pugi::xml_node> elements_;  // by index
    std::set<pugi::xml_node> controllers_;  // already visited
    std::uint64_t missing_ = 0;
};

/// Collects the hidden objects of a 3DS file.
/// \param text    the chunks inside a chunk `parent`.
/// \param object  name of the object that they describe.
void addHidden3ds(std::string_view text, std::uint16_t parent, const std::string& object,
                  std::set<std::string>& hidden) {
    constexpr std::size_t kHeader = 6;
    constexpr std::uint16_t kMain = 0x4D4D;
    constexpr std::uint16_t kEditor = 0x3D3D;
    constexpr std::uint16_t kObject = 0x4000;
    constexpr std::uint16_t kHidden = 0x4010;
    while (text.size() >= kHeader) {
        std::uint16_t id = 0;
        std::memcpy(&id, text.data(), sizeof(id));
        const std::size_t size = lengthAt(text, sizeof(id));
        if (size < kHeader || size > text.size()) {
            return;
        }
        const std::string_view inside = text.substr(kHeader, size - kHeader);
        text.remove_prefix(size);
        if ((parent == 0 && id == kMain) || (parent == kMain && id == kEditor)) {
            addHidden3ds(inside, id, "", hidden);
        } else if (parent == kEditor && id == kObject) {
            const std::string name(inside.substr(0, inside.find('\0')));
            addHidden3ds(inside.substr(std::min(inside.size(), name.size() + 1)), id, name, hidden);
        } else if (parent == kObject && id == kHidden) {
            hidden.insert(object);
        }
    }
}

/// Parses the whole text, ignoring surrounding white space, as a finite number.
std::optional<double> finiteNumber(std::string_view text) {
    const std::string_view word = popWord(text);
    const std::optional<double> value = popWord(text).empty() ? parseDouble(word) : std::nullopt;
    return value && std::isfinite(*value) ? value : std::nullopt;
}

/// Reads the type letter and the number of a property in a binary FBX document.
FbxUnit binaryUnit(std::string_view text) {
    const auto load = [&text](auto value) {
        if (text.size() > sizeof(value)) {
            std::memcpy(&value, text.data() + 1, sizeof(value));
        }
        return value;
    };
    const char type = text.empty() ? '\0' : text[0];
    const double value = type == 'D'   ? load(std::nan(""))
                         : type == 'F' ? static_cast<double>(load(0.0F))
                         : type == 'I' ? static_cast<double>(load(std::int32_t{0}))
                         : type == 'Y' ? static_cast<double>(load(std::int16_t{0}))
                         : type == 'L' ? static_cast<double>(load(std::int64_t{0}))
                                       : std::nan("");
    return {shortest(static_cast<float>(value)), std::isfinite(value) ? std::optional(value) : std::nullopt};
}

}  // namespace

std::optional<std::vector<std::byte>> patchedFbx(std::span<const std::byte> document) {
    std::string text(textOf(document));
    const bool typed = typeAsNumber(text, "Visibility");
    const bool inherits = typeAsNumber(text, "Visibility Inheritance");
    if (!markLodGroups(text) && !typed && !inherits) {
        return std::nullopt;
    }
    const auto bytes = std::as_bytes(std::span(text));
    return std::vector<std::byte>(bytes.begin(), bytes.end());
}

bool fbxAnimatesVisibility(std::span<const std::byte> document) {
    const std::string_view text = textOf(document);
    return text.find(isBinary(text) ? "Visibility\0\1AnimCurveNode"sv : "\"AnimCurveNode::Visibility\""sv) !=
           std::string_view::npos;
}

Result<ColladaNodes> readColladaNodes(std::span<const std::byte> document) {
    return ColladaReader(document).read();
}

std::set<std::string> hiddenObjectsOf3ds(std::span<const std::byte> document) {
    std::set<std::string> hidden;
    addHidden3ds(textOf(document), 0, "", hidden);
    return hidden;
}

std::optional<FbxUnit> fbxUnit(std::span<const std::byte> document) {
    const std::string_view text = textOf(document);
    const std::string name = quoted(text, "UnitScaleFactor");
    const std::size_t at = text.find(name);
    if (at == std::string_view::npos) {
        return std::nullopt;
    }
    // The value follows the strings type, label and flags; older text files have no label.
    std::size_t value = at + name.size();
    for (int i = 0; i < 3; ++i) {
        const auto string = stringAfter(text, value);
        value = string ? endOf(text, *string) : value;
    }
    std::string_view rest = text.substr(value);
    if (isBinary(text)) {
        return binaryUnit(rest);
    }
    rest = popLine(rest);
    rest.remove_prefix(std::min(rest.find_first_not_of(", \t"), rest.size()));
    return FbxUnit{cleanUtf8(trimmed(rest).substr(0, kQuotedMax)), finiteNumber(rest)};
}

SourceFrame colladaFrame(std::span<const std::byte> document) {
    SourceFrame frame{1.0, UpAxis::kPlusY};
    pugi::xml_document xml;
    xml.load_buffer(document.data(), document.size());
    const pugi::xml_node asset = xml.child("COLLADA").child("asset");
    const std::string meter = asset.child("unit").attribute("meter").as_string("1");
    // Some locales write a comma; assimp reads it as a point.
    std::string point = meter;
    std::replace(point.begin(), point.end(), ',', '.');
    frame.metres = finiteNumber(point);
    if (!frame.metres || !(*frame.metres > 0.0)) {
        frame.metres.reset();
        frame.unit_fault = "its unit is '" + cleanUtf8(std::string_view(meter).substr(0, kQuotedMax)) +
                           "' metres, which is not a length";
    }
    std::string_view rest = asset.child("up_axis").child_value();
    const std::string_view axis = popWord(rest);
    if (axis == "X_UP" || axis == "Z_UP") {
        frame.up = axis == "X_UP" ? UpAxis::kPlusX : UpAxis::kPlusZ;
    } else if (!axis.empty() && axis != "Y_UP") {
        frame.up.reset();
        frame.up_fault =
            "its up_axis '" + cleanUtf8(axis.substr(0, kQuotedMax)) + "' is not an axis of COLLADA";
    }
    return frame;
}

}  // namespace relief
