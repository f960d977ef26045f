// SPDX-License-Identifier: Apache-2.0
// A struct with fields() as the text of JSON, and the JSON Schema of that. The tools write their reports with it. Values of
// JSON are in formats/fields/json_value.h.
#pragma once

#include <string>
#include <string_view>

#include "formats/fields/field.h"
#include "formats/fields/generated.h"

namespace relief {

/// Indented, with a line feed at the end. Bytes that are not UTF-8 are replaced.
[[nodiscard]] std::string jsonTextOf(FieldRef value);
/// The same in one line.
[[nodiscard]] std::string jsonLineOf(FieldRef value);

/// The file NAME.schema.json, which the build writes: the schema of the text that the functions above write.
[[nodiscard]] GeneratedText schemaFile(const std::string& name, std::string_view title,
                                       std::string_view description, FieldRef value);

}  // namespace relief
