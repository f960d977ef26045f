// A struct with fields() as JSON, and the JSON Schema of what that writes. Reports of the tools are written so.
#pragma once

#include <cmath>
#include <filesystem>
#include <glm/vec3.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>

#include "formats/fields/field.h"

namespace relief {

using Json = nlohmann::ordered_json;

/// The double whose shortest decimal is that of the float: 0.1F becomes 0.1.
[[nodiscard]] Json jsonNumber(float value);

namespace fields_detail {

template <class T>
inline constexpr bool kIsOptional = false;
template <class T>
inline constexpr bool kIsOptional<std::optional<T>> = true;
template <class T>
inline constexpr bool kIsVector = false;
template <class T>
inline constexpr bool kIsVector<std::vector<T>> = true;
template <class T>
inline constexpr bool kIsVariant = false;
template <class... T>
inline constexpr bool kIsVariant<std::variant<T...>> = true;
template <class T>
concept Text = std::convertible_to<const T&, std::string_view>;

}  // namespace fields_detail

/// Enumerations are their words, an optional without a value is null, a path its bytes, a vector of three an array.
template <class T>
[[nodiscard]] Json jsonOf(const T& value);

/// Writes each field as a member of an object, in the order of the visits.
class JsonWriter {
  public:
    template <class T>
    void operator()(std::string_view name, const T& value, const FieldInfo&) {
        json_[std::string(name)] = jsonOf(value);
    }
    [[nodiscard]] Json take() { return std::move(json_); }

  private:
    Json json_ = Json::object();
};

template <class T>
Json jsonOf(const T& value) {
    using namespace fields_detail;
    if constexpr (std::same_as<T, Json>) {
        return value;
    } else if constexpr (std::same_as<T, float>) {
        return jsonNumber(value);
    } else if constexpr (std::is_arithmetic_v<T>) {
        return value;
    } else if constexpr (WithWords<T>) {
        return wordOf(value);
    } else if constexpr (std::same_as<T, std::filesystem::path>) {
        return value.native();
    } else if constexpr (Text<T>) {
        return std::string_view(value);
    } else if constexpr (std::same_as<T, glm::vec3>) {
        return Json::array({jsonNumber(value.x), jsonNumber(value.y), jsonNumber(value.z)});
    } else if constexpr (kIsOptional<T>) {
        return value ? jsonOf(*value) : Json(nullptr);
    } else if constexpr (kIsVariant<T>) {
        return std::visit([](const auto& one) { return jsonOf(one); }, value);
    } else if constexpr (WithFields<const T>) {
        JsonWriter writer;
        fields(writer, value);
        return writer.take();
    } else {
        Json array = Json::array();
        for (const auto& one : value) {
            array.push_back(jsonOf(one));
        }
        return array;
    }
}

/// The schema of a field of type T: type, range, description; closed objects with every field required.
template <class T>
[[nodiscard]] Json schemaOf(const T& value, const FieldInfo& info = {});

/// Collects the schema of an object.
class SchemaWriter {
  public:
    template <class T>
    void operator()(std::string_view name, const T& value, const FieldInfo& info) {
        Json schema = {{"description", description(info)}};
        schema.update(schemaOf(value, info));
        properties_[std::string(name)] = std::move(schema);
        required_.push_back(name);
    }
    [[nodiscard]] Json take() {
        return {{"type", "object"},
                {"additionalProperties", false},
                {"required", std::move(required_)},
                {"properties", std::move(properties_)}};
    }
    /// "Centre of attraction, m".
    [[nodiscard]] static std::string description(const FieldInfo& info);

  private:
    Json properties_ = Json::object();
    Json required_ = Json::array();
};

/// "type" with the limits of its range.
[[nodiscard]] Json numberSchema(bool whole, bool is_unsigned, const FieldRange& range);
/// The same, or null.
[[nodiscard]] Json nullable(Json schema);

template <class T>
Json schemaOf(const T& value, const FieldInfo& info) {
    using namespace fields_detail;
    if constexpr (std::same_as<T, bool>) {
        return {{"type", "boolean"}};
    } else if constexpr (std::is_arithmetic_v<T>) {
        return numberSchema(std::is_integral_v<T>, std::is_unsigned_v<T>, info.range);
    } else if constexpr (WithWords<T>) {
        return {{"enum", kWordsOf<T>}};
    } else if constexpr (std::same_as<T, std::filesystem::path> || Text<T>) {
        return {{"type", "string"}};
    } else if constexpr (std::same_as<T, glm::vec3>) {
        return {{"type", "array"},
                {"items", numberSchema(false, false, info.range)},
                {"minItems", 3},
                {"maxItems", 3}};
    } else if constexpr (kIsOptional<T>) {
        return nullable(schemaOf(typename T::value_type{}, info));
    } else if constexpr (kIsVariant<T>) {
        return [&]<std::size_t... I>(std::index_sequence<I...>) {
            return Json{{"oneOf", Json::array({schemaOf(std::variant_alternative_t<I, T>{}, info)...})}};
        }
        (std::make_index_sequence<std::variant_size_v<T>>());
    } else if constexpr (WithFields<const T>) {
        SchemaWriter writer;
        fields(writer, value);
        return writer.take();
    } else {
        return {{"type", "array"}, {"items", schemaOf(typename T::value_type{}, info)}};
    }
}

}  // namespace relief
