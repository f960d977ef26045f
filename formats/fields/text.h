// SPDX-License-Identifier: Apache-2.0
// Values of fields as words: of a command line, of Python's arguments, of a container's provenance.
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

/// "is 'x' but must be MUST"
[[nodiscard]] std::string butMustBe(std::string_view word, std::string_view must);
/// "is 'x' but must be one of a, b, c; did you mean 'a'?", or "but must be a or b".
[[nodiscard]] std::string butMustBeOneOf(std::string_view word, std::span<const std::string_view> words);

/// "1MB" for 1000000, and the plain number where no unit of 1000 divides it.
[[nodiscard]] std::string bytesWord(std::uint64_t bytes);

/// The shortest decimal that reads back as the same number.
[[nodiscard]] std::string numberWord(float value);
[[nodiscard]] std::string numberWord(double value);

/// Reads a word into a value; a list gets one more. \return empty, or the clause that follows the field's name in a message:
/// "is 'x' but must be …".
[[nodiscard]] std::string readWord(std::string_view word, const FieldInfo& info, FieldRef value);

/// The words that readWord() makes the value of: none of an optional without a value, one for each entry of a list.
[[nodiscard]] std::vector<std::string> wordsOf(FieldRef value);

/// How many words a field takes, and of which sort: what its readers need beside the FieldInfo.
enum class FieldKind : std::uint8_t { kFlag, kValue, kList };

/// A field of a struct, distinct from its type.
struct FieldWords {
    std::string name;
    FieldInfo info;
    FieldKind kind = FieldKind::kValue;
    std::vector<std::string> words;           ///< of its value
    std::vector<std::string_view> choices{};  ///< of an enumeration
    bool optional = false;                    ///< the default is no value
    bool number = false;
};

[[nodiscard]] FieldWords describeField(std::string_view name, FieldRef value, const FieldInfo& info);

/// All fields of a struct, in their order.
[[nodiscard]] std::vector<FieldWords> fieldsOf(FieldRef value);
/// The fields that differ from those of a new struct.
[[nodiscard]] std::vector<FieldWords> changedFields(FieldRef value);

/// Reads a word into the field of that name.
/// Errors: kUsage: no field has the name, or its value is wrong; names the option.
[[nodiscard]] Result<void> setField(FieldRef target, std::string_view name, std::string_view word);

/// "1MB", "60", "512; with --holes keep and --animated, 256"; empty: there is no default.
[[nodiscard]] std::string defaultText(const FieldWords& field);
/// Stands for the value in --help: "BYTES", "fast|normal|best".
[[nodiscard]] std::string valueText(const FieldWords& field);
/// A table of options for a README: name, sentence, default.
[[nodiscard]] std::string optionTable(const std::vector<FieldWords>& fields);

}  // namespace relief
