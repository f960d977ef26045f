// SPDX-License-Identifier: Apache-2.0
// A struct that is read from files (formats/config/toml_reader.h), described for people, editors and fuzzers: tables of
// Markdown, JSON Schema and dictionaries. All are made of one tree.
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
    FieldSchema type;                    ///< of a table: nothing
    std::string fallback;                ///< the default, as the file would have it
    std::vector<FieldReference> fields;  ///< of a table
    bool several = false;                ///< [[name]]
};

/// Types that FieldCustom::read reads.
using CustomSchemas = std::map<const FieldCustom*, FieldSchema>;

/// The fields of a struct.
[[nodiscard]] std::vector<FieldReference> referenceOf(FieldRef value, const CustomSchemas& custom = {});
template <class T>
[[nodiscard]] std::vector<FieldReference> referenceOf() {
    return referenceOf(T{});
}

/// Rows of a table: | key | meaning | default | range |, with its head. Nested tables are left out.
[[nodiscard]] std::string markdownTable(const std::vector<FieldReference>& fields);
/// The same of all tables in `fields`, each key with its table in front; \param names  of those; others are left out.
[[nodiscard]] std::string markdownTables(const std::vector<FieldReference>& fields,
                                         std::span<const std::string_view> names);
/// A JSON Schema of the file.
[[nodiscard]] Json fileSchema(const std::vector<FieldReference>& fields);
/// Keys, words and tables, for libFuzzer.
[[nodiscard]] std::string fuzzDictionary(const std::vector<FieldReference>& fields);

}  // namespace relief
