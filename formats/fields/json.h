// SPDX-License-Identifier: Apache-2.0
// Converts structs with fields() to JSON text, such as the reports of the tools, and derives JSON Schemas.
// formats/fields/json_value.h declares functions for JSON values.
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

/// Returns the file NAME.schema.json, which the build writes: the schema of jsonTextOf(value).
[[nodiscard]] GeneratedText schemaFile(const std::string& name, std::string_view title,
                                       std::string_view description, FieldRef value);

}  // namespace relief
