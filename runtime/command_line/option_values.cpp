#include "runtime/command_line/option_values.h"

#include <algorithm>

#include "formats/base/byte_count.h"
#include "formats/base/text.h"

namespace relief {
namespace {

std::string wholeNumberText(std::uint64_t least, std::uint64_t most) {
    const bool any = least == 0 && most == std::numeric_limits<std::uint64_t>::max();
    return "a whole number" + (any ? "" : " from " + std::to_string(least) + " to " + std::to_string(most));
}

/// \param parse  the word as what CLI11 converts, or nullopt.
template <class Parse>
CLI::Validator validator(const std::string& must, const Parse& parse) {
    return {[must, parse](std::string& word) -> std::string {
                std::optional<std::string> plain = parse(word);
                if (!plain) {
                    return butMustBe(word, must);
                }
                word = std::move(*plain);
                return {};
            },
            ""};
}

CLI::Validator counted(std::uint64_t least, std::uint64_t most, const std::string& must,
                       std::optional<std::uint64_t> (*parse)(std::string_view)) {
    return validator(must, [=](const std::string& word) -> std::optional<std::string> {
        const std::optional<std::uint64_t> count = parse(word);
        return count && *count >= least && *count <= most ? std::optional(std::to_string(*count))
                                                          : std::nullopt;
    });
}

std::optional<std::string> plainFloat(std::string_view word, float least, float most) {
    const std::optional<float> value = parseFloat(trimmed(word));
    return value && *value >= least && *value <= most ? std::optional(shortest(*value)) : std::nullopt;
}

}  // namespace

CLI::Validator wholeNumber(std::uint64_t least, std::uint64_t most, const std::string& must) {
    return counted(least, most, must.empty() ? wholeNumberText(least, most) : must, parseUnsigned);
}

CLI::Validator number(float least, float most, const std::string& must) {
    return validator(must, [=](const std::string& word) { return plainFloat(word, least, most); });
}

CLI::Validator percent() {
    return validator("a share in percent, such as 1.5", [](std::string_view word) {
        word = trimmed(word);
        return plainFloat(word.substr(0, word.size() - (word.ends_with('%') ? 1 : 0)), 0.0F,
                          std::numeric_limits<float>::max());
    });
}

CLI::Validator byteCount(std::uint64_t least, std::uint64_t most, const std::string& must) {
    return counted(least, most, must, parseByteCount);
}

CLI::Validator oneOf(std::vector<std::string_view> words) {
    return {[words = std::move(words)](std::string& word) {
                return std::ranges::find(words, word) == words.end() ? butMustBeOneOf(word, words) : "";
            },
            ""};
}

}  // namespace relief
