#include "bake/import/import_readers.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/base/text_scanner.h"
#include "formats/polygons/decimal.h"

namespace relief {
namespace {

constexpr std::size_t kCorners = 9;
constexpr std::size_t kColour = 3;

/// Words such as nan name a group.
bool beginsNumber(std::string_view word) {
    return word.find_first_of("0123456789") <= 2 && readDecimal(word).has_value();
}

/// Triangles of one texture in one group.
struct RawPart {
    std::string_view group;
    std::string_view texture;
    std::vector<glm::vec3> corners;
};

class RawReader {
  public:
    explicit RawReader(std::string_view text) : text_(text, {'#', false}) {}

    Result<PolygonMesh> read() {
        do {
            RELIEF_TRY(readLine());
        } while (text_.nextLine());
        return joined();
    }

  private:
    Result<void> readLine() {
        std::array<float, kColour + kCorners> numbers{};
        std::size_t count = 0;
        std::string_view word = text_.word();
        const std::size_t line = text_.line();
        if (word.empty()) {
            return {};
        }
        if (!beginsNumber(word)) {
            if (word.find_first_of("+-.0123456789") == 0) {
                return wrongLine(line, noNumber(word));
            }
            group_ = word;
            // A triangle whose first number is none is no name.
            std::size_t numbers_behind = 0;
            for (std::string_view more = text_.word(); !more.empty(); more = text_.word()) {
                numbers_behind += beginsNumber(more) ? 1 : 0;
            }
            return numbers_behind + 1 < kCorners ? Result<void>() : wrongLine(line, noNumber(group_));
        }
        for (; count < numbers.size() && beginsNumber(word); word = text_.word()) {
            numbers[count++] = *readDecimal(word);
        }
        if ((count != kCorners && count != numbers.size()) || beginsNumber(word)) {
            return wrongLine(line, std::to_string(count) +
                                       (beginsNumber(word) ? " numbers and more" : " numbers") +
                                       " are no triangle, which has 9, or 12 with its colour; the file may "
                                       "have been cut off: copy or export it again");
        }
        for (std::string_view more = text_.word(); !more.empty(); more = text_.word()) {
            if (beginsNumber(more)) {
                return wrongLine(line, noNumber(word));  // no name of a texture, with numbers behind it
            }
        }
        RawPart& part = partOf(word.empty() && count == kCorners ? kNoTexture : word);
        for (std::size_t i = count - kCorners; i < count; i += 3) {
            part.corners.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
        }
        return checkTriangleCount(++triangles_);
    }

    RawPart& partOf(std::string_view texture) {
        const auto [found, is_new] = index_.try_emplace({group_, texture}, parts_.size());
        if (is_new) {
            parts_.push_back({group_, texture, {}});
        }
        return parts_[found->second];
    }

    PolygonMesh joined() {
        // Groups in the order of the file, but the last of them first, and within a group textures likewise: bakes have
        // always had them so.
        std::map<std::string_view, std::size_t> rank;
        for (const RawPart& part : parts_) {
            rank.try_emplace(part.group, rank.size() + 1);
        }
        for (auto& [group, place] : rank) {
            place = place == rank.size() ? 0 : place;
        }
        std::stable_sort(parts_.begin(), parts_.end(), [&rank](const RawPart& a, const RawPart& b) {
            return rank.at(a.group) < rank.at(b.group);
        });
        PolygonMesh mesh;
        for (RawPart& part : parts_) {
            PolygonGroup group;
            group.begin = mesh.sizes.size();
            group.names.emplace_back(part.group);
            group.node = part.group;
            mesh.groups.push_back(std::move(group));
            mesh.positions.insert(mesh.positions.end(), part.corners.begin(), part.corners.end());
            mesh.sizes.resize(mesh.sizes.size() + part.corners.size() / 3, 3);
            part.corners = {};
        }
        mesh.corners.resize(mesh.positions.size());
        std::iota(mesh.corners.begin(), mesh.corners.end(), 0U);
        return mesh;
    }

    static constexpr std::string_view kNoTexture = "%default%";

    TextScanner text_;
    std::string_view group_;
    std::vector<RawPart> parts_;
    std::map<std::pair<std::string_view, std::string_view>, std::size_t> index_;
    std::uint64_t triangles_ = 0;
};

}  // namespace

Result<PolygonMesh> readRaw(std::span<const std::byte> bytes) {
    return RawReader({reinterpret_cast<const char*>(bytes.data()), bytes.size()}).read();
}

}  // namespace relief
