#include "runtime/particles/point_list.h"

#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "formats/base/csv_reader.h"
#include "formats/base/file_io.h"
#include "formats/base/ply_reader.h"
#include "formats/base/text.h"
#include "runtime/particles/random.h"

namespace relief {
namespace {

constexpr std::array<std::string_view, 6> kNames{"x", "y", "z", "nx", "ny", "nz"};
constexpr std::size_t kFields = kNames.size();
using Fields = std::array<double, kFields>;

constexpr std::size_t kHeaderLinesMax = 4096;  // more than any program writes

tl::unexpected<Error> wrong(const std::string& where, const std::string& what) {
    return fail(ErrorCode::kInvalidInput, where + ": " + what);
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

// --- comma-separated text ---

/// \return nullopt where a field is no number, or where there are too many.
std::optional<Fields> parseFields(std::span<const std::string_view> words) {
    Fields fields{};
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::optional<double> value = i < kFields ? parseDouble(words[i]) : std::nullopt;
        if (!value) {
            return std::nullopt;
        }
        fields[i] = *value;
    }
    return fields;
}

Result<PointList> parseCsv(std::string_view text, const std::string& name) {
    PointList list;
    CsvReader reader(text);
    std::size_t columns = 0;
    bool words_let_pass = false;
    while (reader.next()) {
        const std::size_t count = reader.fields().size();
        const std::optional<Fields> fields = parseFields(reader.fields());
        if (columns == 0 && !fields && !words_let_pass) {
            words_let_pass = true;
            continue;
        }
        const std::string where = name + ":" + std::to_string(reader.number());
        if (!fields || (count != 3 && count != kFields) || (columns != 0 && count != columns)) {
            return wrong(where, columns == 0 ? "not a point; write x,y,z or x,y,z,nx,ny,nz a line"
                                             : "not a point of " + std::to_string(columns) +
                                                   " numbers, as those before it");
        }
        columns = count;
        RELIEF_TRY(add(list, *fields, count == kFields, where));
    }
    return list;
}

// --- PLY ---

/// What the header says of the vertices.
struct Header {
    std::optional<PlyEncoding> encoding;
    std::optional<std::uint64_t> vertices;
    std::vector<PlyType> properties;
    std::array<int, kFields> place{-1, -1, -1, -1, -1, -1};  // of x … nz among them; −1: not there
    std::size_t lines = 0;

    [[nodiscard]] bool positions() const { return place[0] >= 0 && place[1] >= 0 && place[2] >= 0; }
    [[nodiscard]] bool normals() const { return place[3] >= 0 && place[4] >= 0 && place[5] >= 0; }
};

Result<void> addProperty(const PlyHeaderLine& line, const std::string& where, Header& header) {
    if (!line.type || line.list) {
        return wrong(where, "a vertex's properties must be single numbers of a known type");
    }
    if (header.properties.size() == kPlyPropertiesMax) {
        return wrong(where, "more than " + std::to_string(kPlyPropertiesMax) + " properties");
    }
    for (std::size_t i = 0; i < kFields; ++i) {
        if (line.name == kNames[i]) {
            if (header.place[i] >= 0) {
                return wrong(where, "a second property " + std::string(line.name));
            }
            header.place[i] = static_cast<int>(header.properties.size());
        }
    }
    header.properties.push_back(*line.type);
    return {};
}

Result<void> addElement(const PlyHeaderLine& line, const std::string& where, Header& header) {
    if (line.name != "vertex") {
        return header.vertices ? Result<void>()
                               : wrong(where, "vertices must be the first element of a PLY of points");
    }
    if (header.vertices || !line.count) {
        return wrong(where, "vertices need one number");
    }
    header.vertices = line.count;
    return {};
}

Result<void> checkHeader(const Header& header, const std::string& name, const std::string& where) {
    if (!header.encoding || !header.positions()) {
        return wrong(where, "a PLY of points needs a format, and vertices with x, y and z");
    }
    if (*header.vertices > kPointsMax) {
        return fail(ErrorCode::kLimit, name + ": " + std::to_string(*header.vertices) +
                                           " points are more than " + std::to_string(kPointsMax) +
                                           "; leave some out");
    }
    return {};
}

/// Everything up to end_header, which is cut off `text`.
Result<Header> takeHeader(std::string_view& text, const std::string& name) {
    using Kind = PlyHeaderLine::Kind;
    Header header;
    bool in_vertices = false;
    for (header.lines = 1; header.lines <= kHeaderLinesMax; ++header.lines) {
        const std::optional<PlyHeaderLine> line = takePlyHeaderLine(text);
        if (!line) {
            break;
        }
        const std::string where = name + ":" + std::to_string(header.lines);
        if (line->kind == Kind::kFormat) {
            header.encoding = line->encoding;
            if (!line->encoding) {
                return wrong(where, "unknown PLY format; write ascii or binary_little_endian");
            }
        } else if (line->kind == Kind::kElement) {
            in_vertices = line->name == "vertex";
            RELIEF_TRY(addElement(*line, where, header));
        } else if (line->kind == Kind::kProperty && in_vertices) {
            RELIEF_TRY(addProperty(*line, where, header));
        } else if (line->kind == Kind::kEnd) {
            RELIEF_TRY(checkHeader(header, name, where));
            return header;
        }
    }
    return wrong(name, "a PLY header without end_header");
}

Result<PointList> parsePly(std::string_view text, const std::string& name) {
    const Header header = RELIEF_TRY(takeHeader(text, name));
    const bool ascii = *header.encoding == PlyEncoding::kAscii;
    PointList list;
    std::vector<double> values(header.properties.size());
    PlyNumbers numbers(text, *header.encoding);
    std::size_t line_number = header.lines;
    for (std::uint64_t vertex = 0; vertex < *header.vertices; ++vertex) {
        if (ascii) {  // a vertex a line
            std::string_view line;
            while (line.empty() && !text.empty()) {
                line = trimmed(takeLine(text));
                ++line_number;
            }
            numbers = PlyNumbers(line, *header.encoding);
        }
        const std::string where =
            name + (ascii ? ":" + std::to_string(line_number) : ": vertex " + std::to_string(vertex));
        for (std::size_t i = 0; i < values.size(); ++i) {
            const std::optional<double> value = numbers.next(header.properties[i]);
            if (!value) {
                return wrong(where,
                             ascii ? "fewer numbers than the header announces" : "the file ends early");
            }
            values[i] = *value;
        }
        Fields fields{};
        for (std::size_t i = 0; i < kFields; ++i) {
            fields[i] = header.place[i] >= 0 ? values[static_cast<std::size_t>(header.place[i])] : 0.0;
        }
        RELIEF_TRY(add(list, fields, header.normals(), where));
    }
    return list;
}

}  // namespace

Result<PointList> parsePointList(std::span<const std::byte> bytes, const std::string& name) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    std::string_view rest = text;
    auto list = trimmed(takeLine(rest)) == "ply" ? parsePly(text, name) : parseCsv(text, name);
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
