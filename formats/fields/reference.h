// A struct that is read from files (formats/config/toml_reader.h), described for people, editors and fuzzers: tables of
// Markdown, JSON Schema and dictionaries. All are made of one tree.
#pragma once

#include <array>
#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "formats/fields/json.h"

namespace relief {

/// The type of a value in the file.
struct FieldType {
    Json schema;
    std::vector<std::string_view> words;  ///< of an enumeration
};

struct FieldReference {
    std::string_view name;
    FieldInfo info;
    FieldType type;                      ///< of a table: nothing
    std::string fallback;                ///< the default, as the file would have it
    std::vector<FieldReference> fields;  ///< of a table
    bool several = false;                ///< [[name]]
};

/// For a type of its own, a file declares FieldType fieldType(const T&) beside it.
template <class T>
[[nodiscard]] FieldType typeOf(const T& value, const FieldInfo& info);
/// A list of so many numbers.
[[nodiscard]] FieldType numbersType(std::size_t count, bool whole, const FieldInfo& info);
/// \param schema  of one number.
[[nodiscard]] FieldType spanType(const FieldInfo& info, bool whole);

/// Collects the fields of a struct.
class ReferenceMaker {
  public:
    template <class T>
    void operator()(std::string_view name, const T& value, const FieldInfo& info) {
        FieldReference& made = fields_.emplace_back();
        made.name = name;
        made.info = info;
        describe(made, value);
    }
    [[nodiscard]] std::vector<FieldReference> take() { return std::move(fields_); }

  private:
    template <class T>
    static void describe(FieldReference& made, const T& value);

    std::vector<FieldReference> fields_;
};

template <class T>
[[nodiscard]] std::vector<FieldReference> referenceOf(const T& value = {}) {
    ReferenceMaker maker;
    fields(maker, value);
    return maker.take();
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

template <class T>
FieldType typeOf(const T& value, const FieldInfo& info) {
    if constexpr (requires { fieldType(value); }) {
        return fieldType(value);
    } else if constexpr (kIsForm<FieldMaybe, T>) {
        return typeOf(value.value, info);
    } else if constexpr (kIsForm<std::optional, T>) {
        return typeOf(typename T::value_type{}, info);
    } else if constexpr (kIsForm<FieldSpan, T>) {
        return spanType(info, std::is_integral_v<std::remove_cvref_t<decltype(value.most)>>);
    } else if constexpr (kIsForm<FieldPair, T>) {
        return numbersType(2, std::is_integral_v<std::remove_cvref_t<decltype(value.first)>>, info);
    } else if constexpr (kIsForm<FieldFile, T> || std::same_as<T, std::string>) {
        return {{{"type", "string"}}, {}};
    } else if constexpr (std::same_as<T, bool>) {
        return {{{"type", "boolean"}}, {}};
    } else if constexpr (WithWords<T>) {
        return {{{"enum", kWordsOf<T>}}, {kWordsOf<T>.begin(), kWordsOf<T>.end()}};
    } else if constexpr (std::is_arithmetic_v<T>) {
        const Json schema = numberSchema(std::is_integral_v<T>, std::is_unsigned_v<T>, info);
        return info.rules.index_of.empty() ? FieldType{schema, {}}
                                           : FieldType{{{"oneOf", {schema, {{"type", "string"}}}}}, {}};
    } else {
        return numbersType(sizeof(T) / sizeof(value[0]),
                           std::is_integral_v<std::remove_cvref_t<decltype(value[0])>>, info);
    }
}

template <class T>
void ReferenceMaker::describe(FieldReference& made, const T& value) {
    if constexpr (requires { fieldType(value); }) {
        made.type = fieldType(value);
    } else if constexpr (kIsForm<std::vector, T>) {
        made.several = true;
        made.fields = referenceOf(typename T::value_type{});
    } else if constexpr (kIsForm<std::optional, T>) {
        describe(made, typename T::value_type{});
        made.fallback.clear();
    } else if constexpr (WithFields<const T>) {
        made.fields = referenceOf(value);
    } else {
        made.type = typeOf(value, made.info);
        if constexpr (!kIsForm<FieldFile, T>) {
            made.fallback =
                made.info.fallback.empty() && !made.info.rules.required ? jsonOf(value).dump() : "";
        }
    }
}

}  // namespace relief
