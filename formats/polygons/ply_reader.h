// SPDX-License-Identifier: Apache-2.0
// Reads the header and the numbers of PLY files. The caller decides which elements are required.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/enum_words.h"
#include "formats/base/result.h"
#include "formats/base/text_scanner.h"

namespace relief {

enum class PlyEncoding : std::uint8_t { kAscii, kLittle, kBig };
template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<PlyEncoding>{"ascii", "binary_little_endian",
                                                                       "binary_big_endian"};
enum class PlyType : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

/// Limits on the properties of one element and on the elements of a file; real files have fewer.
inline constexpr std::size_t kPlyPropertiesMax = 256;
inline constexpr std::size_t kPlyElementsMax = 64;

struct PlyProperty {
    std::string_view name;
    PlyType type = PlyType::kInt8;       ///< for lists, the type of the items
    std::optional<PlyType> length_type;  ///< set for lists

    [[nodiscard]] bool isList() const { return length_type.has_value(); }
};

struct PlyElement {
    std::string_view name;
    std::uint64_t count = 0;  ///< from the header; the file may contain fewer
    std::vector<PlyProperty> properties;
};

/// A parsed header. Borrows the file's bytes.
struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::kAscii;
    std::vector<PlyElement> elements;
    std::size_t lines = 0;  ///< number of lines in the header
};

/// Parses the header at the start of `data` and removes it.
/// Errors, without the file name: kInvalidInput.
[[nodiscard]] Result<PlyHeader> readPlyHeader(std::string_view& data);

/// Reads the numbers after a header in order, from text or binary.
class PlyNumbers {
  public:
    /// \param data  the bytes after "end_header\n", or a part of them such as a line. Borrowed.
    /// \param lines_before  number of lines in the file before `data`.
    PlyNumbers(std::string_view data, PlyEncoding encoding, std::size_t lines_before = 0)
        : data_(data), text_(data), encoding_(encoding), lines_before_(lines_before) {}

    /// Returns the next number; nullopt at the end of the data, or if a word is not a number.
    [[nodiscard]] std::optional<double> next(PlyType type);
    [[nodiscard]] bool ended() const { return ended_; }
    /// Returns the unread data.
    [[nodiscard]] std::string_view rest() const { return isText() ? text_.rest() : data_; }
    [[nodiscard]] bool isText() const { return encoding_ == PlyEncoding::kAscii; }
    /// Returns whether the rest of the line contains no words. \pre isText()
    [[nodiscard]] bool atLineEnd() { return text_.atLineEnd(); }
    /// Returns "line 12: " for the word that next() read; "" for binary data.
    [[nodiscard]] std::string where() const;
    [[nodiscard]] std::string_view word() const { return word_; }

  private:
    std::optional<double> nextBytes(PlyType type);

    std::string_view data_;
    TextScanner text_;
    std::string_view word_;
    PlyEncoding encoding_;
    std::size_t lines_before_;
    bool ended_ = false;
};

/// Returns the error of a failed next(), without the file name.
[[nodiscard]] tl::unexpected<Error> plyNumberError(const PlyNumbers& numbers);

/// Reads the length of a list. Errors: those of plyNumberError; kInvalidInput for an invalid length.
[[nodiscard]] Result<std::uint64_t> readPlyLength(PlyNumbers& numbers, PlyType type);

/// Skips a property: a number or a list. Errors: those of readPlyLength.
[[nodiscard]] Result<void> skipPlyProperty(const PlyProperty& property, PlyNumbers& numbers);

/// Reads the properties of an element by name; skips lists and all other properties.
class PlyColumns {
  public:
    /// \param element  borrowed. \param names  one for each value of read().
    PlyColumns(const PlyElement& element, std::span<const std::string_view> names);

    /// Returns how many of these properties have the name `names[name]`; more than 1 if the header is malformed.
    [[nodiscard]] std::size_t count(std::size_t name) const;
    /// Reads the element's next item. \param values  entries without a property are unchanged.
    /// Errors: those of readPlyLength.
    [[nodiscard]] Result<void> read(PlyNumbers& numbers, std::span<double> values) const;

  private:
    const PlyElement& element_;
    std::vector<int> places_;  // index into the names for each property, or -1
};

}  // namespace relief
