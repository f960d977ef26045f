// SPDX-License-Identifier: Apache-2.0
// assimp 5.2 is not used: it reads text that is truncated after a facet as a smaller mesh, and reads no triangles from
// a binary file whose header begins with "solid" if bytes follow the last triangle (import_text_test.cpp, Stl and
// BinaryStlWithAnyHeaderAndLength).
#include "bake/import/import_readers.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "formats/base/text.h"
#include "formats/base/text_scanner.h"
#include "formats/polygons/decimal.h"

namespace relief {
namespace {

constexpr std::size_t kStlHeader = 84;  // bytes, including the count
constexpr std::size_t kTriangle = 50;   // bytes: a normal, three corners, two attribute bytes

void addTriangle(const std::array<glm::vec3, 3>& corners, PolygonMesh& mesh) {
    for (const glm::vec3& corner : corners) {
        mesh.corners.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
        mesh.positions.push_back(corner);
    }
    mesh.sizes.push_back(3);
}

std::uint64_t declaredTriangles(std::span<const std::byte> bytes) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + kStlHeader - sizeof(count), sizeof(count));
    return count;
}

Result<PolygonMesh> readBinary(std::span<const std::byte> bytes) {
    if (bytes.size() < kStlHeader) {
        return invalidInput(
            "it does not begin with 'solid', and is shorter than a binary STL's header; copy or "
            "export it again");
    }
    const std::uint64_t count = declaredTriangles(bytes);
    if (const std::uint64_t held = (bytes.size() - kStlHeader) / kTriangle; held < count) {
        return invalidInput("its header declares " + std::to_string(count) + " triangles, but it has " +
                            std::to_string(held) + " and was probably cut off; copy or export it again");
    }
    RELIEF_TRY(checkTriangleCount(count));
    PolygonMesh mesh;
    const std::byte* at = bytes.data() + kStlHeader;
    for (std::uint64_t i = 0; i < count; ++i, at += kTriangle) {
        std::array<glm::vec3, 3> corners{};
        std::memcpy(corners.data(), at + 12, sizeof(corners));
        addTriangle(corners, mesh);
    }
    if (const auto trailing = static_cast<std::uint64_t>(bytes.data() + bytes.size() - at); trailing > 0) {
        mesh.warnings.push_back("left out " + std::to_string(trailing) + " bytes after the " +
                                std::to_string(count) + " triangles of its header");
    }
    return mesh;
}

class StlText {
  public:
    explicit StlText(std::string_view text) : text_(text) {}

    Result<PolygonMesh> read() {
        for (std::string word = next(); !word.empty(); word = next()) {
            if (word != "solid") {
                return unexpected("'solid'");
            }
            RELIEF_TRY(readSolid());
        }
        return std::move(mesh_);
    }

  private:
    /// Returns the next word in lower case; word_ keeps its case.
    std::string next() {
        word_ = text_.anyWord();
        return lowerCase(word_);
    }

    [[nodiscard]] tl::unexpected<Error> unexpected(const char* wanted) const {
        if (word_.empty()) {
            return wrongLine(text_.line(), std::string("it ends without ") + wanted +
                                               " and was probably cut off; copy or export it again");
        }
        return wrongLine(text_.line(), quotedWord(word_) + " appears instead of " + wanted +
                                           "; repair the file or export it again");
    }

    Result<void> expect(const char* wanted) {
        return next() == wanted ? Result<void>() : unexpected(("'" + std::string(wanted) + "'").c_str());
    }

    /// Reads a solid; its name is the first word after "solid" on the line.
    Result<void> readSolid() {
        PolygonGroup group;
        group.begin = mesh_.sizes.size();
        group.node = text_.word();
        group.names = {group.node};
        mesh_.groups.push_back(std::move(group));
        static_cast<void>(text_.restOfLine());
        std::string word = next();
        for (; word == "facet"; word = next()) {
            RELIEF_TRY(readFacet());
        }
        if (word != "endsolid") {
            return unexpected("'facet' or 'endsolid'");
        }
        static_cast<void>(text_.restOfLine());
        return {};
    }

    Result<void> readFacet() {
        std::string word = next();
        if (word == "normal") {
            // Skips the normal; some writers put NaN or worse there.
            do {
                word = next();
            } while (!word.empty() && word != "outer" && word != "vertex" && word != "endfacet");
        }
        if (word != "outer") {
            return unexpected("'outer loop'");
        }
        RELIEF_TRY(expect("loop"));
        std::array<glm::vec3, 3> corners{};
        for (glm::vec3& corner : corners) {
            RELIEF_TRY(expect("vertex"));
            for (int i = 0; i < 3; ++i) {
                const std::string_view number = text_.anyWord();
                const std::optional<float> value = readDecimal(number);
                if (!value) {
                    word_ = number;
                    return number.empty() ? unexpected("a number")
                                          : wrongLine(text_.line(), noNumber(number));
                }
                corner[i] = *value;
            }
        }
        RELIEF_TRY(expect("endloop"));
        RELIEF_TRY(expect("endfacet"));
        addTriangle(corners, mesh_);
        return checkTriangleCount(mesh_.sizes.size());
    }

    TextScanner text_;
    std::string_view word_;
    PolygonMesh mesh_;
};

bool isText(std::span<const std::byte> bytes) {
    if (bytes.size() >= kStlHeader && bytes.size() >= kStlHeader + declaredTriangles(bytes) * kTriangle) {
        return false;
    }
    // A truncated binary file may begin with "solid", too; its header is padded with zeros.
    TextScanner scanner(textOf(bytes));
    return lowerCase(scanner.anyWord()) == "solid" &&
           scanner.rest().substr(0, kStlHeader).find('\0') == std::string_view::npos;
}

}  // namespace

Result<PolygonMesh> readStl(std::span<const std::byte> bytes) {
    return isText(bytes) ? StlText(textOf(bytes)).read() : readBinary(bytes);
}

}  // namespace relief
