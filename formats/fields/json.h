// SPDX-License-Identifier: Apache-2.0
// Converts structs with fields() to JSON text, and derives the JSON Schema. The tools write their reports with it.
// formats/fields/json_value.h declares the JSON values.
#pragma once

#include <string>
#include <string_view>

#include "formats/fields/field.h"
#include "formats/fields/generated.h"

namespace relief {

/// Returns indented JSON that ends with a line feed. Invalid UTF-8 is replaced.
[[nodiscard]] std::string jsonTextOf(FieldRef value);
/// Returns the same JSON on one line.
[[nodiscard]] std::string jsonLineOf(FieldRef value);

/// Returns the file NAME.schema.json, which the build writes: the schema of the output of the functions above.
[[nodiscard]] GeneratedText schemaFile(const std::string& name, std::string_view title,
                                       std::string_view description, FieldRef value);

}  // namespace relief
