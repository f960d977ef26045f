// PLY, read: the elements vertex (x, y, z) and face (vertex_indices or vertex_index).
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/base/error_context.h"
#include "formats/base/ply_reader.h"
#include "runtime/files/mesh_file.h"

namespace relief {
namespace {

struct Property {
    std::string_view name;
    PlyType type = PlyType::kInt8;
    std::optional<PlyType> length_type;  // of a list
};

struct Element {
    std::string_view name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

struct Header {
    std::optional<PlyEncoding> encoding;
    std::vector<Element> elements;
};

constexpr std::size_t kElementsMax = 64;
constexpr double kListMax = 1e6;

// Errors below do not name the file: parsePlyMesh does.
tl::unexpected<Error> tooMany(std::size_t limit, const char* what) {
    return fail(ErrorCode::kLimit,
                "it has more than " + std::to_string(limit) + " " + what + "; simplify the mesh");
}

tl::unexpected<Error> noNumber(const PlyNumbers& numbers) {
    return invalidInput(numbers.ended() ? "it ends too early" : "a word among its numbers is none");
}

Result<void> addElement(const PlyHeaderLine& line, Header& header) {
    if (!line.count || header.elements.size() == kElementsMax) {
        return invalidInput("an element of its header is not understood");
    }
    header.elements.push_back({line.name, *line.count, {}});
    return {};
}

Result<void> addProperty(const PlyHeaderLine& line, Header& header) {
    if (header.elements.empty() || header.elements.back().properties.size() == kPlyPropertiesMax) {
        return invalidInput("a property of its header belongs to no element, or to a crowded one");
    }
    if (line.name.empty()) {
        return invalidInput("a property of its header is not understood");
    }
    if (!line.type || (line.list && !line.length_type)) {
        return invalidInput("a property of its header has an unknown type");
    }
    header.elements.back().properties.push_back({line.name, *line.type, line.length_type});
    return {};
}

/// Cuts the header off the data.
Result<Header> takeHeader(std::string_view& data) {
    using Kind = PlyHeaderLine::Kind;
    Header header;
    for (bool first = true;; first = false) {
        const std::optional<PlyHeaderLine> line = takePlyHeaderLine(data);
        if (!line) {
            return invalidInput("its header does not end");
        }
        if (first && line->kind != Kind::kPly) {
            return invalidInput("it is no PLY file");
        }
        if (line->kind == Kind::kEnd) {
            break;
        }
        if (line->kind == Kind::kFormat) {
            header.encoding = line->encoding;
        } else if (line->kind == Kind::kElement) {
            RELIEF_TRY(addElement(*line, header));
        } else if (line->kind == Kind::kProperty) {
            RELIEF_TRY(addProperty(*line, header));
        }
    }
    if (!header.encoding) {
        return invalidInput(
            "its header names no format that is known: ascii, binary_little_endian or binary_big_endian");
    }
    return header;
}

/// 0, 1 or 2 for x, y or z; -1 for any other property.
int axisOf(const Property& property) {
    const char name = property.name.size() == 1 ? property.name[0] : '\0';
    return name >= 'x' && name <= 'z' ? name - 'x' : -1;
}

Result<void> readVertices(const Element& element, PlyNumbers& numbers, PictureMesh& mesh) {
    if (element.count > kMeshVerticesMax) {
        return tooMany(kMeshVerticesMax, "vertices");
    }
    int found = 0;
    for (const Property& property : element.properties) {
        if (property.length_type) {
            return invalidInput("its vertices have lists");
        }
        found += axisOf(property) >= 0 ? 1 : 0;
    }
    if (found != 3) {
        return invalidInput("its vertices do not have x, y and z");
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
        glm::vec3 p{0.0F};
        for (const Property& property : element.properties) {
            const std::optional<double> value = numbers.next(property.type);
            if (!value) {
                return noNumber(numbers);
            }
            if (const int axis = axisOf(property); axis >= 0) {
                p[axis] = static_cast<float>(*value);
                if (!std::isfinite(p[axis])) {
                    return invalidInput("vertex " + std::to_string(i) + " is not finite");
                }
            }
        }
        mesh.positions.push_back(p);
    }
    return {};
}

/// Reads one property of element number `index`, a list or a single number.
/// \param corners  null: passes over it; otherwise takes the list's items, which must be vertices.
Result<void> readList(const Property& property, std::uint64_t index, PlyNumbers& numbers,
                      const PictureMesh& mesh, std::vector<std::uint32_t>* corners) {
    const std::optional<double> length =
        property.length_type ? numbers.next(*property.length_type) : std::optional(1.0);
    if (!length) {
        return noNumber(numbers);
    }
    if (!(*length >= 0.0 && *length <= kListMax && *length == std::floor(*length))) {
        return invalidInput("a list has a length that cannot be");
    }
    for (std::uint64_t k = 0; k < static_cast<std::uint64_t>(*length); ++k) {
        const std::optional<double> value = numbers.next(property.type);
        if (!value) {
            return noNumber(numbers);
        }
        if (corners == nullptr) {
            continue;
        }
        if (!(*value >= 0.0 && *value < static_cast<double>(mesh.positions.size()) &&
              *value == std::floor(*value))) {
            return invalidInput("face " + std::to_string(index) + " names a vertex that is not there");
        }
        corners->push_back(static_cast<std::uint32_t>(*value));
    }
    return {};
}

/// Any other element, and the faces: their lists of the right name become polygons.
Result<void> readElement(const Element& element, PlyNumbers& numbers, PictureMesh& mesh) {
    if (element.properties.empty()) {
        return {};
    }
    const bool faces = element.name == "face";
    std::vector<std::uint32_t> corners;
    for (std::uint64_t i = 0; i < element.count; ++i) {
        for (const Property& property : element.properties) {
            const bool polygon = faces && property.length_type &&
                                 (property.name == "vertex_indices" || property.name == "vertex_index");
            corners.clear();
            RELIEF_TRY(readList(property, i, numbers, mesh, polygon ? &corners : nullptr));
            if (polygon && corners.size() < 3) {
                return invalidInput("face " + std::to_string(i) + " has fewer than three corners");
            }
            if (polygon && !addPolygon(corners, mesh)) {
                return tooMany(kMeshTrianglesMax, "triangles");
            }
        }
    }
    return {};
}

Result<PictureMesh> readMesh(std::string_view data) {
    const Header header = RELIEF_TRY(takeHeader(data));
    PlyNumbers numbers(data, *header.encoding);
    PictureMesh mesh;
    for (const Element& element : header.elements) {
        const bool vertices = element.name == "vertex" && mesh.positions.empty();
        RELIEF_TRY(vertices ? readVertices(element, numbers, mesh) : readElement(element, numbers, mesh));
    }
    if (mesh.triangles.empty()) {
        return invalidInput("it has no faces");
    }
    return mesh;
}

}  // namespace

Result<PictureMesh> parsePlyMesh(std::span<const std::byte> bytes, std::string_view name) {
    return inFront(std::string(name), readMesh({reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
}

}  // namespace relief
