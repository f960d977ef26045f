// SPDX-License-Identifier: Apache-2.0
// assimp 5.2 is not used: it keeps only one triangle of a strip, invents the faces of a truncated file, and accepts
// wrong counts (import_text_test.cpp, PlyByLinesWithTrueCounts), and the runtime does not link it.
#include "formats/polygons/polygon_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "formats/base/text.h"
#include "formats/polygons/ply_reader.h"

namespace relief {
namespace {

constexpr std::size_t kNameMax = 40;  // bytes of a name in a message
constexpr std::size_t kUnreadMax = 8;
constexpr std::array<std::string_view, 7> kVertexColumns = {"x", "y", "z", "red", "green", "blue", "alpha"};

bool isVertexList(const PlyProperty& property) {
    return property.isList() && (property.name == "vertex_indices" || property.name == "vertex_index");
}

bool isSurface(const PlyElement& element) {
    return (element.name == "face" || element.name == "tristrips") && element.count > 0 &&
           std::any_of(element.properties.begin(), element.properties.end(), isVertexList);
}

/// Returns whether a skipped element probably contains faces. Range grids contain points in rows and columns, not
/// faces.
bool looksLikeFaces(const PlyElement& element) {
    const bool other = element.name == "vertex" || element.name == "range_grid" ||
                       element.name.find("texture") != std::string_view::npos;
    return element.count > 0 && !other &&
           std::any_of(element.properties.begin(), element.properties.end(),
                       [](const PlyProperty& property) { return property.isList(); });
}

/// "its element 'polygon' is not read, …"
std::string unreadText(const PlyElement& element) {
    const std::string name = "its element '" + cleanUtf8(element.name, kNameMax) + "' ";
    return element.name == "face" || element.name == "tristrips"
               ? name + "has no list vertex_indices or vertex_index"
               : name + "is not read: faces must be in 'face' or 'tristrips', in a list vertex_indices";
}

class PlyImport {
  public:
    explicit PlyImport(PolygonColors colors) : colors_(colors) {}

    Result<PolygonMesh> run(std::string_view data) {
        const PlyHeader header = RELIEF_TRY(readPlyHeader(data));
        RELIEF_TRY(checkVertices(header));
        if (std::none_of(header.elements.begin(), header.elements.end(), isSurface)) {
            return noFaces(header);
        }
        PlyNumbers numbers(data, header.encoding, header.lines);
        for (const PlyElement& element : header.elements) {
            RELIEF_TRY(readElement(element, numbers));
        }
        RELIEF_TRY(checkRest(numbers));
        if (mesh_.sizes.empty()) {
            return noFaces(header);
        }
        for (const PlyElement& element : unread_) {
            mesh_.warnings.push_back("skipped " + std::to_string(element.count) +
                                     " faces or similar: " + unreadText(element));
        }
        return std::move(mesh_);
    }

  private:
    Result<void> checkVertices(const PlyHeader& header) {
        const auto is_vertex = [](const PlyElement& element) { return element.name == "vertex"; };
        if (std::count_if(header.elements.begin(), header.elements.end(), is_vertex) != 1) {
            return invalidInput("its header must have exactly one element 'vertex'");
        }
        const PlyElement& element = *std::find_if(header.elements.begin(), header.elements.end(), is_vertex);
        const PlyColumns columns(element, kVertexColumns);
        if (columns.count(0) != 1 || columns.count(1) != 1 || columns.count(2) != 1) {
            return invalidInput("its vertices do not have x, y and z");
        }
        vertices_ = element.count;
        return checkVertexCount(vertices_);
    }

    /// Checks that a text element ends with its line: extra or missing numbers would shift all following ones.
    static Result<void> endLine(const PlyElement& element, std::uint64_t index, PlyNumbers& numbers) {
        return !numbers.isText() || numbers.atLineEnd()
                   ? Result<void>()
                   : invalidInput(numbers.where() + "element " + cleanUtf8(element.name, kNameMax) + " " +
                                  std::to_string(index) +
                                  " does not end with its line; correct the counts and properties in the "
                                  "header, or export the mesh again");
    }

    Result<void> readElement(const PlyElement& element, PlyNumbers& numbers) {
        if (element.properties.empty()) {
            return {};
        }
        if (element.name == "vertex") {
            return readVertices(element, numbers);
        }
        const bool surface = isSurface(element);
        if (!surface && looksLikeFaces(element) && unread_.size() < kUnreadMax) {
            unread_.push_back(element);
        }
        const bool strip = element.name == "tristrips";
        for (std::uint64_t i = 0; i < element.count; ++i) {
            for (const PlyProperty& property : element.properties) {
                if (!surface || !isVertexList(property)) {
                    RELIEF_TRY(skipPlyProperty(property, numbers));
                } else if (strip) {
                    RELIEF_TRY(readStrips(property, i, numbers));
                } else {
                    RELIEF_TRY(readFace(property, i, numbers));
                }
            }
            RELIEF_TRY(endLine(element, i, numbers));
        }
        return {};
    }

    Result<void> readVertices(const PlyElement& element, PlyNumbers& numbers) {
        const PlyColumns columns(element, kVertexColumns);
        const bool colored = colors_ == PolygonColors::kRead && columns.count(3) == 1 &&
                             columns.count(4) == 1 && columns.count(5) == 1;
        const std::array<double, 4> scales = colorScales(element);
        std::array<double, 7> values{};
        values[6] = columns.count(6) == 1 ? 0.0 : 255.0 / scales[3];
        for (std::uint64_t i = 0; i < element.count; ++i) {
            RELIEF_TRY(columns.read(numbers, values));
            mesh_.positions.emplace_back(values[0], values[1], values[2]);
            if (colored) {
                auto& color = mesh_.colors.emplace_back();
                for (std::size_t k = 0; k < 4; ++k) {
                    color[k] = static_cast<std::uint8_t>(
                        std::lround(std::clamp(scales[k] * values[3 + k], 0.0, 255.0)));
                }
            }
            RELIEF_TRY(endLine(element, i, numbers));
        }
        return {};
    }

    /// Returns factors from the file's numbers to 0…255, for red, green, blue and alpha.
    static std::array<double, 4> colorScales(const PlyElement& element) {
        std::array<double, 4> scales{1.0, 1.0, 1.0, 1.0};
        for (const PlyProperty& property : element.properties) {
            const auto column = std::find(kVertexColumns.begin() + 3, kVertexColumns.end(), property.name);
            if (column == kVertexColumns.end() || property.isList()) {
                continue;
            }
            const bool real = property.type == PlyType::kFloat32 || property.type == PlyType::kFloat64;
            const bool wide = property.type == PlyType::kUint16;
            scales[static_cast<std::size_t>(column - kVertexColumns.begin()) - 3] = real   ? 255.0
                                                                                    : wide ? 255.0 / 65535.0
                                                                                           : 1.0;
        }
        return scales;
    }

    Result<void> readFace(const PlyProperty& property, std::uint64_t index, PlyNumbers& numbers) {
        const std::uint64_t length = RELIEF_TRY(readPlyLength(numbers, *property.length_type));
        for (std::uint64_t k = 0; k < length; ++k) {
            const std::optional<double> value = numbers.next(property.type);
            if (!value) {
                return plyNumberError(numbers);
            }
            if (!isVertex(*value)) {
                return noVertex("face", index, *value, numbers);
            }
            mesh_.corners.push_back(static_cast<std::uint32_t>(*value));
        }
        if (length == 0) {
            return {};
        }
        mesh_.sizes.push_back(static_cast<std::uint32_t>(length));
        return countTriangles(length < 3 ? 0 : length - 2);
    }

    Result<void> readStrips(const PlyProperty& property, std::uint64_t index, PlyNumbers& numbers) {
        // Writers that use a signed type store -1 as the largest 32-bit number.
        const double other_end = property.type == PlyType::kUint32 ? 4294967295.0 : -1.0;
        const std::uint64_t length = RELIEF_TRY(readPlyLength(numbers, *property.length_type));
        std::uint32_t before_last = 0;
        std::uint32_t last = 0;
        std::uint64_t in_strip = 0;
        for (std::uint64_t k = 0; k < length; ++k) {
            const std::optional<double> value = numbers.next(property.type);
            if (!value) {
                return plyNumberError(numbers);
            }
            if (*value == -1.0 || *value == other_end) {
                in_strip = 0;
                continue;
            }
            if (!isVertex(*value)) {
                return noVertex("tristrips", index, *value, numbers);
            }
            const auto corner = static_cast<std::uint32_t>(*value);
            // Repeated corners only connect parts of a strip.
            if (in_strip >= 2 && before_last != last && last != corner && corner != before_last) {
                const bool turned = in_strip % 2 == 1;
                mesh_.corners.insert(mesh_.corners.end(),
                                     {turned ? last : before_last, turned ? before_last : last, corner});
                mesh_.sizes.push_back(3);
                RELIEF_TRY(countTriangles(1));
            }
            before_last = std::exchange(last, corner);
            ++in_strip;
        }
        return {};
    }

    [[nodiscard]] bool isVertex(double value) const {
        return value >= 0.0 && value < static_cast<double>(vertices_) && value == std::floor(value);
    }

    [[nodiscard]] tl::unexpected<Error> noVertex(const char* element, std::uint64_t index, double value,
                                                 const PlyNumbers& numbers) const {
        return invalidInput(numbers.where() + "element " + element + " " + std::to_string(index) +
                            " refers to vertex " + shortest(static_cast<float>(value)) + ", but there are " +
                            std::to_string(vertices_));
    }

    Result<void> countTriangles(std::uint64_t more) {
        triangles_ += more;
        return checkTriangleCount(triangles_);
    }

    Result<void> checkRest(PlyNumbers& numbers) {
        if (numbers.isText()) {
            static_cast<void>(numbers.next(PlyType::kFloat64));
            return numbers.ended()
                       ? Result<void>()
                       : invalidInput(numbers.where() + "it contains more numbers than its header declares");
        }
        const std::string_view rest = numbers.rest();
        if (rest.find_first_not_of(std::string_view("\0 \t\r\n", 5)) != std::string_view::npos) {
            mesh_.warnings.push_back(std::to_string(rest.size()) +
                                     " bytes after the last element of its header were skipped");
        }
        return {};
    }

    [[nodiscard]] tl::unexpected<Error> noFaces(const PlyHeader& header) const {
        const auto unread = std::find_if(
            header.elements.begin(), header.elements.end(),
            [](const PlyElement& element) { return !isSurface(element) && looksLikeFaces(element); });
        if (unread != header.elements.end()) {
            return invalidInput(unreadText(*unread) + "; rename it, or export the mesh again as polygons");
        }
        const bool edges = std::any_of(
            header.elements.begin(), header.elements.end(),
            [](const PlyElement& element) { return element.name == "edge" && element.count > 0; });
        return invalidInput(
            "it has " + std::to_string(vertices_) + " vertices " + (edges ? "and edges " : "") +
            "but no faces" +
            (edges ? "; export the surface as polygons"
                   : "; for a scan, first reconstruct a surface from its points, for example in MeshLab"));
    }

    PolygonColors colors_;
    PolygonMesh mesh_;
    std::uint64_t vertices_ = 0;  // the header's count: faces may precede the vertices
    std::uint64_t triangles_ = 0;
    std::vector<PlyElement> unread_;  // elements that look like faces
};

}  // namespace

Result<PolygonMesh> readPly(std::span<const std::byte> bytes, PolygonColors colors) {
    return PlyImport(colors).run({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace relief
