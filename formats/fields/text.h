// SPDX-License-Identifier: Apache-2.0
// Field values as words: for command lines, Python arguments and the provenance of containers.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/field.h"
#include "formats/base/result.h"
#include "formats/base/text.h"

namespace relief {

/// Returns "is 'x' but must be MUST".
[[nodiscard]] std::string expectedMessage(std::string_view word, std::string_view must);
/// Returns "is 'x' but must be one of a, b, c; did you mean 'a'?", or "is 'x' but must be a or b".
[[nodiscard]] std::string expectedOneOfMessage(std::string_view word,
                                               std::span<const std::string_view> words);

/// Returns "1.5MB" for 1500000; the plain number below 10000, or if the word would be inexact.
[[nodiscard]] std::string bytesWord(std::uint64_t bytes);

/// Returns the shortest decimal that reads back as the same number.
[[nodiscard]] std::string numberWord(float value);
[[nodiscard]] std::string numberWord(double value);

/// Parses a word into a value; if the value is a list, appends an element. \return an empty string on success,
/// otherwise the clause that follows the field's name in a message: "is 'x' but must be …".
[[nodiscard]] std::string readWord(std::string_view word, const FieldInfo& info, FieldRef value);

/// Returns the words from which readWord() restores the value: none for an empty optional, one for each element of a
/// list.
[[nodiscard]] std::vector<std::string> wordsOf(FieldRef value);

/// The form of a field: a bool, one word, or one word for each element.
enum class FieldKind : std::uint8_t { kFlag, kValue, kList };

/// A field of a struct, described independently of its type.
struct FieldWords {
    std::string name;
    FieldInfo info;
    FieldKind kind = FieldKind::kValue;
    std::vector<std::string> words;           ///< current value
    std::vector<std::string_view> choices{};  ///< of an enumeration
    bool optional = false;                    ///< there is no default value
    bool number = false;
};

[[nodiscard]] FieldWords describeField(std::string_view name, FieldRef value, const FieldInfo& info);

/// Returns all fields of a struct, in order.
[[nodiscard]] std::vector<FieldWords> fieldsOf(FieldRef value);
/// Returns the fields that differ from a newly constructed struct.
[[nodiscard]] std::vector<FieldWords> changedFields(FieldRef value);

/// Parses a word into the field with this name.
/// Errors: kUsage if no field has the name or the value is invalid; messages name the option.
[[nodiscard]] Result<void> setField(FieldRef target, std::string_view name, std::string_view word);

/// Returns the default: "1MB", "60", "512; with --holes keep and --animated, 256"; empty if there is none.
[[nodiscard]] std::string defaultText(const FieldWords& field);
/// Returns the placeholder of the value in --help: "BYTES", "fast|normal|best".
[[nodiscard]] std::string valueText(const FieldWords& field);

}  // namespace relief
