#include "bake/import/import_readers.h"

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "formats/base/text.h"
#include "formats/base/text_scanner.h"

namespace relief {
namespace {

/// Follows the counts of an AC file.
class AcCounts {
  public:
    /// \return whether everything is there that is announced.
    bool hold(TextScanner text) {
        while (text.nextLine()) {  // the first is its version
            const std::string_view word = text.word();
            const std::uint64_t count = parseUnsigned(text.word()).value_or(0);
            if (word == "OBJECT") {
                ++objects_;
                --kids_;
            } else if (word == "kids") {
                --objects_;  // each ends with them
                kids_ += static_cast<std::int64_t>(std::min(count, kCountMax));
            } else if (word == "data") {
                text.nextLine();
                const std::string_view rest = text.rest();
                text = TextScanner(rest.substr(std::min<std::uint64_t>(rest.size(), count)));
            } else if (word == "numsurf") {
                surfaces_ += static_cast<std::int64_t>(std::min(count, kCountMax));
            } else if (word == "SURF") {
                --surfaces_;
                ++open_surfaces_;
            } else if (word == "refs" || word == "numvert") {
                open_surfaces_ -= word == "refs" ? 1 : 0;
                if (!takeLines(text, count, word == "numvert" ? 3 : 1)) {
                    return false;
                }
            }
        }
        return objects_ == 0 && kids_ <= 0 && surfaces_ <= 0 && open_surfaces_ <= 0;
    }

  private:
    static constexpr std::uint64_t kCountMax = 1'000'000'000;

    static bool takeLines(TextScanner& text, std::uint64_t count, int words) {
        for (std::uint64_t i = 0; i < count; ++i) {
            text.nextLine();
            for (int k = 0; k < words; ++k) {
                if (!parseDouble(text.word())) {
                    return false;
                }
            }
        }
        return true;
    }

    std::int64_t objects_ = 0;  // without their kids
    std::int64_t kids_ = 1;     // announced; the world is one
    std::int64_t surfaces_ = 0;
    std::int64_t open_surfaces_ = 0;  // without their corners
};

}  // namespace

bool isAcCutOff(std::span<const std::byte> bytes) {
    // Text in UTF-16 is assimp's own business.
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return text.starts_with("AC3D") && !AcCounts().hold(TextScanner(text));
}

}  // namespace relief
