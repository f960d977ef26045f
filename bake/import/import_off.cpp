// SPDX-License-Identifier: Apache-2.0
// assimp 5.2 is not used: it accepts truncated files, and replaces out-of-range indices (import_text_test.cpp, Off).
#include "bake/import/import_readers.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "formats/base/text.h"
#include "formats/base/text_scanner.h"
#include "formats/polygons/decimal.h"

namespace relief {
namespace {

/// Kinds of elements that end at a line break. The rest of the line may hold colours and similar data, as the format
/// specifies. Other elements continue across lines.
struct EndsWithLine {
    bool vertex = true;
    bool face = true;
};

class OffReader {
  public:
    OffReader(std::string_view text, EndsWithLine ends) : text_(text, {'#', false}), ends_(ends) {}

    Result<PolygonMesh> read() {
        RELIEF_TRY(readHeader());
        for (std::uint64_t i = 0; i < vertices_; ++i) {
            RELIEF_TRY(readVertex(i));
        }
        std::uint64_t triangles = 0;
        for (std::uint64_t i = 0; i < faces_; ++i) {
            triangles += RELIEF_TRY(readFace(i));
            RELIEF_TRY(checkTriangleCount(triangles));
        }
        if (const std::string_view word = text_.anyWord(); !word.empty()) {
            return wrongLine(text_.line(),
                             quotedWord(word) + " follows the " + counts() +
                                 " that its header declares; fix the counts or export it again");
        }
        return std::move(mesh_);
    }

    [[nodiscard]] bool spansLines() const { return spans_lines_; }

  private:
    Result<void> readHeader() {
        std::string_view word = text_.anyWord();
        const std::string name = lowerCase(word);
        if (name.ends_with("off")) {
            // Colours, normals and similar data follow a vertex's coordinates; nOFF has any number of coordinates, 4OFF
            // four.
            if (name.find_first_not_of("stcnof") != std::string::npos || word.ends_with("nOFF")) {
                return wrongLine(text_.line(),
                                 quotedWord(word) + " is not a three-dimensional OFF; save it as OFF");
            }
            extra_numbers_ = (name.find("st") != std::string::npos ? 2 : 0) +
                             (name.find('c') != std::string::npos ? 4 : 0) +
                             (name.find('n') != std::string::npos ? 3 : 0);
            word = text_.anyWord();
            if (lowerCase(word) == "binary") {
                return wrongLine(text_.line(), "binary OFF is not supported; save it as text, or as PLY");
            }
        }
        vertices_ = RELIEF_TRY(countOf(word));
        faces_ = RELIEF_TRY(countOf(text_.anyWord()));
        // The count of edges is unused, and some writers omit it.
        if (text_.atLineEnd()) {
            TextScanner ahead = text_;
            const bool is_edge_count = parseUnsigned(ahead.anyWord()) && ahead.atLineEnd();
            text_ = is_edge_count ? ahead : text_;
        } else {
            static_cast<void>(RELIEF_TRY(countOf(text_.word())));
        }
        return checkVertexCount(vertices_);
    }

    Result<std::uint64_t> countOf(std::string_view word) const {
        if (const std::optional<std::uint64_t> count = parseUnsigned(word)) {
            return *count;
        }
        return wrongLine(text_.line(),
                         quotedWord(word) +
                             " is not a count; an OFF begins with OFF and the counts of vertices, "
                             "faces and edges; repair the file or export it again");
    }

    [[nodiscard]] std::string counts() const {
        return std::to_string(vertices_) + " vertices and " + std::to_string(faces_) + " faces";
    }

    [[nodiscard]] tl::unexpected<Error> cutOff(const std::string& where) const {
        return wrongLine(text_.line(), "it ends " + where + ", but its header declares " + counts() +
                                           "; it was probably cut off; copy or export it again");
    }

    Result<float> number(std::string_view word, const char* element, std::uint64_t index) const {
        if (const std::optional<float> value = readDecimal(word)) {
            return *value;
        }
        return word.empty()
                   ? Result<float>(cutOff("in " + std::string(element) + " " + std::to_string(index)))
                   : Result<float>(wrongLine(text_.line(), noNumber(word)));
    }

    Result<void> readVertex(std::uint64_t index) {
        glm::vec3 position(0.0F);
        for (int i = 0; i < 3; ++i) {
            spans_lines_ = spans_lines_ || (i > 0 && text_.atLineEnd());
            position[i] = RELIEF_TRY(number(text_.anyWord(), "vertex", index));
        }
        mesh_.positions.push_back(position);
        if (ends_.vertex) {
            return skipLine("vertex", index);
        }
        for (int i = 0; i < extra_numbers_; ++i) {
            (void)RELIEF_TRY(number(text_.anyWord(), "vertex", index));
        }
        return {};
    }

    /// Returns the number of triangles.
    Result<std::uint64_t> readFace(std::uint64_t index) {
        const std::string_view word = text_.anyWord();
        if (word.empty()) {
            return cutOff("after face " + std::to_string(index) + " of " + std::to_string(faces_));
        }
        const std::optional<std::uint64_t> corners = parseUnsigned(word);
        if (!corners || *corners == 0) {
            return wrongLine(text_.line(),
                             quotedWord(word) +
                                 " is not a face's number of corners; repair the file or export "
                                 "it again");
        }
        for (std::uint64_t i = 0; i < *corners; ++i) {
            spans_lines_ = spans_lines_ || text_.atLineEnd();
            const std::string_view corner = text_.anyWord();
            const std::optional<std::uint64_t> vertex = parseUnsigned(corner);
            if (corner.empty()) {
                return cutOff("in face " + std::to_string(index));
            }
            if (!vertex || *vertex >= vertices_) {
                return wrongLine(text_.line(),
                                 "face " + std::to_string(index) + " uses the vertex " + quotedWord(corner) +
                                     ", but there are " + std::to_string(vertices_) +
                                     " vertices, numbered from 0; repair the file or export it again");
            }
            mesh_.corners.push_back(static_cast<std::uint32_t>(*vertex));
        }
        mesh_.sizes.push_back(static_cast<std::uint32_t>(*corners));
        if (ends_.face) {
            RELIEF_TRY(skipLine("face", index));
        }
        return *corners < 3 ? 0 : *corners - 2;
    }

    /// Skips the rest of an element's line: numbers such as colours.
    Result<void> skipLine(const char* element, std::uint64_t index) {
        for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) {
            (void)RELIEF_TRY(number(word, element, index));
        }
        return {};
    }

    TextScanner text_;
    EndsWithLine ends_;
    bool spans_lines_ = false;
    int extra_numbers_ = 0;  ///< numbers after a vertex's coordinates, by the header
    std::uint64_t vertices_ = 0;
    std::uint64_t faces_ = 0;
    PolygonMesh mesh_;
};

}  // namespace

Result<PolygonMesh> readOff(std::span<const std::byte> bytes) {
    const std::string_view text = textOf(bytes);
    OffReader reader(text, {});
    Result<PolygonMesh> mesh = reader.read();
    // The first attempt skips all words after the first element of a line, as colours. If it fails, or reads an element
    // across lines, a line may contain several elements: tries the other layouts.
    for (const EndsWithLine ends : {EndsWithLine{false, false}, {true, false}, {false, true}}) {
        if (mesh && !reader.spansLines()) {
            break;
        }
        if (Result<PolygonMesh> again = OffReader(text, ends).read()) {
            return again;
        }
    }
    return mesh;
}

}  // namespace relief
