// SPDX-License-Identifier: Apache-2.0
// Values with fields() as values of JSON, for sources that build JSON or schemas by hand.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "formats/fields/field.h"

namespace relief {

using Json = nlohmann::ordered_json;

/// Json for headers that do without its own (FieldCustom).
struct FieldJson {
    Json json;
};

/// The double whose shortest decimal is that of the float: 0.1F becomes 0.1.
[[nodiscard]] Json jsonNumber(float value);

/// Indented, with a line feed at the end. Bytes that are not UTF-8 are replaced.
[[nodiscard]] std::string jsonText(const Json& json);
/// The same in one line.
[[nodiscard]] std::string jsonLine(const Json& json);

/// Enumerations are their words, an optional without a value is null, a path its bytes, a vector of three an array. Fields
/// are members of an object, in the order of the visits: those for the word of the selecting field, and a single table
/// without its list if FieldRules::single.
[[nodiscard]] Json jsonOf(FieldRef value);

/// The schema of such a field: type, range, description; closed objects, of which every field is required that is not
/// left_out. \param value  any: of a struct that visits other fields by its kind, one of that kind.
[[nodiscard]] Json schemaOf(FieldRef value);
[[nodiscard]] Json schemaOf(FieldRef value, const FieldInfo& info);

/// "Centre of attraction, m".
[[nodiscard]] std::string fieldDescription(const FieldInfo& info);
/// "type" with the limits of its range, or the words.
[[nodiscard]] Json numberSchema(bool whole, bool is_unsigned, const FieldInfo& info);
/// "type" with its pattern, or the words.
[[nodiscard]] Json textSchema(const FieldInfo& info);
[[nodiscard]] Json arraySchema(Json items, const FieldRange& count);
/// The same, or null.
[[nodiscard]] Json nullable(Json schema);

}  // namespace relief
