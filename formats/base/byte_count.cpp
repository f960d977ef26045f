#include "formats/base/byte_count.h"

#include <array>
#include <string>
#include <utility>

#include "formats/base/float_chars.h"
#include "formats/base/text.h"

namespace relief {

std::optional<std::uint64_t> parseByteCount(std::string_view text) {
    constexpr std::array<std::pair<std::string_view, double>, 8> kUnits = {{{"", 1.0},
                                                                            {"b", 1.0},
                                                                            {"kb", 1e3},
                                                                            {"mb", 1e6},
                                                                            {"gb", 1e9},
                                                                            {"kib", 0x1p10},
                                                                            {"mib", 0x1p20},
                                                                            {"gib", 0x1p30}}};
    text = trimmed(text);
    double number = 0.0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = fromChars(text.data(), end, number, true);
    if (error != std::errc()) {
        return std::nullopt;
    }
    const std::string unit = lowerCase(trimmed({rest, static_cast<std::size_t>(end - rest)}));
    for (const auto& [name, factor] : kUnits) {
        if (unit == name) {
            const double bytes = number * factor;
            // Written so that NaN fails too.
            return bytes >= 1.0 && bytes <= 0x1p53 ? std::optional(static_cast<std::uint64_t>(bytes))
                                                   : std::nullopt;
        }
    }
    return std::nullopt;
}

}  // namespace relief
