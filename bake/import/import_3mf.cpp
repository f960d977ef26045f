#include "bake/import/import_readers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <map>
#include <set>
#include <utility>

#include "bake/import/import_numbers.h"
#include "bake/import/import_xml.h"
#include "bake/import/import_zip.h"
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

/// A model or another part of the archive. \param path  from the archive's root.
Result<std::vector<std::byte>> partOf(const ZipArchive& archive, std::string_view path) {
    return archive.read(path.substr(path.starts_with('/') ? 1 : 0));
}

/// An object by the model that it is in and its id there.
using Place = std::pair<std::string, std::string>;

/// Gathered over all models.
struct Models {
    AssemblyFile file;
    std::map<Place, std::size_t> objects;
    struct Use {
        std::optional<std::size_t> in;  ///< an object; nullopt: the scene
        Place of;
        Transform transform;
    };
    std::vector<Use> uses;
    bool support = false;  ///< some is left out
};

/// Twelve numbers, row by row, of a matrix that a row vector is multiplied with.
Result<Transform> transformOf(std::string_view text) {
    std::array<double, 12> m{};
    std::string_view rest = text;
    for (double& value : m) {
        const std::string_view word = takeWord(rest);
        const std::optional<double> number = finiteNumber(word);
        if (word.empty()) {
            return invalidInput("a transform has fewer than 12 numbers");
        }
        if (!number) {
            return invalidInput(noFiniteNumber(word));
        }
        value = *number;
    }
    if (!takeWord(rest).empty()) {
        return invalidInput("a transform has more than 12 numbers");
    }
    return Transform{{{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}}, {m[9], m[10], m[11]}};
}

/// Reads one model of the archive.
class ModelReader {
  public:
    /// \param path  of the model. \param root  whether its <build> is the scene.
    ModelReader(std::span<const std::byte> model, std::string path, bool root, Models& models)
        : xml_(model), path_(std::move(path)), root_(root), models_(models) {}

    Result<void> run() {
        for (;;) {
            const XmlReader::Event event = RELIEF_TRY(xml_.next());
            if (event == XmlReader::Event::kDone) {
                return {};
            }
            if (event == XmlReader::Event::kBegin) {
                RELIEF_TRY(begin());
            }
        }
    }

  private:
    [[nodiscard]] tl::unexpected<Error> wrong(const std::string& what) const {
        return invalidInput(cleanUtf8(path_, kQuotedMax) + ", " + xml_.where() + what);
    }

    Result<void> begin() {
        if (xml_.depth() == 1) {
            return beginModel();
        }
        if (xml_.at({"model", "resources", "object"})) {
            return beginObject();
        }
        if (xml_.at({"model", "resources", "object", "mesh", "vertices", "vertex"})) {
            const double x = RELIEF_TRY(number("x"));
            const double y = RELIEF_TRY(number("y"));
            const double z = RELIEF_TRY(number("z"));
            if (!is_support_) {
                object().positions.emplace_back(x, y, z);
            }
        } else if (xml_.at({"model", "resources", "object", "mesh", "triangles", "triangle"})) {
            return addTriangle();
        } else if (xml_.at({"model", "resources", "object", "components", "component"})) {
            return addUse(object_);
        } else if (root_ && xml_.at({"model", "build", "item"})) {
            return addUse(std::nullopt);
        } else if (xml_.at({"model", "resources", "basematerials"})) {
            materials_ = xml_.attribute("id").value_or("");
        } else if (xml_.at({"model", "resources", "basematerials", "base"})) {
            names_[materials_].push_back(xml_.attribute("name").value_or(""));
        } else if (xml_.name() == "beamlattice" && !beams_) {
            beams_ = true;
            models_.file.warnings.emplace_back("left out its beam lattices: only triangles have a surface");
        }
        return {};
    }

    Result<void> beginModel() {
        if (xml_.name() != "model") {
            return wrong("the root is <" + cleanUtf8(xml_.name(), kQuotedMax) + ">, not <model>");
        }
        if (root_) {
            models_.file.frame = frameOfUnitName(xml_.attribute("unit").value_or("millimeter"));
        } else if (frameOfUnitName(xml_.attribute("unit").value_or("millimeter")).metres !=
                   models_.file.frame.metres) {
            return wrong("the models have different units; export it again in one model");
        }
        const std::string required = xml_.attribute("requiredextensions").value_or("");
        std::string_view rest = required;
        for (std::string_view prefix = takeWord(rest); !prefix.empty(); prefix = takeWord(rest)) {
            std::string uri(prefix);
            for (const XmlReader::Attribute& attribute : xml_.attributes()) {
                uri = attribute.name == "xmlns:" + std::string(prefix) ? attribute.value : uri;
            }
            if (std::find(kKnownExtensions.begin(), kKnownExtensions.end(), uri) == kKnownExtensions.end()) {
                return fail(ErrorCode::kUnsupported,
                            "its extension '" + cleanUtf8(uri, kQuotedMax) +
                                "' is required and not read; export it as plain triangles");
            }
        }
        return {};
    }

    Result<void> beginObject() {
        const std::string id = xml_.attribute("id").value_or("");
        object_ = models_.file.assembly.objects.size();
        if (!models_.objects.emplace(Place(path_, id), object_).second) {
            return wrong("there is another object with the id '" + cleanUtf8(id, kQuotedMax) + "'");
        }
        AssemblyObject object;
        object.names = {id, xml_.attribute("name").value_or(""), xml_.attribute("partnumber").value_or("")};
        models_.file.assembly.objects.push_back(std::move(object));
        const std::string type = xml_.attribute("type").value_or("model");
        is_support_ = type == "support" || type == "solidsupport";
        material_ = Material(xml_.attribute("pid").value_or(""), xml_.attribute("pindex").value_or("0"));
        parts_.clear();
        return {};
    }

    Result<void> addTriangle() {
        glm::uvec3 corners;
        for (int i = 0; i < 3; ++i) {
            constexpr const char* kNames[] = {"v1", "v2", "v3"};
            const std::string word = xml_.attribute(kNames[i]).value_or("");
            const std::optional<std::uint64_t> index = parseUnsigned(word);
            if (!index || *index > 0xFFFFFFFE) {
                return wrong("a triangle's " + std::string(kNames[i]) + " is '" +
                             cleanUtf8(word, kQuotedMax) + "', which is no index of a vertex");
            }
            corners[i] = static_cast<std::uint32_t>(*index);
        }
        if (is_support_) {
            models_.support = true;
            return {};
        }
        Material material = material_;
        if (const std::optional<std::string> index = xml_.attribute("p1")) {
            material = Material(xml_.attribute("pid").value_or(material_.first), *index);
        }
        if (!names_.contains(material.first)) {
            material = Material();  // a colour, or a place of a texture
        }
        const auto [found, added] = parts_.emplace(material, object().parts.size());
        if (added) {
            AssemblyPart part;
            const auto names = names_.find(material.first);
            const std::uint64_t index = parseUnsigned(material.second).value_or(0);
            if (names != names_.end() && index < names->second.size()) {
                part.names.push_back(names->second[index]);
            }
            object().parts.push_back(std::move(part));
        }
        object().parts[found->second].triangles.push_back(corners);
        return {};
    }

    Result<void> addUse(std::optional<std::size_t> in) {
        Models::Use use;
        use.in = in;
        // The path of the production extension; without it, the object is in the same model.
        use.of = {xml_.attribute("path").value_or(path_), xml_.attribute("objectid").value_or("")};
        use.of.first.insert(0, use.of.first.starts_with('/') ? "" : "/");
        if (const std::optional<std::string> text = xml_.attribute("transform")) {
            const Result<Transform> transform = transformOf(*text);
            if (!transform) {
                return wrong(transform.error().message);
            }
            use.transform = *transform;
        }
        models_.uses.push_back(std::move(use));
        return {};
    }

    [[nodiscard]] Result<double> number(const char* name) const {
        const std::optional<std::string> text = xml_.attribute(name);
        if (!text) {
            return wrong("a vertex has no " + std::string(name));
        }
        const std::optional<double> value = finiteNumber(*text);
        return value ? Result<double>(*value) : wrong(noFiniteNumber(*text));
    }
    [[nodiscard]] AssemblyObject& object() { return models_.file.assembly.objects.back(); }

    using Material = std::pair<std::string, std::string>;  // group and index

    XmlReader xml_;
    std::string path_;
    bool root_;
    Models& models_;
    std::size_t object_ = 0;
    bool is_support_ = false;
    bool beams_ = false;
    Material material_;
    std::map<Material, std::size_t> parts_;  // of the object
    std::string materials_;
    std::map<std::string, std::vector<std::string>> names_;  // of groups of materials
};

/// The path of the model that the archive begins with.
Result<std::string> rootModel(const ZipArchive& archive) {
    const std::vector<std::byte> relations = RELIEF_TRY(partOf(archive, "_rels/.rels"));
    XmlReader xml(relations);
    for (;;) {
        const XmlReader::Event event = RELIEF_TRY(xml.next());
        if (event == XmlReader::Event::kDone) {
            return invalidInput("its archive names no model");
        }
        if (event == XmlReader::Event::kBegin && xml.at({"Relationships", "Relationship"}) &&
            xml.attribute("Type") == kModelRelation) {
            std::string target = xml.attribute("Target").value_or("");
            return target.starts_with('/') ? target : "/" + target;
        }
    }
}

Result<void> connect(Models& models) {
    std::vector<AssemblyObject>& objects = models.file.assembly.objects;
    for (const Models::Use& use : models.uses) {
        const auto found = models.objects.find(use.of);
        if (found == models.objects.end()) {
            return invalidInput("the object '" + cleanUtf8(use.of.second, kQuotedMax) + "', which " +
                                cleanUtf8(use.of.first, kQuotedMax) + " should have, does not exist");
        }
        std::vector<AssemblyUse>& uses = use.in ? objects[*use.in].uses : models.file.assembly.roots;
        uses.push_back({found->second, use.transform});
    }
    if (models.support) {
        models.file.warnings.emplace_back("left out what supports it while it is printed");
    }
    return {};
}

}  // namespace

Result<AssemblyFile> read3mf(std::span<const std::byte> bytes) {
    const ZipArchive archive = RELIEF_TRY(ZipArchive::open(bytes));
    std::deque<std::string> paths = {RELIEF_TRY(rootModel(archive))};
    std::set<std::string> known(paths.begin(), paths.end());
    Models models;
    bool root = true;
    for (std::size_t uses = 0; !paths.empty(); paths.pop_front()) {
        const std::vector<std::byte> model = RELIEF_TRY(partOf(archive, paths.front()));
        RELIEF_TRY(ModelReader(model, paths.front(), root, models).run());
        root = false;
        for (; uses < models.uses.size(); ++uses) {
            if (known.insert(models.uses[uses].of.first).second) {
                paths.push_back(models.uses[uses].of.first);
            }
        }
    }
    RELIEF_TRY(connect(models));
    return std::move(models.file);
}

}  // namespace relief
