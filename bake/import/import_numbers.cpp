#include "bake/import/import_numbers.h"

#include <algorithm>
#include <cmath>

#include "formats/base/text.h"

namespace relief {

std::optional<double> finiteNumber(std::string_view text) {
    const std::string_view word = takeWord(text);
    const std::optional<double> value = takeWord(text).empty() ? parseDouble(word) : std::nullopt;
    return value && std::isfinite(*value) ? value : std::nullopt;
}

std::string noFiniteNumber(std::string_view text) {
    constexpr std::size_t kQuotedMax = 40;
    std::string point(text);
    std::replace(point.begin(), point.end(), ',', '.');
    const bool comma = finiteNumber(point).has_value();
    return "'" + oneCleanLine(text.substr(0, kQuotedMax)) + "' is no " +
           (comma ? "number; write a point for the comma" : "finite number");
}

}  // namespace relief
