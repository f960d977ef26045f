// PLY, read: the elements vertex (x, y, z) and face (vertex_indices or vertex_index).
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "runtime/files/mesh_file.h"

namespace relief {
namespace {

enum class Kind : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

struct KindName {
    std::string_view name;
    Kind kind;
};
constexpr std::array<KindName, 16> kKinds{{{"char", Kind::kInt8},
                                           {"int8", Kind::kInt8},
                                           {"uchar", Kind::kUint8},
                                           {"uint8", Kind::kUint8},
                                           {"short", Kind::kInt16},
                                           {"int16", Kind::kInt16},
                                           {"ushort", Kind::kUint16},
                                           {"uint16", Kind::kUint16},
                                           {"int", Kind::kInt32},
                                           {"int32", Kind::kInt32},
                                           {"uint", Kind::kUint32},
                                           {"uint32", Kind::kUint32},
                                           {"float", Kind::kFloat32},
                                           {"float32", Kind::kFloat32},
                                           {"double", Kind::kFloat64},
                                           {"float64", Kind::kFloat64}}};

std::optional<Kind> kindOf(std::string_view name) {
    for (const KindName& one : kKinds) {
        if (one.name == name) {
            return one.kind;
        }
    }
    return std::nullopt;
}

std::size_t sizeOf(Kind kind) {
    constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(kind)];
}

struct Property {
    std::string_view name;
    Kind kind = Kind::kInt8;
    std::optional<Kind> count;  // of a list
};

struct Element {
    std::string_view name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

enum class Encoding : std::uint8_t { kAscii, kLittle, kBig };

constexpr std::size_t kElementsMax = 64;
constexpr std::size_t kPropertiesMax = 256;
constexpr double kListMax = 1e6;

/// What ends the reading; caught below, in this file.
struct PlyError {
    ErrorCode code;
    std::string message;
};

[[noreturn]] void wrong(const std::string& message, ErrorCode code = ErrorCode::kInvalidInput) {
    throw PlyError{code, message};
}

/// Numbers one after the other, as words or as bytes.
class Numbers {
  public:
    Numbers(std::string_view data, Encoding encoding) : data_(data), encoding_(encoding) {}

    double next(Kind kind) { return encoding_ == Encoding::kAscii ? nextWord() : nextBytes(kind); }

  private:
    double nextWord() {
        constexpr std::string_view kSpace = " \t\r\n\v\f";
        data_.remove_prefix(std::min(data_.find_first_not_of(kSpace), data_.size()));
        std::string_view word = data_.substr(0, data_.find_first_of(kSpace));
        data_.remove_prefix(word.size());
        if (word.empty()) {
            wrong("it ends too early");
        }
        if (word.starts_with('+')) {
            word.remove_prefix(1);
        }
        double value = 0.0;
        const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || rest != word.data() + word.size()) {
            wrong("a word among its numbers is none");
        }
        return value;
    }

    double nextBytes(Kind kind) {
        const std::size_t size = sizeOf(kind);
        if (data_.size() < size) {
            wrong("it ends too early");
        }
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t at = encoding_ == Encoding::kLittle ? size - 1 - i : i;
            bits = bits << 8 | static_cast<unsigned char>(data_[at]);
        }
        data_.remove_prefix(size);
        switch (kind) {
            case Kind::kInt8:
                return static_cast<std::int8_t>(bits);
            case Kind::kInt16:
                return static_cast<std::int16_t>(bits);
            case Kind::kInt32:
                return static_cast<std::int32_t>(bits);
            case Kind::kFloat32:
                return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
            case Kind::kFloat64:
                return std::bit_cast<double>(bits);
            default:
                return static_cast<double>(bits);
        }
    }

    std::string_view data_;
    Encoding encoding_;
};

struct Header {
    Encoding encoding = Encoding::kAscii;
    std::vector<Element> elements;
};

std::vector<std::string_view> wordsOf(std::string_view line) {
    std::vector<std::string_view> words;
    while (words.size() < 8) {
        line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
        if (line.empty()) {
            break;
        }
        words.push_back(line.substr(0, line.find_first_of(" \t\r")));
        line.remove_prefix(words.back().size());
    }
    return words;
}

Property readProperty(const std::vector<std::string_view>& words) {
    const bool list = words.size() == 5 && words[1] == "list";
    if (!list && words.size() != 3) {
        wrong("a property of its header is not understood");
    }
    Property property;
    const std::optional<Kind> kind = kindOf(words[list ? 3 : 1]);
    property.count = list ? kindOf(words[2]) : std::nullopt;
    if (!kind || (list && !property.count)) {
        wrong("a property of its header has an unknown type");
    }
    property.kind = *kind;
    property.name = words.back();
    return property;
}

/// Reads the header, which is cut off the data.
Header readHeader(std::string_view& data) {
    Header header;
    bool format = false;
    for (std::size_t line = 0;; ++line) {
        const std::size_t end = data.find('\n');
        if (end == std::string_view::npos) {
            wrong("its header does not end");
        }
        const std::vector<std::string_view> words = wordsOf(data.substr(0, end));
        data.remove_prefix(end + 1);
        const std::string_view first = words.empty() ? std::string_view() : words[0];
        if (line == 0 && first != "ply") {
            wrong("it is no PLY file");
        }
        if (first == "end_header") {
            break;
        }
        if (first == "format") {
            const std::string_view name = words.size() > 1 ? words[1] : std::string_view();
            format = name == "ascii" || name == "binary_little_endian" || name == "binary_big_endian";
            header.encoding = name == "ascii"               ? Encoding::kAscii
                              : name == "binary_big_endian" ? Encoding::kBig
                                                            : Encoding::kLittle;
        } else if (first == "element") {
            Element element;
            const std::string_view count = words.size() == 3 ? words[2] : std::string_view();
            const auto [rest, error] =
                std::from_chars(count.data(), count.data() + count.size(), element.count);
            if (error != std::errc() || rest != count.data() + count.size() ||
                header.elements.size() == kElementsMax) {
                wrong("an element of its header is not understood");
            }
            element.name = words[1];
            header.elements.push_back(std::move(element));
        } else if (first == "property") {
            if (header.elements.empty() || header.elements.back().properties.size() == kPropertiesMax) {
                wrong("a property of its header belongs to no element, or to a crowded one");
            }
            header.elements.back().properties.push_back(readProperty(words));
        }
    }
    if (!format) {
        wrong("its header names no format that is known: ascii, binary_little_endian or binary_big_endian");
    }
    return header;
}

void readVertices(const Element& element, Numbers& numbers, PictureMesh& mesh) {
    if (element.count > kMeshVerticesMax) {
        wrong("it has more than " + std::to_string(kMeshVerticesMax) + " vertices; simplify the mesh",
              ErrorCode::kLimit);
    }
    int found = 0;
    for (const Property& property : element.properties) {
        found +=
            !property.count && (property.name == "x" || property.name == "y" || property.name == "z") ? 1 : 0;
        if (property.count) {
            wrong("its vertices have lists");
        }
    }
    if (found != 3) {
        wrong("its vertices do not have x, y and z");
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
        glm::vec3 p{0.0F};
        for (const Property& property : element.properties) {
            const auto value = static_cast<float>(numbers.next(property.kind));
            if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z') {
                p[property.name[0] - 'x'] = value;
                if (!std::isfinite(value)) {
                    wrong("vertex " + std::to_string(i) + " is not finite");
                }
            }
        }
        mesh.positions.push_back(p);
    }
}

/// Any other element, and the faces: lists of the right name become polygons.
void readLists(const Element& element, Numbers& numbers, bool faces, PictureMesh& mesh) {
    if (element.properties.empty()) {
        return;
    }
    std::vector<std::uint32_t> corners;
    for (std::uint64_t i = 0; i < element.count; ++i) {
        for (const Property& property : element.properties) {
            const bool polygon = faces && property.count &&
                                 (property.name == "vertex_indices" || property.name == "vertex_index");
            const double count = property.count ? numbers.next(*property.count) : 1.0;
            if (!(count >= 0.0 && count <= kListMax && count == std::floor(count))) {
                wrong("a list has a length that cannot be");
            }
            corners.clear();
            for (std::uint64_t k = 0; k < static_cast<std::uint64_t>(count); ++k) {
                const double value = numbers.next(property.kind);
                if (!polygon) {
                    continue;
                }
                if (!(value >= 0.0 && value < static_cast<double>(mesh.positions.size()) &&
                      value == std::floor(value))) {
                    wrong("face " + std::to_string(i) + " names a vertex that is not there");
                }
                corners.push_back(static_cast<std::uint32_t>(value));
            }
            if (polygon && corners.size() < 3) {
                wrong("face " + std::to_string(i) + " has fewer than three corners");
            }
            if (polygon && !addPolygon(corners, mesh)) {
                wrong(
                    "it has more than " + std::to_string(kMeshTrianglesMax) + " triangles; simplify the mesh",
                    ErrorCode::kLimit);
            }
        }
    }
}

}  // namespace

Result<PictureMesh> parsePlyMesh(std::span<const std::byte> bytes, std::string_view name) {
    std::string_view data(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    try {
        const Header header = readHeader(data);
        Numbers numbers(data, header.encoding);
        PictureMesh mesh;
        for (const Element& element : header.elements) {
            if (element.name == "vertex" && mesh.positions.empty()) {
                readVertices(element, numbers, mesh);
            } else {
                readLists(element, numbers, element.name == "face", mesh);
            }
        }
        if (mesh.triangles.empty()) {
            wrong("it has no faces");
        }
        return mesh;
    } catch (const PlyError& error) {
        return fail(error.code, std::string(name) + ": " + error.message);
    }
}

}  // namespace relief
