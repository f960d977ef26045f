// SPDX-License-Identifier: Apache-2.0
#include "runtime/births/point_list.h"

#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include "formats/base/file_io.h"
#include "formats/base/result.h"
#include "formats/base/text.h"
#include "formats/base/text_scanner.h"
#include "formats/polygons/ply_reader.h"
#include "runtime/particles/random.h"

namespace relief {
namespace {

constexpr std::array<std::string_view, 6> kNames{"x", "y", "z", "nx", "ny", "nz"};
constexpr std::size_t kFields = kNames.size();
using Fields = std::array<double, kFields>;

tl::unexpected<Error> wrong(const std::string& where, const std::string& what) {
    return fail(ErrorCode::kInvalidInput, where + ": " + what);
}

/// Checks and adds a point. \param where  its position in the file, for messages.
Result<void> add(PointList& list, const Fields& fields, bool normals, const std::string& where) {
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(std::abs(fields[i]) <= kPointCoordinateMax)) {
            return wrong(where, "a coordinate is not a number from -1e9 to 1e9");
        }
    }
    if (list.positions.size() == kPointsMax) {
        return fail(ErrorCode::kLimit,
                    where + ": more than " + std::to_string(kPointsMax) + " points; remove some");
    }
    const auto vector = [&](std::size_t at) {
        return glm::vec3(static_cast<float>(fields[at]), static_cast<float>(fields[at + 1]),
                         static_cast<float>(fields[at + 2]));
    };
    if (normals) {
        const glm::vec3 normal = unitVector(vector(3));
        if (normal == glm::vec3(0.0F)) {
            return wrong(where, "a normal has no direction; omit the normals, or give every point one");
        }
        list.normals.push_back(normal);
    }
    list.positions.push_back(vector(0));
    return {};
}

// --- comma-separated text ---

/// \return nullopt if a field is not a number or there are too many fields.
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
    bool header_skipped = false;
    while (reader.next()) {
        const std::size_t count = reader.fields().size();
        const std::optional<Fields> fields = parseFields(reader.fields());
        if (columns == 0 && !fields && !header_skipped) {
            header_skipped = true;
            continue;
        }
        const std::string where = name + ":" + std::to_string(reader.number());
        if (!fields || (count != 3 && count != kFields) || (columns != 0 && count != columns)) {
            return wrong(where, columns == 0 ? "not a point; write x,y,z or x,y,z,nx,ny,nz in each line"
                                             : "not a point of " + std::to_string(columns) +
                                                   " numbers like the previous ones");
        }
        columns = count;
        RELIEF_TRY(add(list, *fields, count == kFields, where));
    }
    return list;
}

// --- PLY ---

/// Errors do not name the file.
Result<PlyHeader> takePointsHeader(std::string_view& text) {
    PlyHeader header = RELIEF_TRY(readPlyHeader(text));
    if (header.elements.empty() || header.elements.front().name != "vertex") {
        return invalidInput("vertices must be the first element of a PLY of points");
    }
    const std::uint64_t points = header.elements.front().count;
    if (points > kPointsMax) {
        return fail(ErrorCode::kLimit, std::to_string(points) + " points exceed the limit of " +
                                           std::to_string(kPointsMax) + "; remove some");
    }
    return header;
}

Result<PointList> parsePly(std::string_view text, const std::string& name) {
    const PlyHeader header = RELIEF_TRY(withPrefix(name, takePointsHeader(text)));
    const PlyElement& vertices = header.elements.front();
    const PlyColumns columns(vertices, kNames);
    const auto once = [&](std::size_t first) {
        return columns.count(first) == 1 && columns.count(first + 1) == 1 && columns.count(first + 2) == 1;
    };
    if (!once(0)) {
        return wrong(name, "the vertices of a PLY of points need x, y and z, each once");
    }
    const bool normals = once(3);
    PointList list;
    PlyNumbers numbers(text, header.encoding, header.lines);
    for (std::uint64_t i = 0; i < vertices.count; ++i) {
        Fields fields{};
        const std::string vertex = name + ": vertex " + std::to_string(i);
        RELIEF_TRY(withPrefix(vertex, columns.read(numbers, fields)));
        if (numbers.isText() && !numbers.atLineEnd()) {
            return wrong(
                vertex, numbers.where() + "more numbers than the header declares; write one vertex per line");
        }
        RELIEF_TRY(add(list, fields, normals, vertex));
    }
    return list;
}

}  // namespace

Result<PointList> parsePointList(std::span<const std::byte> bytes, const std::string& name) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    std::string_view rest = text;
    auto list = trimmed(popLine(rest)) == "ply" ? parsePly(text, name) : parseCsv(text, name);
    if (list && list->positions.empty()) {
        return fail(ErrorCode::kInvalidInput, name + ": contains no points; write x,y,z in each line");
    }
    return list;
}

Result<PointList> loadPointList(const std::filesystem::path& path) {
    const auto bytes = RELIEF_TRY(readFile(path, kPointBytesMax));
    return parsePointList(bytes, quotedPath(path));
}

}  // namespace relief
