// SPDX-License-Identifier: Apache-2.0
// assimp 5.2 is not used: it accepts truncated files, replaces out-of-range indices, rotates objects the wrong way, and
// does not move the kids of a translated object (mesh_import_test.cpp).
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bake/import/import_readers.h"
#include "bake/import/import_scene.h"
#include "formats/base/text.h"
#include "formats/base/text_scanner.h"
#include "formats/polygons/decimal.h"

namespace relief {
namespace {

/// Maximum nesting of objects; later stages recurse.
constexpr std::size_t kDepthMax = 1000;

/// Low digit of a surface's flags.
enum SurfaceKind : std::uint64_t { kPolygon = 0, kClosedLine = 1, kLine = 2, kStripSurface = 4 };

using ByMaterial = std::map<std::uint64_t, PolygonMesh>;

class Ac3dReader {
  public:
    explicit Ac3dReader(const ImportJob& job) : job_(job), text_(textOf(job.bytes)) {}

    Result<ImportScene> read() {
        if (!text_.anyWord().starts_with("AC3D")) {
            return wrongLine(line(), "it does not begin with AC3D; export it again");
        }
        for (std::string_view word = text_.anyWord(); !word.empty(); word = text_.anyWord()) {
            if (word == "MATERIAL" || word == "MAT") {
                materials_.push_back(nameOf(text_.restOfLine()));
            } else if (word == "OBJECT") {
                RELIEF_TRY(readObject());
            } else {
                text_.nextLine();  // the rest of a material, or keys of later versions
            }
        }
        std::uint64_t missing = 0;
        for (const Parent& parent : open_) {
            missing += std::min(parent.kids, kTriangleMax);
        }
        if (missing > 0) {  // common in practice
            scene_.warnings.push_back(
                "it has " + std::to_string(missing) +
                " fewer objects than its 'kids' declare; if some are missing, copy or export it again");
        }
        if (subdivided_ > 0) {
            scene_.warnings.push_back(std::to_string(subdivided_) +
                                      " of its objects use subdivision; baked as modelled, without it");
        }
        return std::move(scene_);
    }

  private:
    /// An object whose kids follow.
    struct Parent {
        std::uint32_t node;
        std::uint64_t kids;
    };

    [[nodiscard]] std::size_t line() const { return lines_before_ + text_.line(); }

    [[nodiscard]] tl::unexpected<Error> cutOff(const std::string& what) const {
        return wrongLine(line(),
                         "it ends too early: " + what + "; it was probably cut off; copy or export it again");
    }

    static std::string nameOf(std::string_view words) {
        if (words.empty() || words.front() != '"') {
            return std::string(words.substr(0, words.find_first_of(" \t")));
        }
        words.remove_prefix(1);
        return std::string(words.substr(0, words.find('"')));
    }

    Result<std::uint64_t> count(std::string_view what) {
        const std::string_view word = text_.word();
        if (const std::optional<std::uint64_t> value = parseUnsigned(word)) {
            return *value;
        }
        return wrongLine(line(), quotedWord(word) + " is not a number of " + std::string(what) +
                                     "; repair the file or export it again");
    }

    Result<double> number() {
        const std::string_view word = text_.anyWord();
        if (const std::optional<float> value = readDecimal(word)) {
            return double{*value};
        }
        return word.empty() ? Result<double>(cutOff("a number is missing"))
                            : Result<double>(wrongLine(line(), noNumber(word)));
    }

    /// Reads an object up to its kids, which follow it.
    Result<void> readObject() {
        const auto index = static_cast<std::uint32_t>(scene_.nodes.size());
        depths_.push_back(open_.empty() ? 0 : depths_[open_.back().node] + 1);
        if (open_.empty()) {
            scene_.roots.push_back(index);
        } else {
            scene_.nodes[open_.back().node].children.push_back(index);
            --open_.back().kids;
        }
        SceneNode node{Transform{}};
        node.index = index;
        if (!open_.empty()) {
            node.shown = scene_.nodes[open_.back().node].shown;
            node.is_shown = scene_.nodes[open_.back().node].is_shown;
        }
        text_.nextLine();
        positions_.clear();
        used_.clear();
        ByMaterial surfaces;
        for (std::string_view key = text_.anyWord(); key != "kids"; key = text_.anyWord()) {
            if (key.empty() || key == "OBJECT") {
                return cutOff("an object has no 'kids'");
            }
            RELIEF_TRY(readKey(key, node, surfaces));
        }
        const std::uint64_t kids = RELIEF_TRY(count("kids"));
        text_.nextLine();
        for (const std::uint8_t use : used_) {
            scene_.counts.unused += (use & 2U) == 0 ? 1 : 0;
            scene_.counts.loose += use == 0 ? 1 : 0;
        }
        for (auto& [material, polygons] : surfaces) {
            addPart(material, std::move(polygons), node);
        }
        scene_.nodes.push_back(std::move(node));
        while (!open_.empty() && open_.back().kids == 0) {
            open_.pop_back();
        }
        if (kids > 0) {
            open_.push_back({index, kids});
        }
        if (depths_.back() > kDepthMax) {
            return fail(ErrorCode::kLimit,
                        "its objects are nested deeper than " + std::to_string(kDepthMax) + "; ungroup them");
        }
        return {};
    }

    Result<void> readKey(std::string_view key, SceneNode& node, ByMaterial& surfaces) {
        if (key == "name") {
            node.names = {nameOf(text_.restOfLine())};
            node.shown = node.names[0].empty() ? node.shown : node.names[0];
        } else if (key == "hidden") {
            node.is_shown = Shown::kHidden;
        } else if (key == "loc") {
            for (int axis = 0; axis < 3; ++axis) {
                node.transform->offset[axis] = RELIEF_TRY(number());
            }
        } else if (key == "rot") {
            // The file lists the matrix column by column.
            for (int axis = 0; axis < 3; ++axis) {
                for (int i = 0; i < 3; ++i) {
                    node.transform->linear[axis][i] = RELIEF_TRY(number());
                }
            }
        } else if (key == "subdiv") {
            subdivided_ += RELIEF_TRY(count("subdivisions")) > 0 ? 1 : 0;
        } else if (key == "data") {
            return skipData();
        } else if (key == "numvert") {
            return readVertices();
        } else if (key == "SURF") {
            return readSurface(surfaces);
        }
        text_.nextLine();
        return {};
    }

    /// Skips a block of bytes, which starts on the next line.
    Result<void> skipData() {
        const std::uint64_t bytes = RELIEF_TRY(count("bytes"));
        text_.nextLine();
        const std::string_view rest = text_.rest();
        const std::string_view data = rest.substr(0, std::min<std::uint64_t>(bytes, rest.size()));
        // Here, line() is the line of the last word; the data starts on the next line.
        lines_before_ = line() + static_cast<std::size_t>(std::ranges::count(data, '\n'));
        text_ = TextScanner(rest.substr(data.size()));
        return {};
    }

    Result<void> readVertices() {
        const std::uint64_t vertices = RELIEF_TRY(count("vertices"));
        text_.nextLine();
        vertices_ += vertices;
        RELIEF_TRY(checkVertexCount(vertices_));
        for (std::uint64_t i = 0; i < vertices; ++i) {
            glm::vec3 position(0.0F);
            for (int axis = 0; axis < 3; ++axis) {
                position[axis] = static_cast<float>(RELIEF_TRY(number()));
            }
            positions_.push_back(position);
            text_.nextLine();  // TORCS appends normals
        }
        scene_.counts.vertices += vertices;
        used_.resize(positions_.size(), 0);
        return {};
    }

    Result<std::uint64_t> flags() {
        const std::string_view word = text_.word();
        const std::string_view digits =
            word.starts_with("0x") || word.starts_with("0X") ? word.substr(2) : std::string_view();
        std::uint32_t value = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
        return error == std::errc() && end == digits.data() + digits.size() && digits.size() <= 8
                   ? Result<std::uint64_t>(value)
                   : wrongLine(line(), quotedWord(word) + " is not a number such as 0x20; repair the file");
    }

    Result<void> readSurface(ByMaterial& surfaces) {
        const std::uint64_t kind = RELIEF_TRY(flags()) & 0xFU;
        text_.nextLine();
        std::uint64_t material = 0;
        std::string_view key = text_.anyWord();
        for (; key != "refs"; key = text_.anyWord()) {
            if (key.empty() || key == "SURF" || key == "kids" || key == "OBJECT") {
                return cutOff("a surface has no 'refs'");
            }
            if (key == "mat") {
                material = RELIEF_TRY(count("a material"));
            }
            text_.nextLine();
        }
        const std::uint64_t refs = RELIEF_TRY(count("corners"));
        text_.nextLine();
        corners_.clear();
        for (std::uint64_t i = 0; i < refs; ++i) {
            const std::string_view word = text_.anyWord();
            const std::optional<std::uint64_t> corner = parseUnsigned(word);
            if (!corner || *corner >= positions_.size()) {
                return word.empty()
                           ? cutOff("corners of a surface are missing")
                           : wrongLine(line(),
                                       "a surface uses the vertex " + quotedWord(word) +
                                           ", but its object has " + std::to_string(positions_.size()) +
                                           " vertices, numbered from 0; repair the file or export it again");
            }
            corners_.push_back(static_cast<std::uint32_t>(*corner));
            text_.nextLine();  // TORCS appends one or more texture coordinates
        }
        if (kind == kClosedLine || kind == kLine) {
            ++scene_.counts.lines;
            mark(1);
            return {};
        }
        PolygonMesh& polygons = surfaces[material];
        mark(corners_.size() >= 3 ? 2 : 1);
        return kind == kStripSurface ? addStrip(polygons) : addPolygon(corners_, polygons);
    }

    /// Marks the current corners as used. \param by  1: lines and points, 2: polygons.
    void mark(std::uint8_t by) {
        for (const std::uint32_t corner : corners_) {
            used_[corner] |= by;
        }
    }

    Result<void> addPolygon(const std::vector<std::uint32_t>& corners, PolygonMesh& polygons) {
        MeshParts& counts = scene_.counts;
        counts.polygons += corners.size() >= 3 ? 1 : 0;
        counts.lines += corners.size() == 2 ? 1 : 0;
        counts.points += corners.size() == 1 ? 1 : 0;
        if (corners.size() >= 3) {
            polygons.corners.insert(polygons.corners.end(), corners.begin(), corners.end());
            polygons.sizes.push_back(static_cast<std::uint32_t>(corners.size()));
            triangles_ += corners.size() - 2;
        }
        return triangles_ > job_.triangle_max ? Result<void>(tooManyTriangles(job_)) : Result<void>();
    }

    /// Flips every other triangle of a strip. Skips triangles with a repeated corner, which join strips.
    Result<void> addStrip(PolygonMesh& polygons) {
        for (std::size_t i = 0; i + 2 < corners_.size(); ++i) {
            const std::uint32_t a = corners_[i + i % 2];
            const std::uint32_t b = corners_[i + 1 - i % 2];
            const std::uint32_t c = corners_[i + 2];
            if (a != b && b != c && c != a) {
                RELIEF_TRY(addPolygon({a, b, c}, polygons));
            }
        }
        return {};
    }

    void addPart(std::uint64_t material, PolygonMesh polygons, SceneNode& node) {
        polygons.positions = positions_;
        ScenePart part = triangulatePolygons(polygons);
        if (part.triangles.empty()) {
            return;
        }
        compact(polygons.positions, part);
        part.material = material < materials_.size() ? materials_[material] : std::string();
        part.names = {node.names.empty() ? std::string() : node.names[0], part.material};
        node.parts.push_back(static_cast<std::uint32_t>(scene_.parts.size()));
        scene_.parts.push_back(std::move(part));
    }

    const ImportJob& job_;
    TextScanner text_;
    std::size_t lines_before_ = 0;  // before text_
    ImportScene scene_;
    std::vector<std::string> materials_;
    std::vector<Parent> open_;
    std::vector<std::size_t> depths_;  // by node
    std::uint64_t vertices_ = 0;
    std::uint64_t triangles_ = 0;
    std::uint64_t subdivided_ = 0;
    // The current object:
    std::vector<glm::vec3> positions_;
    std::vector<std::uint8_t> used_;      // per position; see mark()
    std::vector<std::uint32_t> corners_;  // of the current surface
};

}  // namespace

Result<ImportScene> readAc3d(const ImportJob& job) {
    return Ac3dReader(job).read();
}

}  // namespace relief
