#include <zip.h>

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <memory>
#include <pugixml.hpp>
#include <set>
#include <utility>

#include "bake/import/import_readers.h"
#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::string_view kModelRelation = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
/// Extensions that a model may require: Relief reads them, or they change no surface.
constexpr std::array<std::string_view, 4> kKnownExtensions = {
    "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07"};
constexpr std::size_t kQuotedMax = 80;  // bytes of the file shown in a message

// --- the archive ---

class Archive {
  public:
    /// \param bytes  borrowed.
    explicit Archive(std::span<const std::byte> bytes) : zip_(nullptr, zip_discard) {
        zip_source_t* const source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, nullptr);
        zip_.reset(zip_open_from_source(source, ZIP_RDONLY, nullptr));
        if (zip_ == nullptr) {
            zip_source_free(source);
        }
    }

    [[nodiscard]] bool isOpen() const { return zip_ != nullptr; }

    /// A file of the archive. \param path  from its root.
    [[nodiscard]] Result<std::string> read(std::string_view path) const {
        const std::string name(path.substr(path.starts_with('/') ? 1 : 0));
        const std::string shown = "'" + cleanUtf8(name, kQuotedMax) + "' of its archive ";
        const zip_int64_t index = zip_name_locate(zip_.get(), name.c_str(), ZIP_FL_NOCASE);
        if (index < 0) {
            return invalidInput(shown + "does not exist");
        }
        const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> file(
            zip_fopen_index(zip_.get(), static_cast<zip_uint64_t>(index), 0), zip_fclose);
        std::string bytes;
        std::array<char, 1 << 16> block{};
        zip_int64_t got = file == nullptr ? -1 : 1;
        while (got > 0) {
            got = zip_fread(file.get(), block.data(), block.size());
            bytes.append(block.data(), static_cast<std::size_t>(std::max<zip_int64_t>(got, 0)));
        }
        // The checksum is looked at behind the last byte.
        return got == 0 ? Result<std::string>(std::move(bytes))
                        : invalidInput(shown + "is damaged, encrypted, or packed in a way that is not read");
    }

  private:
    std::unique_ptr<zip_t, void (*)(zip_t*)> zip_;
};

// --- models ---

std::string_view local(std::string_view name) {
    return name.substr(name.find(':') + 1);  // npos + 1 is 0
}

/// Whatever its prefix is. nullptr without one.
const char* attribute(pugi::xml_node node, std::string_view name) {
    for (const pugi::xml_attribute& one : node.attributes()) {
        if (local(one.name()) == name && !std::string_view(one.name()).starts_with("xmlns:")) {
            return one.value();
        }
    }
    return nullptr;
}

std::string textOf(pugi::xml_node node, std::string_view name, const char* otherwise = "") {
    const char* const text = attribute(node, name);
    return text != nullptr ? text : otherwise;
}

/// The children of that name, whatever their prefix is.
std::vector<pugi::xml_node> all(pugi::xml_node parent, std::string_view name) {
    std::vector<pugi::xml_node> found;
    for (const pugi::xml_node child : parent.children()) {
        if (local(child.name()) == name) {
            found.push_back(child);
        }
    }
    return found;
}

pugi::xml_node only(pugi::xml_node parent, std::string_view name) {
    return parent.find_child([name](pugi::xml_node child) { return local(child.name()) == name; });
}

/// Gathered over all models.
struct Models {
    using Place = std::pair<std::string, std::string>;  ///< of an object: its model and its id there

    ImportScene scene;
    std::map<Place, std::uint32_t> objects;  ///< nodes
    struct Use {
        std::optional<std::uint32_t> in;  ///< an object; nullopt: the scene
        Place of;
        std::optional<Transform> transform;
    };
    std::vector<Use> uses;
    bool support = false;  ///< some is left out, as is the next
    bool beams = false;
};

/// Reads one model of the archive.
class ModelReader {
  public:
    /// \param path  of the model. \param root  whether its <build> is the scene.
    ModelReader(const std::string& text, const std::string& path, bool root, Models& models)
        : text_(text), path_(path), root_(root), models_(models) {}

    Result<void> run() {
        pugi::xml_document document;
        const pugi::xml_parse_result parsed = document.load_buffer(text_.data(), text_.size());
        if (!parsed) {
            return wrong(parsed.offset, std::string("its XML is damaged (") + parsed.description() + ")");
        }
        const pugi::xml_node model = document.document_element();
        RELIEF_TRY(readHead(model));
        const pugi::xml_node resources = only(model, "resources");
        for (const pugi::xml_node group : all(resources, "basematerials")) {
            for (const pugi::xml_node base : all(group, "base")) {
                materials_[textOf(group, "id")].push_back(textOf(base, "name"));
            }
        }
        for (const pugi::xml_node object : all(resources, "object")) {
            RELIEF_TRY(readObject(object));
        }
        if (root_) {
            for (const pugi::xml_node item : all(only(model, "build"), "item")) {
                RELIEF_TRY(addUse(item, std::nullopt));
            }
        }
        return {};
    }

  private:
    /// \param offset  of the text, or -1.
    [[nodiscard]] tl::unexpected<Error> wrong(std::ptrdiff_t offset, const std::string& what) const {
        const std::string before =
            text_.substr(0, static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
        return invalidInput(cleanUtf8(path_, kQuotedMax) + ", line " +
                            std::to_string(std::count(before.begin(), before.end(), '\n') + 1) + ": " + what);
    }
    [[nodiscard]] tl::unexpected<Error> wrong(pugi::xml_node node, const std::string& what) const {
        return wrong(node.offset_debug(), what);
    }

    Result<void> readHead(pugi::xml_node model) {
        if (local(model.name()) != "model") {
            return wrong(model, "the root is <" + cleanUtf8(model.name(), kQuotedMax) + ">, not <model>");
        }
        const SourceFrame frame = frameOfUnitName(textOf(model, "unit", "millimeter"));
        if (root_) {
            models_.scene.frame = frame;
        } else if (frame.metres != models_.scene.frame.metres) {
            return wrong(model, "the models have different units; export it again in one model");
        }
        const std::string required = textOf(model, "requiredextensions");
        std::string_view rest = required;
        for (std::string_view prefix = takeWord(rest); !prefix.empty(); prefix = takeWord(rest)) {
            const std::string uri = model.attribute(("xmlns:" + std::string(prefix)).c_str())
                                        .as_string(std::string(prefix).c_str());
            if (std::find(kKnownExtensions.begin(), kKnownExtensions.end(), uri) == kKnownExtensions.end()) {
                return fail(ErrorCode::kUnsupported,
                            "its extension '" + cleanUtf8(uri, kQuotedMax) +
                                "' is required and not read; export it as plain triangles");
            }
        }
        return {};
    }

    Result<void> readObject(pugi::xml_node object) {
        const std::string id = textOf(object, "id");
        const auto index = static_cast<std::uint32_t>(models_.scene.nodes.size());
        if (!models_.objects.emplace(Models::Place(path_, id), index).second) {
            return wrong(object, "there is another object with the id '" + cleanUtf8(id, kQuotedMax) + "'");
        }
        SceneNode& node = models_.scene.nodes.emplace_back();
        node.names = {id, textOf(object, "name"), textOf(object, "partnumber")};
        node.shown = node.names[1].empty() ? id : node.names[1];
        const std::string type = textOf(object, "type");
        if (type == "support" || type == "solidsupport") {
            models_.support = true;
        } else {
            RELIEF_TRY(readMesh(object, index));
        }
        for (const pugi::xml_node component : all(only(object, "components"), "component")) {
            RELIEF_TRY(addUse(component, index));
        }
        return {};
    }

    Result<void> readMesh(pugi::xml_node object, std::uint32_t node) {
        const pugi::xml_node mesh = only(object, "mesh");
        if (only(mesh, "beamlattice") && !std::exchange(models_.beams, true)) {
            models_.scene.warnings.emplace_back("left out its beam lattices: only triangles have a surface");
        }
        std::vector<glm::vec3> positions;
        for (const pugi::xml_node vertex : all(only(mesh, "vertices"), "vertex")) {
            const double x = RELIEF_TRY(number(vertex, "x"));
            const double y = RELIEF_TRY(number(vertex, "y"));
            const double z = RELIEF_TRY(number(vertex, "z"));
            positions.emplace_back(x, y, z);
        }
        constexpr std::array<const char*, 3> kNames = {"v1", "v2", "v3"};
        std::vector<bool> used(positions.size());
        std::map<std::string, ScenePart> parts;
        std::vector<std::string> order;
        for (const pugi::xml_node triangle : all(only(mesh, "triangles"), "triangle")) {
            const std::string name = materialOf(triangle, object);
            const auto [part, added] = parts.try_emplace(name);
            if (added) {
                order.push_back(name);
            }
            glm::uvec3& corners = part->second.triangles.emplace_back();
            for (int i = 0; i < 3; ++i) {
                corners[i] = RELIEF_TRY(corner(triangle, kNames.at(static_cast<std::size_t>(i)), used));
            }
        }
        for (const std::string& name : order) {
            ScenePart& part = parts[name];
            models_.scene.counts.polygons += part.triangles.size();
            compact(positions, part);
            part.material = name;
            part.names = {name};
            models_.scene.nodes[node].parts.push_back(static_cast<std::uint32_t>(models_.scene.parts.size()));
            models_.scene.parts.push_back(std::move(part));
        }
        const auto unused = static_cast<std::uint64_t>(std::count(used.begin(), used.end(), false));
        models_.scene.counts.vertices += used.size();
        models_.scene.counts.unused += unused;
        models_.scene.counts.loose += unused;
        return {};
    }

    Result<std::uint32_t> corner(pugi::xml_node triangle, const char* name, std::vector<bool>& used) const {
        const std::string word = textOf(triangle, name);
        const std::optional<std::uint64_t> index = parseUnsigned(word);
        if (!index) {
            return wrong(triangle, "a triangle's " + std::string(name) + " is '" +
                                       cleanUtf8(word, kQuotedMax) + "', which is no index of a vertex");
        }
        if (*index >= used.size()) {
            return wrong(triangle, "a triangle uses vertex " + std::to_string(*index) + " of " +
                                       std::to_string(used.size()) + " from 0 on; export it again");
        }
        used[*index] = true;
        return static_cast<std::uint32_t>(*index);
    }

    /// The name of a triangle's material; "" for a colour, or a place of a texture.
    std::string materialOf(pugi::xml_node triangle, pugi::xml_node object) const {
        const char* const own = attribute(triangle, "p1");
        const char* const group = own != nullptr ? attribute(triangle, "pid") : nullptr;
        const auto names = materials_.find(group != nullptr ? group : textOf(object, "pid"));
        const std::uint64_t index =
            parseUnsigned(own != nullptr ? own : textOf(object, "pindex", "0")).value_or(0);
        return names != materials_.end() && index < names->second.size() ? names->second[index]
                                                                         : std::string();
    }

    Result<void> addUse(pugi::xml_node place, std::optional<std::uint32_t> in) {
        // The path of the production extension; without it, the object is in the same model.
        Models::Use use{in, {textOf(place, "path", path_.c_str()), textOf(place, "objectid")}, {}};
        use.of.first.insert(0, use.of.first.starts_with('/') ? "" : "/");
        if (attribute(place, "transform") != nullptr) {
            use.transform = RELIEF_TRY(transformOf(place));
        }
        models_.uses.push_back(std::move(use));
        return {};
    }

    /// Twelve numbers, row by row, of a matrix that a row vector is multiplied with.
    Result<Transform> transformOf(pugi::xml_node place) const {
        const std::string text = textOf(place, "transform");
        std::string_view rest = text;
        std::array<double, 12> m{};
        for (double& value : m) {
            const std::string_view word = takeWord(rest);
            const std::optional<double> number = finiteNumber(word);
            if (!number) {
                return wrong(place,
                             word.empty() ? "a transform has fewer than 12 numbers" : noFiniteNumber(word));
            }
            value = *number;
        }
        if (!takeWord(rest).empty()) {
            return wrong(place, "a transform has more than 12 numbers");
        }
        return Transform{{{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}}, {m[9], m[10], m[11]}};
    }

    [[nodiscard]] Result<double> number(pugi::xml_node vertex, const char* name) const {
        const char* const text = attribute(vertex, name);
        if (text == nullptr) {
            return wrong(vertex, "a vertex has no " + std::string(name));
        }
        const std::optional<double> value = finiteNumber(text);
        return value ? Result<double>(*value) : wrong(vertex, noFiniteNumber(text));
    }

    const std::string& text_;
    const std::string& path_;
    bool root_;
    Models& models_;
    std::map<std::string, std::vector<std::string>> materials_;  // names, by their groups
};

/// The path of the model that the archive begins with.
Result<std::string> rootModel(const Archive& archive) {
    const std::string relations = RELIEF_TRY(archive.read("_rels/.rels"));
    pugi::xml_document document;
    if (!document.load_buffer(relations.data(), relations.size())) {
        return invalidInput("the XML of its _rels/.rels is damaged; export it again");
    }
    for (const pugi::xml_node relation : document.document_element().children()) {
        if (local(relation.name()) == "Relationship" && textOf(relation, "Type") == kModelRelation) {
            const std::string target = textOf(relation, "Target");
            return target.starts_with('/') ? target : "/" + target;
        }
    }
    return invalidInput("its archive names no model");
}

/// Places the objects, which may be named before they are there.
Result<ImportScene> connected(Models& models) {
    ImportScene& scene = models.scene;
    for (const Models::Use& use : models.uses) {
        const auto found = models.objects.find(use.of);
        if (found == models.objects.end()) {
            return invalidInput("the object '" + cleanUtf8(use.of.second, kQuotedMax) + "', which " +
                                cleanUtf8(use.of.first, kQuotedMax) + " should have, does not exist");
        }
        const auto place = static_cast<std::uint32_t>(scene.nodes.size());
        (use.in ? scene.nodes[*use.in].children : scene.roots).push_back(place);
        scene.nodes.push_back({.transform = use.transform, .children = {found->second}});
    }
    if (models.support) {
        scene.warnings.emplace_back("left out what supports it while it is printed");
    }
    return std::move(scene);
}

}  // namespace

Result<ImportScene> read3mf(std::span<const std::byte> bytes) {
    const Archive archive(bytes);
    if (!archive.isOpen()) {
        return invalidInput("it is no ZIP archive, or was cut off; copy or export it again");
    }
    std::deque<std::string> paths = {RELIEF_TRY(rootModel(archive))};
    std::set<std::string> known(paths.begin(), paths.end());
    Models models;
    for (std::size_t uses = 0; !paths.empty(); paths.pop_front()) {
        const std::string model = RELIEF_TRY(archive.read(paths.front()));
        RELIEF_TRY(ModelReader(model, paths.front(), known.size() == 1, models).run());
        for (; uses < models.uses.size(); ++uses) {
            if (known.insert(models.uses[uses].of.first).second) {
                paths.push_back(models.uses[uses].of.first);
            }
        }
    }
    return connected(models);
}

}  // namespace relief
