// SPDX-License-Identifier: Apache-2.0
#include "formats/polygons/ply_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "formats/base/text.h"

namespace relief {
namespace {

// Two names for each type, in the order of PlyType.
constexpr std::array<std::string_view, 16> kTypes = {
    "char", "int8",  "uchar", "uint8",  "short", "int16",   "ushort", "uint16",
    "int",  "int32", "uint",  "uint32", "float", "float32", "double", "float64"};

std::optional<PlyType> typeOf(std::string_view word) {
    const auto found = std::find(kTypes.begin(), kTypes.end(), word);
    return found == kTypes.end() ? std::nullopt
                                 : std::optional(static_cast<PlyType>((found - kTypes.begin()) / 2));
}

std::size_t sizeOf(PlyType type) {
    constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

Result<void> addElement(std::span<const std::string_view> words, PlyHeader& header) {
    const std::optional<std::uint64_t> count = words.size() == 3 ? parseUnsigned(words[2]) : std::nullopt;
    if (!count || header.elements.size() == kPlyElementsMax) {
        return invalidInput("an element of its header is malformed");
    }
    header.elements.push_back({words[1], *count, {}});
    return {};
}

Result<void> addProperty(std::span<const std::string_view> words, PlyHeader& header) {
    if (header.elements.empty() || header.elements.back().properties.size() == kPlyPropertiesMax) {
        return invalidInput("a property in its header precedes all elements, or an element has more than " +
                            std::to_string(kPlyPropertiesMax) + " properties");
    }
    const bool list = words.size() == 5 && words[1] == "list";
    if (!list && words.size() != 3) {
        return invalidInput("a property of its header is malformed");
    }
    const std::optional<PlyType> type = typeOf(words[words.size() - 2]);
    const std::optional<PlyType> length_type = list ? typeOf(words[2]) : std::nullopt;
    if (!type || (list && !length_type)) {
        return invalidInput("a property of its header has an unknown type");
    }
    header.elements.back().properties.push_back({words.back(), *type, length_type});
    return {};
}

}  // namespace

Result<PlyHeader> readPlyHeader(std::string_view& data) {
    PlyHeader header;
    std::optional<PlyEncoding> encoding;
    // If header lines end in carriage returns, a line feed after the header belongs to the numbers.
    bool returns = false;
    for (;;) {
        const std::string_view before = data;
        std::string_view line = popLine(data);
        const std::string_view taken = before.substr(0, before.size() - data.size());
        std::vector<std::string_view> words;
        for (std::string_view word = popWord(line); !word.empty() && words.size() < 6; word = popWord(line)) {
            words.push_back(word);
        }
        const std::string_view kind = words.empty() ? std::string_view() : words[0];
        if (before.empty()) {
            return invalidInput("its header does not end");
        }
        if (++header.lines == 1) {
            returns = taken.ends_with('\r');
            if (kind != "ply") {
                return invalidInput("it is not a PLY file");
            }
        }
        if (kind == "format" && words.size() > 1) {
            encoding = fromWord<PlyEncoding>(words[1]);
        } else if (kind == "element") {
            RELIEF_TRY(addElement(words, header));
        } else if (kind == "property") {
            RELIEF_TRY(addProperty(words, header));
        } else if (kind == "end_header") {
            data = returns && taken.ends_with("\r\n") ? before.substr(taken.size() - 1) : data;
            break;
        }
    }
    if (!encoding) {
        return invalidInput(
            "its header does not name a supported format: ascii, binary_little_endian or binary_big_endian");
    }
    header.encoding = *encoding;
    return header;
}

std::optional<double> PlyNumbers::next(PlyType type) {
    if (encoding_ != PlyEncoding::kAscii) {
        return nextBytes(type);
    }
    word_ = text_.anyWord();
    ended_ = word_.empty();
    return parseDouble(word_);
}

std::string PlyNumbers::where() const {
    return isText() ? "line " + std::to_string(lines_before_ + text_.line()) + ": " : "";
}

std::optional<double> PlyNumbers::nextBytes(PlyType type) {
    const std::size_t size = sizeOf(type);
    ended_ = data_.size() < size;
    if (ended_) {
        return std::nullopt;
    }
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
        const std::size_t at = encoding_ == PlyEncoding::kLittle ? size - 1 - i : i;
        bits = bits << 8 | static_cast<unsigned char>(data_[at]);
    }
    data_.remove_prefix(size);
    switch (type) {
        case PlyType::kInt8:
            return static_cast<std::int8_t>(bits);
        case PlyType::kInt16:
            return static_cast<std::int16_t>(bits);
        case PlyType::kInt32:
            return static_cast<std::int32_t>(bits);
        case PlyType::kFloat32:
            return __builtin_bit_cast(float, static_cast<std::uint32_t>(bits));
        case PlyType::kFloat64:
            return __builtin_bit_cast(double, bits);
        default:
            return static_cast<double>(bits);
    }
}

tl::unexpected<Error> plyNumberError(const PlyNumbers& numbers) {
    constexpr std::size_t kShownMax = 40;  // bytes
    return invalidInput(numbers.where() +
                        (numbers.ended() ? "it ends before the counts of its header are reached"
                                         : "'" + cleanUtf8(numbers.word(), kShownMax) + "' is not a number"));
}

Result<std::uint64_t> readPlyLength(PlyNumbers& numbers, PlyType type) {
    const std::optional<double> length = numbers.next(type);
    if (!length) {
        return plyNumberError(numbers);
    }
    if (!(*length >= 0.0 && *length <= 4294967295.0 && *length == std::floor(*length))) {
        return invalidInput(numbers.where() + "a list has an invalid length");
    }
    return static_cast<std::uint64_t>(*length);
}

Result<void> skipPlyProperty(const PlyProperty& property, PlyNumbers& numbers) {
    std::uint64_t length = 1;
    if (property.isList()) {
        length = RELIEF_TRY(readPlyLength(numbers, *property.length_type));
    }
    for (std::uint64_t k = 0; k < length; ++k) {
        if (!numbers.next(property.type)) {
            return plyNumberError(numbers);
        }
    }
    return {};
}

PlyColumns::PlyColumns(const PlyElement& element, std::span<const std::string_view> names)
    : element_(element) {
    for (const PlyProperty& property : element.properties) {
        const auto name = std::find(names.begin(), names.end(), property.name);
        places_.push_back(property.isList() || name == names.end() ? -1
                                                                   : static_cast<int>(name - names.begin()));
    }
}

std::size_t PlyColumns::count(std::size_t name) const {
    return static_cast<std::size_t>(std::count(places_.begin(), places_.end(), static_cast<int>(name)));
}

Result<void> PlyColumns::read(PlyNumbers& numbers, std::span<double> values) const {
    for (std::size_t i = 0; i < places_.size(); ++i) {
        if (places_[i] < 0) {
            RELIEF_TRY(skipPlyProperty(element_.properties[i], numbers));
            continue;
        }
        const std::optional<double> value = numbers.next(element_.properties[i].type);
        if (!value) {
            return plyNumberError(numbers);
        }
        values[static_cast<std::size_t>(places_[i])] = *value;
    }
    return {};
}

}  // namespace relief
