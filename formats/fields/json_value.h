// SPDX-License-Identifier: Apache-2.0
// JSON values of types with fields(), for source files that build JSON or schemas by hand.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "formats/fields/field.h"

namespace relief {

using Json = nlohmann::ordered_json;

/// Wraps Json in a struct that field_type.h can forward-declare.
struct FieldJson {
    Json json;
};

/// Returns the double whose shortest decimal equals the float's: 0.1F becomes 0.1.
[[nodiscard]] Json jsonNumber(float value);

/// Returns indented JSON that ends with a line feed. Invalid UTF-8 is replaced.
[[nodiscard]] std::string jsonText(const Json& json);
/// Returns the same JSON on one line.
[[nodiscard]] std::string jsonLine(const Json& json);

/// Converts a value to JSON. Enumerations become words, empty optionals null, paths strings, and vec3 an array.
/// Fields become members of an object in visiting order, except those that FieldRules::only or FieldInfo::left_out
/// exclude. With FieldRules::single, a list of one table becomes that table.
[[nodiscard]] Json jsonOf(FieldRef value);

/// Returns the schema of a field. Objects accept only fields, and require all those without left_out or `only`.
/// \param value  any value of the type. The schema covers its fields, or those of all T::kinds() if declared.
[[nodiscard]] Json schemaOf(FieldRef value);
[[nodiscard]] Json schemaOf(FieldRef value, const FieldInfo& info);

/// Returns the description with its unit: "Centre of attraction, m".
[[nodiscard]] std::string fieldDescription(const FieldInfo& info);
/// Returns {"type": …} with the limits of info.range; {"enum": …} if info.words is not empty.
[[nodiscard]] Json numberSchema(bool whole, bool is_unsigned, const FieldInfo& info);
/// Returns {"type": "string"} with info.pattern; {"enum": …} if info.words is not empty.
[[nodiscard]] Json textSchema(const FieldInfo& info);
[[nodiscard]] Json arraySchema(Json items, const FieldRange& count);
/// Returns a schema that also accepts null.
[[nodiscard]] Json nullable(Json schema);

}  // namespace relief
