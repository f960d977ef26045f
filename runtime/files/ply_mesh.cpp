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

constexpr std::uint64_t kListMax = 1'000'000;

// Errors below do not name the file: parsePlyMesh does.
tl::unexpected<Error> tooMany(std::size_t limit, const char* what) {
    return fail(ErrorCode::kLimit,
                "it has more than " + std::to_string(limit) + " " + what + "; simplify the mesh");
}

/// 0, 1 or 2 for x, y or z; -1 for any other property.
int axisOf(const PlyProperty& property) {
    const char name = property.name.size() == 1 ? property.name[0] : '\0';
    return name >= 'x' && name <= 'z' ? name - 'x' : -1;
}

Result<void> readVertices(const PlyElement& element, PlyNumbers& numbers, PictureMesh& mesh) {
    if (element.count > kMeshVerticesMax) {
        return tooMany(kMeshVerticesMax, "vertices");
    }
    int found = 0;
    for (const PlyProperty& property : element.properties) {
        if (property.isList()) {
            return invalidInput("its vertices have lists");
        }
        found += axisOf(property) >= 0 ? 1 : 0;
    }
    if (found != 3) {
        return invalidInput("its vertices do not have x, y and z");
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
        glm::vec3 p{0.0F};
        for (const PlyProperty& property : element.properties) {
            const std::optional<double> value = numbers.next(property.type);
            if (!value) {
                return plyNumberError(numbers);
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
Result<void> readList(const PlyProperty& property, std::uint64_t index, PlyNumbers& numbers,
                      const PictureMesh& mesh, std::vector<std::uint32_t>* corners) {
    std::uint64_t length = 1;
    if (property.isList()) {
        length = RELIEF_TRY(takePlyLength(numbers, *property.length_type));
    }
    if (length > kListMax) {
        return invalidInput("a list has a length that cannot be");
    }
    for (std::uint64_t k = 0; k < length; ++k) {
        const std::optional<double> value = numbers.next(property.type);
        if (!value) {
            return plyNumberError(numbers);
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
Result<void> readElement(const PlyElement& element, PlyNumbers& numbers, PictureMesh& mesh) {
    if (element.properties.empty()) {
        return {};
    }
    const bool faces = element.name == "face";
    std::vector<std::uint32_t> corners;
    for (std::uint64_t i = 0; i < element.count; ++i) {
        for (const PlyProperty& property : element.properties) {
            const bool polygon = faces && property.isList() &&
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
    const PlyHeader header = RELIEF_TRY(takePlyHeader(data));
    PlyNumbers numbers(data, header.encoding);
    PictureMesh mesh;
    for (const PlyElement& element : header.elements) {
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
