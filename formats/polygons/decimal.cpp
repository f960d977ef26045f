// SPDX-License-Identifier: Apache-2.0
#include "formats/polygons/decimal.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

#include "formats/base/float_chars.h"
#include "formats/base/text.h"

namespace relief {
namespace {

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

std::string_view takeDigits(std::string_view& text) {
    std::size_t length = 0;
    while (length < text.size() && isDigit(text[length])) {
        ++length;
    }
    const std::string_view digits = text.substr(0, length);
    text.remove_prefix(length);
    return digits;
}

/// The parts of a decimal number without its sign.
struct Decimal {
    std::string_view whole;
    std::string_view fraction;
    std::string_view exponent;  // digits
    bool shrinks = false;       // negative exponent
};

std::optional<Decimal> partsOfDecimal(std::string_view text) {
    Decimal parts;
    parts.whole = takeDigits(text);
    if (text.starts_with('.')) {
        text.remove_prefix(1);
        parts.fraction = takeDigits(text);
    }
    if (parts.whole.empty() && parts.fraction.empty()) {
        return std::nullopt;
    }
    if (!text.empty() && (text[0] == 'e' || text[0] == 'E')) {
        text.remove_prefix(1);
        parts.shrinks = text.starts_with('-');
        text.remove_prefix(parts.shrinks || text.starts_with('+') ? 1 : 0);
        parts.exponent = takeDigits(text);
        if (parts.exponent.empty()) {
            return std::nullopt;
        }
    }
    return text.empty() ? std::optional(parts) : std::nullopt;
}

/// \param digits  at most 19.
std::uint64_t integer(std::string_view digits) {
    std::uint64_t value = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return value;
}

/// Returns 10 to the power of an exponent with at most four digits.
float powerOfTen(const Decimal& parts) {
    std::array<char, 8> text{'1', 'e', parts.shrinks ? '-' : '+'};
    parts.exponent.copy(text.data() + 3, 4);
    float power = parts.shrinks ? 0.0F : std::numeric_limits<float>::infinity();
    static_cast<void>(fromChars(text.data(), text.data() + 3 + parts.exponent.size(), power));
    return power;
}

float sumOfParts(const Decimal& parts) {
    constexpr std::array<double, 16> kTenths = {0.0,  1e-1, 1e-2,  1e-3,  1e-4,  1e-5,  1e-6,  1e-7,
                                                1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15};
    const std::string_view digits = parts.fraction.substr(0, kTenths.size() - 1);
    auto value = static_cast<float>(integer(parts.whole));
    value += static_cast<float>(static_cast<double>(integer(digits)) * kTenths[digits.size()]);
    return parts.exponent.empty() ? value : value * powerOfTen(parts);
}

float nearestTo(std::string_view number, const Decimal& parts) {
    double value = 0.0;
    if (fromChars(number.data(), number.data() + number.size(), value).ec == std::errc()) {
        return static_cast<float>(value);
    }
    return parts.shrinks ? 0.0F : std::numeric_limits<float>::infinity();
}

}  // namespace

std::optional<float> readDecimal(std::string_view word) {
    constexpr std::size_t kWholeMax = 18;
    constexpr std::size_t kExponentMax = 4;
    constexpr float kRounding = 1.0F / (1 << 21);
    const bool negative = word.starts_with('-');
    std::string_view number = word.substr(negative || word.starts_with('+') ? 1 : 0);
    float value = 0.0F;
    if (const std::optional<Decimal> parts = partsOfDecimal(number)) {
        const bool plain = parts->exponent.empty() && parts->whole.size() <= kWholeMax;
        const bool summed = parts->whole.size() <= kWholeMax && parts->exponent.size() <= kExponentMax;
        value = summed ? sumOfParts(*parts) : 0.0F;
        // Powers of ten beyond the range of floats break the product, and large numbers overflow the integer.
        if (!plain) {
            const float nearest = nearestTo(number, *parts);
            value = summed && std::abs(value - nearest) <= kRounding * std::abs(nearest) ? value : nearest;
        }
    } else if (const std::string lower = lowerCase(number); lower == "nan") {
        value = std::numeric_limits<float>::quiet_NaN();
    } else if (lower == "inf" || lower == "infinity") {
        value = std::numeric_limits<float>::infinity();
    } else {
        return std::nullopt;
    }
    return negative ? -value : value;
}

std::string quotedWord(std::string_view word) {
    constexpr std::size_t kShownMax = 40;  // bytes
    return "'" + cleanUtf8(word, kShownMax) + "'";
}

std::string noNumber(std::string_view word) {
    if (word.empty()) {
        return "a number is missing; repair the file or export it again";
    }
    const std::string shown = quotedWord(word);
    const std::string lower = lowerCase(word.substr(word[0] == '-' || word[0] == '+' ? 1 : 0));
    if (lower.starts_with("0x")) {
        return shown + " is hexadecimal; write it as a decimal number";
    }
    if (word.find(',') != std::string_view::npos) {
        return shown + " contains a comma; use decimal points, and blanks between numbers";
    }
    return shown + " is not a number; repair the file or export it again";
}

}  // namespace relief
