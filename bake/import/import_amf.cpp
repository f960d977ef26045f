#include "bake/import/import_readers.h"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "bake/import/import_numbers.h"
#include "bake/import/import_xml.h"
#include "formats/base/portable_math.h"
#include "formats/base/text.h"

namespace relief {
namespace {

struct SineCosine {
    double sine;
    double cosine;
};

/// Exact for quarter turns.
SineCosine sineAndCosine(double degrees) {
    const double within = std::fmod(degrees, 360.0);
    const double quarters = std::floor(within / 90.0 + 0.5);
    const double radians = (within - 90.0 * quarters) * (std::numbers::pi / 180.0);
    const double sine = portable::sin(radians);
    const double cosine = portable::cos(radians);
    switch (static_cast<int>(quarters) & 3) {
        case 1:
            return {cosine, -sine};
        case 2:
            return {-sine, -cosine};
        case 3:
            return {-cosine, sine};
        default:
            return {sine, cosine};
    }
}

class AmfReader {
  public:
    explicit AmfReader(std::span<const std::byte> bytes) : xml_(bytes) {}

    Result<AssemblyFile> run() {
        for (XmlReader::Event event = RELIEF_TRY(xml_.next()); event != XmlReader::Event::kDone;
             event = RELIEF_TRY(xml_.next())) {
            if (event == XmlReader::Event::kBegin) {
                text_.clear();
                RELIEF_TRY(begin());
            } else if (event == XmlReader::Event::kText) {
                text_ += xml_.text();
            } else {
                RELIEF_TRY(end());
                text_.clear();
            }
        }
        RELIEF_TRY(place());
        if (curved_) {
            file_.warnings.emplace_back("its triangles have curved edges, and are read as flat");
        }
        return std::move(file_);
    }

  private:
    Result<void> begin() {
        if (xml_.depth() == 1) {
            if (xml_.name() != "amf") {
                return invalidInput("its root is <" + cleanUtf8(xml_.name()) + ">, not <amf>");
            }
            // The default of ISO/ASTM 52915.
            file_.frame = frameOfUnitName(xml_.attribute("unit").value_or("millimeter"));
        } else if (xml_.at({"amf", "object"}) || xml_.at({"amf", "constellation"})) {
            AssemblyObject object;
            const std::string id = xml_.attribute("id").value_or("");
            object.names.push_back(id);
            if (!ids_.emplace(id, file_.assembly.objects.size()).second) {
                return wrong("there is another object with the id '" + cleanUtf8(id) + "'");
            }
            file_.assembly.objects.push_back(std::move(object));
            base_ = 0;
            material_parts_.clear();
        } else if (xml_.at({"amf", "object", "mesh"})) {
            base_ = static_cast<std::uint32_t>(object().positions.size());
        } else if (xml_.at({"amf", "object", "mesh", "vertices", "vertex", "coordinates"})) {
            numbers_ = {NAN, NAN, NAN};
        } else if (xml_.at({"amf", "object", "mesh", "volume"})) {
            const std::string material = xml_.attribute("materialid").value_or("");
            const auto [found, added] = material_parts_.emplace(material, object().parts.size());
            if (added) {
                object().parts.emplace_back();
                parts_.push_back({file_.assembly.objects.size() - 1, found->second, material});
            }
            part_ = found->second;
        } else if (xml_.at({"amf", "object", "mesh", "volume", "triangle"})) {
            corners_ = {kNoCorner, kNoCorner, kNoCorner};
        } else if (xml_.at({"amf", "constellation", "instance"})) {
            placement_ = {xml_.attribute("objectid").value_or(""), {}, {}};
        } else if (xml_.at({"amf", "material"})) {
            material_ = xml_.attribute("id").value_or("");
        } else if (xml_.name() == "metadata") {
            is_name_ = lowerCase(xml_.attribute("type").value_or("")) == "name";
        } else if (xml_.at({"amf", "object", "mesh", "vertices", "edge"}) ||
                   xml_.at({"amf", "object", "mesh", "vertices", "vertex", "normal"})) {
            curved_ = true;
        }
        return {};
    }

    Result<void> end() {
        if (inTriangle("v1") || inTriangle("v2") || inTriangle("v3")) {
            const std::optional<std::uint64_t> index = parseUnsigned(trimmed(text_));
            if (!index || *index >= kNoCorner - base_) {
                return wrong("'" + cleanUtf8(text_.substr(0, 40)) + "' is no index of a vertex");
            }
            corners_[xml_.name()[1] - '1'] = static_cast<std::uint32_t>(*index) + base_;
        } else if (xml_.at({"amf", "object", "mesh", "volume", "triangle"})) {
            if (corners_.x == kNoCorner || corners_.y == kNoCorner || corners_.z == kNoCorner) {
                return wrong("a triangle without v1, v2 and v3");
            }
            object().parts[part_].triangles.push_back(corners_);
        } else if (inCoordinates("x") || inCoordinates("y") || inCoordinates("z")) {
            numbers_[xml_.name()[0] - 'x'] = RELIEF_TRY(number());
        } else if (xml_.at({"amf", "object", "mesh", "vertices", "vertex", "coordinates"})) {
            if (!(std::isfinite(numbers_.x) && std::isfinite(numbers_.y) && std::isfinite(numbers_.z))) {
                return wrong("a vertex without x, y and z");
            }
            object().positions.emplace_back(numbers_);
        } else if (inInstance("deltax") || inInstance("deltay") || inInstance("deltaz")) {
            placement_.delta[xml_.name()[5] - 'x'] = RELIEF_TRY(number());
        } else if (inInstance("rx") || inInstance("ry") || inInstance("rz")) {
            placement_.degrees[xml_.name()[1] - 'x'] = RELIEF_TRY(number());
        } else if (xml_.at({"amf", "constellation", "instance"})) {
            placement_.in = file_.assembly.objects.size() - 1;
            placements_.push_back(placement_);
        } else if (is_name_ && xml_.at({"amf", "material", "metadata"})) {
            material_names_[material_] = text_;
        } else if (is_name_ && (xml_.at({"amf", "object", "metadata"}) ||
                                xml_.at({"amf", "constellation", "metadata"}))) {
            object().names.push_back(text_);
        }
        return {};
    }

    /// Makes uses of instances, which may name what comes later, and names of materials.
    Result<void> place() {
        std::vector<bool> placed(file_.assembly.objects.size(), false);
        for (const Placement& placement : placements_) {
            const auto found = ids_.find(placement.object);
            if (found == ids_.end()) {
                return invalidInput("an instance places the object '" + cleanUtf8(placement.object) +
                                    "', which does not exist");
            }
            placed[found->second] = true;
            file_.assembly.objects[placement.in].uses.push_back({found->second, transformOf(placement)});
        }
        for (std::size_t i = 0; i < placed.size(); ++i) {
            if (!placed[i]) {
                file_.assembly.roots.push_back({i, {}});
            }
        }
        for (const PartOf& part : parts_) {
            if (const auto name = material_names_.find(part.material); name != material_names_.end()) {
                file_.assembly.objects[part.object].parts[part.part].names.push_back(name->second);
            }
        }
        return {};
    }

    struct Placement {
        std::string object;
        glm::dvec3 delta{0.0};
        glm::dvec3 degrees{0.0};
        std::size_t in = 0;
    };
    struct PartOf {
        std::size_t object;
        std::size_t part;
        std::string material;
    };

    static Transform transformOf(const Placement& placement) {
        Transform transform{glm::dmat3(1.0), placement.delta};
        for (int axis = 0; axis < 3; ++axis) {
            const auto [sine, cosine] = sineAndCosine(placement.degrees[axis]);
            const int a = (axis + 1) % 3;
            const int b = (axis + 2) % 3;
            glm::dmat3 turn(1.0);
            turn[a][a] = turn[b][b] = cosine;
            turn[a][b] = sine;
            turn[b][a] = -sine;
            transform.linear = turn * transform.linear;
        }
        return transform;
    }

    [[nodiscard]] bool inTriangle(std::string_view name) const {
        return xml_.at({"amf", "object", "mesh", "volume", "triangle", name});
    }
    [[nodiscard]] bool inCoordinates(std::string_view name) const {
        return xml_.at({"amf", "object", "mesh", "vertices", "vertex", "coordinates", name});
    }
    [[nodiscard]] bool inInstance(std::string_view name) const {
        return xml_.at({"amf", "constellation", "instance", name});
    }
    [[nodiscard]] Result<double> number() const {
        const std::optional<double> value = finiteNumber(text_);
        return value ? Result<double>(*value) : wrong(noFiniteNumber(text_));
    }
    [[nodiscard]] tl::unexpected<Error> wrong(const std::string& what) const {
        return invalidInput(xml_.where() + what);
    }
    [[nodiscard]] AssemblyObject& object() { return file_.assembly.objects.back(); }

    static constexpr std::uint32_t kNoCorner = 0xFFFFFFFF;

    XmlReader xml_;
    AssemblyFile file_;
    std::string text_;
    std::map<std::string, std::size_t> ids_;
    std::vector<Placement> placements_;
    std::vector<PartOf> parts_;
    std::map<std::string, std::string> material_names_;
    std::map<std::string, std::size_t> material_parts_;  // of the object
    std::size_t part_ = 0;
    std::uint32_t base_ = 0;  // of the indices of a mesh
    glm::dvec3 numbers_{0.0};
    glm::uvec3 corners_{0};
    Placement placement_;
    std::string material_;
    bool is_name_ = false;
    bool curved_ = false;
};

}  // namespace

Result<AssemblyFile> readAmf(std::span<const std::byte> bytes) {
    return AmfReader(bytes).run();
}

}  // namespace relief
