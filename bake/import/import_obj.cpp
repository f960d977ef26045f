#include "bake/import/import_obj.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>
#include <vector>

#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::uint8_t kByFace = 1;
constexpr std::uint8_t kByOther = 2;
constexpr std::array<std::string_view, 6> kFreeForms = {"curv", "surf", "bzp", "bsp", "cdc", "cdp"};

/// Cuts the next statement off: a line, and those that its backslashes join to it. The backslashes stay.
std::string_view takeStatement(std::string_view& text) {
    const std::string_view begin = text;
    std::string_view line = trimmed(takeLine(text));
    while (line.ends_with('\\') && !text.empty()) {
        line = trimmed(takeLine(text));
    }
    return begin.substr(0, begin.size() - text.size());
}

class ObjUses {
  public:
    explicit ObjUses(std::uint64_t vertices) : uses_(vertices) {}

    /// \param words  of a face, a line or a point; "7/1/2", or "-1" for the last of the vertices so far.
    void use(std::string_view words, std::uint64_t so_far, std::uint8_t by) {
        for (std::string_view word = takeWord(words); !word.empty(); word = takeWord(words)) {
            std::int64_t number = 0;
            if (std::from_chars(word.data(), word.data() + word.size(), number).ec != std::errc()) {
                continue;
            }
            const auto index = static_cast<std::uint64_t>(
                number > 0 ? number - 1 : static_cast<std::int64_t>(so_far) + number);
            if (number != 0 && index < uses_.size()) {
                uses_[index] |= by;
            }
        }
    }

    void addTo(MeshParts& parts) const {
        for (const std::uint8_t use : uses_) {
            parts.unused += (use & kByFace) == 0 ? 1 : 0;
            parts.loose += use == 0 ? 1 : 0;
        }
    }

  private:
    std::vector<std::uint8_t> uses_;
};

}  // namespace

MeshParts objPartsOf(std::span<const std::byte> bytes) {
    const std::string_view whole(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    MeshParts parts;
    for (std::string_view text = whole; !text.empty();) {
        std::string_view statement = takeStatement(text);
        const std::string_view word = takeWord(statement);
        parts.vertices += word == "v" ? 1 : 0;
        parts.polygons += word == "f" || word == "fo" ? 1 : 0;
        parts.free_forms += std::find(kFreeForms.begin(), kFreeForms.end(), word) != kFreeForms.end() ? 1 : 0;
    }
    ObjUses uses(parts.vertices);
    std::uint64_t so_far = 0;
    for (std::string_view text = whole; !text.empty();) {
        std::string_view statement = takeStatement(text);
        const std::string_view word = takeWord(statement);
        so_far += word == "v" ? 1 : 0;
        if (word == "f" || word == "fo") {
            uses.use(statement, so_far, kByFace);
        } else if (word == "l" || word == "p") {
            uses.use(statement, so_far, kByOther);
        }
    }
    uses.addTo(parts);
    return parts;
}

}  // namespace relief
