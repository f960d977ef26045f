// SPDX-License-Identifier: Apache-2.0
// Documents structs that formats/config/toml_reader.h reads. Derives Markdown tables for users, JSON Schemas for
// editors and dictionaries for fuzzers from one tree of FieldReference.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/fields/json_value.h"

namespace relief {

/// The type of a value in the file.
struct FieldSchema {
    Json schema;
    std::vector<std::string_view> words;  ///< of an enumeration
};

struct FieldReference {
    std::string_view name;
    FieldInfo info;
    FieldSchema type;                    ///< empty for a table
    std::string fallback;                ///< the constant default as JSON, or ""
    std::vector<FieldReference> fields;  ///< of a table
    bool several = false;                ///< true for [[name]]
};

/// Schemas of the types that FieldCustom::read reads.
using CustomSchemas = std::map<const FieldCustom*, FieldSchema>;

[[nodiscard]] std::vector<FieldReference> referenceOf(FieldRef value, const CustomSchemas& custom = {});
template <class T>
[[nodiscard]] std::vector<FieldReference> referenceOf() {
    return referenceOf(T{});
}

/// Returns a Markdown table | key | meaning | default | range | with its header. Omits nested tables.
[[nodiscard]] std::string markdownTable(const std::vector<FieldReference>& fields);
/// Returns one Markdown table for the tables `names` in `fields`, and for the tables nested in them. The first key of
/// each table is prefixed with the table's name: "`[camera]` `position`".
[[nodiscard]] std::string markdownTables(const std::vector<FieldReference>& fields,
                                         std::span<const std::string_view> names);
/// Returns a JSON Schema of the file. \param place  JSON pointer to this schema: "#" for the whole file.
[[nodiscard]] Json fileSchema(const std::vector<FieldReference>& fields, const std::string& place);
/// Returns keys, words and table names for libFuzzer.
[[nodiscard]] std::string fuzzDictionary(const std::vector<FieldReference>& fields);

}  // namespace relief
