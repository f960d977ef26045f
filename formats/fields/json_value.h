// SPDX-License-Identifier: Apache-2.0
// JSON values of types with fields(), for sources that build JSON or schemas by hand.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "formats/fields/field.h"

namespace relief {

using Json = nlohmann::ordered_json;

/// Wraps Json so that headers can forward-declare it (FieldCustom).
struct FieldJson {
    Json json;
};

/// Returns the double whose shortest decimal equals the float's: 0.1F becomes 0.1.
[[nodiscard]] Json jsonNumber(float value);

/// Returns indented JSON that ends with a line feed. Invalid UTF-8 is replaced.
[[nodiscard]] std::string jsonText(const Json& json);
/// Returns the same JSON on one line.
[[nodiscard]] std::string jsonLine(const Json& json);

/// Converts a value to JSON. Enumerations become words, empty optionals null, paths their bytes, and vec3 an array.
/// Fields become members of an object in visiting order. Fields of other kinds are omitted (see FieldRules::only); with
/// FieldRules::single, a list of one table becomes that table.
[[nodiscard]] Json jsonOf(FieldRef value);

/// Returns the schema of a field: type, range and description. Objects are closed and require every field that is not
/// left_out. \param value  any value; for structs whose fields depend on their kind, a value of that kind.
[[nodiscard]] Json schemaOf(FieldRef value);
[[nodiscard]] Json schemaOf(FieldRef value, const FieldInfo& info);

/// Returns the description with its unit: "Centre of attraction, m".
[[nodiscard]] std::string fieldDescription(const FieldInfo& info);
/// Returns "type" with the limits of its range, or the words.
[[nodiscard]] Json numberSchema(bool whole, bool is_unsigned, const FieldInfo& info);
/// Returns "type" with its pattern, or the words.
[[nodiscard]] Json textSchema(const FieldInfo& info);
[[nodiscard]] Json arraySchema(Json items, const FieldRange& count);
/// Returns a schema that also accepts null.
[[nodiscard]] Json nullable(Json schema);

}  // namespace relief
