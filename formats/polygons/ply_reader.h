// SPDX-License-Identifier: Apache-2.0
// PLY files, read: the header and the numbers behind it. The caller decides what a file must hold.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"
#include "formats/base/text_scanner.h"

namespace relief {

enum class PlyEncoding : std::uint8_t { kAscii, kLittle, kBig };
enum class PlyType : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

/// Properties of one element that a reader takes, and elements of one file: more than any program writes.
inline constexpr std::size_t kPlyPropertiesMax = 256;
inline constexpr std::size_t kPlyElementsMax = 64;

struct PlyProperty {
    std::string_view name;
    PlyType type = PlyType::kInt8;       ///< of a list: of its items
    std::optional<PlyType> length_type;  ///< of a list

    [[nodiscard]] bool isList() const { return length_type.has_value(); }
};

struct PlyElement {
    std::string_view name;
    std::uint64_t count = 0;  ///< by the header; the file may hold fewer
    std::vector<PlyProperty> properties;
};

/// It borrows from the file's bytes.
struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::kAscii;
    std::vector<PlyElement> elements;
    std::size_t lines = 0;  ///< of the header itself
};

/// Cuts the whole header off `data`, a file from its start.
/// Errors, naming no file: kInvalidInput.
[[nodiscard]] Result<PlyHeader> takePlyHeader(std::string_view& data);

/// The numbers behind a header, one after the other, as words or as bytes.
class PlyNumbers {
  public:
    /// \param data  from the byte after "end_header\n"; or a part of it, such as a line. Borrowed.
    /// \param lines_before  of the file.
    PlyNumbers(std::string_view data, PlyEncoding encoding, std::size_t lines_before = 0)
        : data_(data), text_(data), encoding_(encoding), lines_before_(lines_before) {}

    /// \return nullopt if the data have ended, or where a word is no number.
    [[nodiscard]] std::optional<double> next(PlyType type);
    /// After next() has failed: the data have ended.
    [[nodiscard]] bool ended() const { return ended_; }
    /// The data behind the last number.
    [[nodiscard]] std::string_view rest() const { return isText() ? text_.rest() : data_; }
    [[nodiscard]] bool isText() const { return encoding_ == PlyEncoding::kAscii; }
    /// \return true if no word follows the last one on its line. \pre isText()
    [[nodiscard]] bool atLineEnd() { return text_.atLineEnd(); }
    /// "line 12: ", of the last word; "" where there are no lines.
    [[nodiscard]] std::string where() const;
    /// The last word, of a text.
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

/// The error of a next() that failed; it names no file.
[[nodiscard]] tl::unexpected<Error> plyNumberError(const PlyNumbers& numbers);

/// The length of a list. Errors: as plyNumberError; kInvalidInput for what is no length.
[[nodiscard]] Result<std::uint64_t> takePlyLength(PlyNumbers& numbers, PlyType type);

/// Reads a property that is not needed: a number, or a list of them. Errors: as takePlyLength.
[[nodiscard]] Result<void> passPlyProperty(const PlyProperty& property, PlyNumbers& numbers);

/// The properties of one element that a reader takes, single numbers by their names.
class PlyColumns {
  public:
    /// \param element  borrowed. \param names  as many as the values of read().
    PlyColumns(const PlyElement& element, std::span<const std::string_view> names);

    /// How many of the element's properties have the name'th name: 1, unless its header is odd.
    [[nodiscard]] std::size_t count(std::size_t name) const;
    /// Takes the element's next item. \param values  those that the element has not stay as they are.
    /// Errors: as takePlyLength.
    [[nodiscard]] Result<void> read(PlyNumbers& numbers, std::span<double> values) const;

  private:
    const PlyElement& element_;
    std::vector<int> places_;  // of each property among the names, -1: none
};

}  // namespace relief
