#include "runtime/particles/point_list.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "formats/base/file_io.h"
#include "runtime/particles/random.h"

namespace relief {
namespace {

using namespace std::string_view_literals;

constexpr std::array<std::string_view, 6> kNames{"x", "y", "z", "nx", "ny", "nz"};
constexpr std::size_t kFields = kNames.size();
using Fields = std::array<double, kFields>;

// More than any program writes; a header of millions of lines is none.
constexpr std::size_t kPropertiesMax = 256;
constexpr std::size_t kHeaderLinesMax = 4096;

Result<void> wrong(const std::string& where, const std::string& what) {
    return fail(ErrorCode::kInvalidInput, where + ": " + what);
}

/// The next line of `text`, which loses it; without its end, be it \n or \r\n.
std::string_view takeLine(std::string_view& text) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    if (line.ends_with('\r')) {
        line.remove_suffix(1);
    }
    return line;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) {
        return {};
    }
    return text.substr(first, text.find_last_not_of(" \t") + 1 - first);
}

/// The next word of a line, which loses it; empty at its end.
std::string_view takeWord(std::string_view& line) {
    line = trimmed(line);
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    const std::string_view word = line.substr(0, end);
    line = line.substr(end);
    return word;
}

template <class T>
std::optional<T> numberOf(std::string_view word) {
    if (word.starts_with('+')) {
        word.remove_prefix(1);
    }
    T value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc() || end != word.data() + word.size()) {
        return std::nullopt;
    }
    return value;
}

/// Checks and adds one point. \param where  of it, for messages.
Result<void> add(PointList& list, const Fields& fields, bool normals, const std::string& where) {
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(std::abs(fields[i]) <= kPointCoordinateMax)) {
            return wrong(where, "a coordinate is no number within 1e9 of 0");
        }
    }
    if (list.positions.size() == kPointsMax) {
        return fail(ErrorCode::kLimit,
                    where + ": more than " + std::to_string(kPointsMax) + " points; leave some out");
    }
    const auto vector = [&](std::size_t at) {
        return glm::vec3(static_cast<float>(fields[at]), static_cast<float>(fields[at + 1]),
                         static_cast<float>(fields[at + 2]));
    };
    if (normals) {
        const glm::vec3 normal = unitVector(vector(3));
        if (normal == glm::vec3(0.0F)) {
            return wrong(where, "a normal has no direction; leave the normals out, or give every point one");
        }
        list.normals.push_back(normal);
    }
    list.positions.push_back(vector(0));
    return {};
}

Result<PointList> parseCsv(std::string_view text, const std::string& name) {
    PointList list;
    std::size_t columns = 0;
    bool words_let_pass = false;
    for (std::size_t number = 1; !text.empty(); ++number) {
        std::string_view line = trimmed(takeLine(text));
        if (line.empty() || line.starts_with('#')) {
            continue;
        }
        const auto where = [&] { return name + ":" + std::to_string(number); };
        Fields fields{};
        std::size_t count = 0;
        bool good = true;
        for (bool more = true; more; ++count) {
            const std::size_t comma = line.find(',');
            more = comma != std::string_view::npos;
            const auto value = numberOf<double>(trimmed(line.substr(0, comma)));
            line = more ? line.substr(comma + 1) : std::string_view{};
            good = good && value && count < kFields;
            if (good) {
                fields[count] = *value;
            }
        }
        if (columns == 0 && !good && !words_let_pass) {
            words_let_pass = true;
            continue;
        }
        if (!good || (count != 3 && count != kFields) || (columns != 0 && count != columns)) {
            return forward(wrong(where(), columns == 0 ? "not a point; write x,y,z or x,y,z,nx,ny,nz a line"
                                                       : "not a point of " + std::to_string(columns) +
                                                             " numbers, as those before it"));
        }
        columns = count;
        RELIEF_TRY(add(list, fields, count == kFields, where()));
    }
    return list;
}

enum class Scalar : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };
enum class Encoding : std::uint8_t { kAscii, kLittle, kBig };

std::optional<Scalar> scalarOf(std::string_view word) {
    struct Name {
        std::string_view word;
        Scalar scalar;
    };
    static constexpr Name kScalars[] = {
        {"char", Scalar::kInt8},     {"int8", Scalar::kInt8},     {"uchar", Scalar::kUint8},
        {"uint8", Scalar::kUint8},   {"short", Scalar::kInt16},   {"int16", Scalar::kInt16},
        {"ushort", Scalar::kUint16}, {"uint16", Scalar::kUint16}, {"int", Scalar::kInt32},
        {"int32", Scalar::kInt32},   {"uint", Scalar::kUint32},   {"uint32", Scalar::kUint32},
        {"float", Scalar::kFloat},   {"float32", Scalar::kFloat}, {"double", Scalar::kDouble},
        {"float64", Scalar::kDouble}};
    for (const Name& name : kScalars) {
        if (name.word == word) {
            return name.scalar;
        }
    }
    return std::nullopt;
}

std::size_t sizeOf(Scalar scalar) {
    static constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(scalar)];
}

/// A number of a binary file. \param bytes  holds it at its start.
double decode(std::string_view bytes, Scalar scalar, bool big) {
    const std::size_t size = sizeOf(scalar);
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
        const auto byte = static_cast<unsigned char>(bytes[big ? size - 1 - i : i]);
        bits |= std::uint64_t{byte} << (8 * i);
    }
    switch (scalar) {
        case Scalar::kInt8:
            return static_cast<std::int8_t>(bits);
        case Scalar::kInt16:
            return static_cast<std::int16_t>(bits);
        case Scalar::kInt32:
            return static_cast<std::int32_t>(bits);
        case Scalar::kFloat:
            return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
        case Scalar::kDouble:
            return std::bit_cast<double>(bits);
        default:
            return static_cast<double>(bits);
    }
}

struct Header {
    Encoding encoding = Encoding::kAscii;
    std::uint64_t vertices = 0;
    std::vector<Scalar> properties;                          // of a vertex
    std::array<int, kFields> place{-1, -1, -1, -1, -1, -1};  // of x … nz among them; −1: not there
    std::size_t lines = 0;

    [[nodiscard]] bool normals() const { return place[3] >= 0 && place[4] >= 0 && place[5] >= 0; }
};

/// One "property …" line of the vertices.
Result<void> parseProperty(std::string_view line, const std::string& where, Header& header) {
    const std::optional<Scalar> scalar = scalarOf(takeWord(line));
    const std::string_view property = takeWord(line);
    if (!scalar || property.empty()) {
        return wrong(where, "a vertex's properties must be single numbers of a known type");
    }
    if (header.properties.size() == kPropertiesMax) {
        return wrong(where, "more than " + std::to_string(kPropertiesMax) + " properties");
    }
    for (std::size_t i = 0; i < kFields; ++i) {
        if (property == kNames[i]) {
            if (header.place[i] >= 0) {
                return wrong(where, "a second property " + std::string(property));
            }
            header.place[i] = static_cast<int>(header.properties.size());
        }
    }
    header.properties.push_back(*scalar);
    return {};
}

/// Everything up to end_header, which `text` loses.
Result<Header> parseHeader(std::string_view& text, const std::string& name) {
    Header header;
    bool format = false;
    bool in_vertices = false;
    bool vertices = false;
    for (header.lines = 1; header.lines <= kHeaderLinesMax && !text.empty(); ++header.lines) {
        std::string_view line = takeLine(text);
        const std::string where = name + ":" + std::to_string(header.lines);
        const std::string_view key = takeWord(line);
        if (key == "format"sv) {
            const std::string_view word = takeWord(line);
            format = true;
            if (word == "ascii"sv) {
                header.encoding = Encoding::kAscii;
            } else if (word == "binary_little_endian"sv) {
                header.encoding = Encoding::kLittle;
            } else if (word == "binary_big_endian"sv) {
                header.encoding = Encoding::kBig;
            } else {
                return forward(wrong(where, "unknown PLY format; write ascii or binary_little_endian"));
            }
        } else if (key == "element"sv) {
            in_vertices = takeWord(line) == "vertex"sv;
            if (!in_vertices && !vertices) {
                return forward(wrong(where, "vertices must be the first element of a PLY of points"));
            }
            if (in_vertices) {
                const auto count = numberOf<std::uint64_t>(takeWord(line));
                if (vertices || !count) {
                    return forward(wrong(where, "vertices need one number"));
                }
                vertices = true;
                header.vertices = *count;
            }
        } else if (key == "property"sv && in_vertices) {
            RELIEF_TRY(parseProperty(line, where, header));
        } else if (key == "end_header"sv) {
            if (!format || header.place[0] < 0 || header.place[1] < 0 || header.place[2] < 0) {
                return forward(wrong(where, "a PLY of points needs a format, and vertices with x, y and z"));
            }
            if (header.vertices > kPointsMax) {
                return fail(ErrorCode::kLimit, name + ": " + std::to_string(header.vertices) +
                                                   " points are more than " + std::to_string(kPointsMax) +
                                                   "; leave some out");
            }
            return header;
        }
    }
    return forward(wrong(name, "a PLY header without end_header"));
}

Result<PointList> parsePly(std::string_view text, const std::string& name) {
    const auto header = RELIEF_TRY(parseHeader(text, name));
    PointList list;
    std::vector<double> values(header.properties.size());
    std::size_t line_number = header.lines;
    for (std::uint64_t vertex = 0; vertex < header.vertices; ++vertex) {
        std::string_view line;
        while (header.encoding == Encoding::kAscii && line.empty() && !text.empty()) {
            line = trimmed(takeLine(text));
            ++line_number;
        }
        const auto where = [&] {
            return header.encoding == Encoding::kAscii ? name + ":" + std::to_string(line_number)
                                                       : name + ": vertex " + std::to_string(vertex);
        };
        for (std::size_t i = 0; i < values.size(); ++i) {
            const Scalar scalar = header.properties[i];
            if (header.encoding == Encoding::kAscii) {
                const auto value = numberOf<double>(takeWord(line));
                if (!value) {
                    return forward(wrong(where(), "fewer numbers than the header announces"));
                }
                values[i] = *value;
            } else {
                if (text.size() < sizeOf(scalar)) {
                    return forward(wrong(where(), "the file ends early"));
                }
                values[i] = decode(text, scalar, header.encoding == Encoding::kBig);
                text.remove_prefix(sizeOf(scalar));
            }
        }
        Fields fields{};
        for (std::size_t i = 0; i < kFields; ++i) {
            fields[i] = header.place[i] >= 0 ? values[static_cast<std::size_t>(header.place[i])] : 0.0;
        }
        RELIEF_TRY(add(list, fields, header.normals(), where()));
    }
    return list;
}

}  // namespace

Result<PointList> parsePointList(std::span<const std::byte> bytes, const std::string& name) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    std::string_view rest = text;
    auto list = trimmed(takeLine(rest)) == "ply"sv ? parsePly(text, name) : parseCsv(text, name);
    if (list && list->positions.empty()) {
        return fail(ErrorCode::kInvalidInput, name + ": holds no points; write x,y,z a line");
    }
    return list;
}

Result<PointList> loadPointList(const std::filesystem::path& path) {
    const auto bytes = RELIEF_TRY(readFile(path, kPointBytesMax));
    return parsePointList(bytes, quotedPath(path));
}

}  // namespace relief
