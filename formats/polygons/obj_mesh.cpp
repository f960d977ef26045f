// SPDX-License-Identifier: Apache-2.0
// assimp 5.2 is not used: it reads `0,5` as 0 and rejects comments and `\` after a face (import_text_test.cpp, Obj),
// and the runtime does not link it.
#include "formats/polygons/polygon_mesh.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>
#include <utility>

#include "formats/base/finite.h"
#include "formats/base/text.h"
#include "formats/base/text_scanner.h"
#include "formats/polygons/decimal.h"

namespace relief {
namespace {

constexpr std::size_t kNameMax = 1024;  // bytes
constexpr std::array<std::string_view, 6> kFreeForms = {"curv", "surf", "bzp", "bsp", "cdc", "cdp"};

class ObjReader {
  public:
    ObjReader(std::span<const std::byte> bytes, PolygonColors colors)
        : colors_(colors), text_({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, {'#', true}) {}

    Result<ObjMesh> read() {
        do {
            RELIEF_TRY(readStatement(text_.word()));
        } while (text_.nextLine());
        if (furthest_ >= mesh_.positions.size() && furthest_line_ > 0) {
            return noVertex(furthest_line_, std::to_string(furthest_ + 1));
        }
        RELIEF_TRY(checkFinite());
        if (mesh_.colors.size() != mesh_.positions.size()) {
            mesh_.colors.clear();
        }
        for (const std::uint32_t vertex : used_by_others_) {
            mesh_.used_by_others.resize(mesh_.positions.size(), 0);
            mesh_.used_by_others[vertex] = 1;
        }
        return std::move(obj_);
    }

  private:
    Result<void> readStatement(std::string_view word) {
        if (word == "v") {
            return readVertex();
        }
        if (word == "f" || word == "fo") {
            return readFace();
        }
        if (word == "l" || word == "p") {
            return readOther(word == "l");
        }
        if (word == "g" || word == "o") {
            const std::string_view name = word == "g" ? text_.restOfLine() : text_.word();
            RELIEF_TRY(checkName(name));
            begin(name);
            group_ = word == "g" ? name_ : group_;
        } else if (word == "usemtl") {
            if (const std::string_view name = text_.restOfLine(); !name.empty()) {
                RELIEF_TRY(checkName(name));
                material_ = name;
                by_material_ = by_material_ || has_faces_;
                renamed_ = true;
            }
        } else if (word == "mtllib") {
            obj_.libraries.emplace_back(text_.restOfLine());
        } else if (std::find(kFreeForms.begin(), kFreeForms.end(), word) != kFreeForms.end()) {
            ++mesh_.others.free_forms;
        }
        return {};
    }

    /// Limits names because they are kept for each change of group or material.
    [[nodiscard]] Result<void> checkName(std::string_view name) const {
        return name.size() <= kNameMax
                   ? Result<void>()
                   : wrongLine(text_.line(), "a name of " + std::to_string(name.size()) + " bytes exceeds " +
                                                 std::to_string(kNameMax) + "; shorten it");
    }

    void begin(std::string_view name) {
        name_ = name;
        has_faces_ = by_material_ = false;
        renamed_ = true;
    }

    Result<void> readVertex() {
        std::array<float, 7> numbers{};
        std::size_t count = 0;
        const std::size_t line = text_.line();
        for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) {
            const std::optional<float> value = readDecimal(word);
            if (!value) {
                return wrongLine(text_.line(), noNumber(word));
            }
            if (count < numbers.size()) {
                numbers[count] = *value;
            }
            ++count;
        }
        if (count < 3 || count == 5 || count > numbers.size()) {
            return wrongLine(line, "a vertex of " + std::to_string(count) +
                                       " numbers; write three, optionally followed by a weight or a colour");
        }
        glm::vec3 position(numbers[0], numbers[1], numbers[2]);
        if (count == 4) {
            if (numbers[3] == 0.0F) {
                return wrongLine(line, "a vertex has weight 0; omit the weight");
            }
            position = {numbers[0] / numbers[3], numbers[1] / numbers[3], numbers[2] / numbers[3]};
        }
        if (!isFinite(position) && nonfinite_line_ == 0) {
            nonfinite_vertex_ = mesh_.positions.size();
            nonfinite_line_ = line;
        }
        mesh_.positions.push_back(position);
        if (colors_ == PolygonColors::kRead && count >= 6) {
            auto& color = mesh_.colors.emplace_back(std::array<std::uint8_t, 4>{0, 0, 0, 255});
            for (std::size_t k = 0; k < 3; ++k) {
                color[k] = static_cast<std::uint8_t>(
                    std::lround(255.0F * std::clamp(numbers[count - 3 + k], 0.0F, 1.0F)));
            }
        }
        return checkVertexCount(mesh_.positions.size());
    }

    /// Returns the vertex of a corner; it may be defined later in the file.
    Result<std::uint32_t> vertexOf(std::string_view corner) {
        const std::size_t line = text_.line();
        std::string_view digits = corner.substr(0, corner.find('/'));
        digits.remove_prefix(digits.starts_with('+') ? 1 : 0);
        std::int64_t number = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
        const bool whole = end == digits.data() + digits.size() && !digits.empty();
        if (!whole || (error != std::errc() && error != std::errc::result_out_of_range)) {
            return wrongLine(line,
                             quotedWord(corner) + " is not a vertex; repair the file or export it again");
        }
        const auto so_far = static_cast<std::int64_t>(mesh_.positions.size());
        const std::int64_t index = number > 0 ? number - 1 : so_far + number;
        if (error != std::errc() || number == 0 || number < -so_far || index > kIndexMax) {
            return noVertex(line, quotedWord(digits));
        }
        if (static_cast<std::uint64_t>(index) >= furthest_) {
            furthest_ = static_cast<std::uint64_t>(index);
            furthest_line_ = line;
        }
        return static_cast<std::uint32_t>(index);
    }

    [[nodiscard]] tl::unexpected<Error> noVertex(std::size_t line, const std::string& number) const {
        return wrongLine(line, "vertex " + number + " does not exist: there are " +
                                   std::to_string(mesh_.positions.size()) +
                                   (furthest_line_ == line ? "" : " so far") +
                                   "; repair the file or export it again");
    }

    Result<void> readFace() {
        const std::size_t line = text_.line();
        std::uint32_t count = 0;
        for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) {
            mesh_.corners.push_back(RELIEF_TRY(vertexOf(word)));
            ++count;
        }
        if (count == 0) {
            return wrongLine(line, "a face without corners; repair the file or export it again");
        }
        if (renamed_) {
            beginGroup();
        }
        has_faces_ = true;
        mesh_.sizes.push_back(count);
        triangles_ += count < 3 ? 0 : count - 2;
        return checkTriangleCount(triangles_);
    }

    void beginGroup() {
        renamed_ = false;
        PolygonGroup group;
        group.begin = mesh_.sizes.size();
        group.names.push_back(name_);
        std::string_view rest = name_;
        for (std::string_view word = popWord(rest); !word.empty(); word = popWord(rest)) {
            group.names.emplace_back(word);
        }
        group.names.push_back(by_material_ && !group_.empty() ? group_ : name_);
        group.names.push_back(material_);
        group.node = name_;
        group.material = material_;
        mesh_.groups.push_back(std::move(group));
    }

    /// Reads a line strip, or points.
    Result<void> readOther(bool line) {
        std::uint64_t count = 0;
        for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) {
            used_by_others_.push_back(RELIEF_TRY(vertexOf(word)));
            ++count;
        }
        mesh_.others.lines += line && count > 0 ? count - 1 : 0;
        mesh_.others.points += line ? 0 : count;
        return {};
    }

    /// Checks coordinates of vertices in use; the others may have any value.
    Result<void> checkFinite() const {
        const bool used = nonfinite_line_ != 0 &&
                          std::any_of(mesh_.corners.begin(), mesh_.corners.end(), [&](std::uint32_t corner) {
                              return !isFinite(mesh_.positions[corner]);
                          });
        return used ? wrongLine(nonfinite_line_, "vertex " + std::to_string(nonfinite_vertex_ + 1) +
                                                     " has a coordinate that is not finite; repair the mesh")
                    : Result<void>();
    }

    static constexpr std::int64_t kIndexMax = std::numeric_limits<std::uint32_t>::max();

    PolygonColors colors_;
    TextScanner text_;
    ObjMesh obj_;
    PolygonMesh& mesh_ = obj_.polygons;
    std::string name_;  // current group or object
    std::string group_;
    std::string material_;
    bool has_faces_ = false;    // a face uses name_
    bool by_material_ = false;  // usemtl followed such a face
    bool renamed_ = false;      // name_ or material_ was set after the last face
    std::vector<std::uint32_t> used_by_others_;
    std::uint64_t triangles_ = 0;
    std::uint64_t furthest_ = 0;  // largest vertex index of a face
    std::size_t furthest_line_ = 0;
    std::size_t nonfinite_vertex_ = 0;  // first vertex that is not finite
    std::size_t nonfinite_line_ = 0;
};

}  // namespace

Result<ObjMesh> readObj(std::span<const std::byte> bytes, PolygonColors colors) {
    return ObjReader(bytes, colors).read();
}

}  // namespace relief
