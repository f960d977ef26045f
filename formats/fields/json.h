// A struct with fields() as JSON, and the JSON Schema of what that writes. Reports of the tools are written so.
#pragma once

#include <cmath>
#include <filesystem>
#include <glm/vec3.hpp>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "formats/base/text.h"
#include "formats/fields/field.h"
#include "formats/fields/generated.h"

namespace relief {

using Json = nlohmann::ordered_json;

/// The double whose shortest decimal is that of the float: 0.1F becomes 0.1.
[[nodiscard]] Json jsonNumber(float value);

/// Indented, with a line feed at the end. Bytes that are not UTF-8 are replaced.
[[nodiscard]] std::string jsonText(const Json& json);
/// The same in one line.
[[nodiscard]] std::string jsonLine(const Json& json);

namespace fields_detail {

template <class T>
inline constexpr bool kIsArray = false;
template <class T, std::size_t kSize>
inline constexpr bool kIsArray<std::array<T, kSize>> = true;
template <class T>
concept Text = std::convertible_to<const T&, std::string_view>;
/// Of one part of a FieldSpan or a FieldPair.
template <class Member>
using PartOf = Held<std::remove_cvref_t<Member>>;
/// A struct that comes in kinds of different fields: `static std::vector<T> kinds()` returns one of each.
template <class T>
concept WithKinds = requires {
    T::kinds();
};

/// Without a value, an empty text or vector, or a number out of its range.
template <class T>
bool isNone(const T& value, const FieldInfo& info) {
    if constexpr (kIsForm<std::optional, T>) {
        return !value.has_value();
    } else if constexpr (kIsForm<FieldSpan, T>) {
        return isNone(value.least, info);
    } else if constexpr (kIsForm<FieldPair, T>) {
        return isNone(value.first, info) || isNone(value.second, info);
    } else if constexpr (kIsForm<FieldMaybe, T>) {
        return !value.given;
    } else if constexpr (kIsForm<FieldFile, T>) {
        return value.path.empty();
    } else if constexpr (std::is_arithmetic_v<T>) {
        return !info.range.holds(static_cast<double>(value));
    } else if constexpr (kIsForm<FieldGroup, T>) {
        return !value.present;
    } else if constexpr (Text<T>) {
        return std::string_view(value).empty();
    } else if constexpr (kIsForm<std::vector, T>) {
        return value.empty();
    } else {
        return false;
    }
}

}  // namespace fields_detail

/// For a type of its own, a file declares Json jsonField(const T&) beside it, and Json schemaField(const T&).
/// Enumerations are their words, an optional without a value is null, a path its bytes, a vector of three an array.
template <class T>
[[nodiscard]] Json jsonOf(const T& value);

/// Writes each field as a member of an object, in the order of the visits: those for the word of the selecting field, and a
/// single table without its list where it may stand so.
class JsonWriter {
  public:
    template <class T>
    void operator()(std::string_view name, const T& value, const FieldInfo& info) {
        if constexpr (WithWords<T>) {
            selected_ = info.rules.selects ? wordOf(value) : selected_;
        }
        if ((info.left_out && fields_detail::isNone(value, info)) ||
            (!info.rules.only.empty() && !listHas(info.rules.only, selected_))) {
            return;
        }
        if (info.left_out && !info.rules.needs.empty()) {
            needs_.emplace_back(name, info.rules.needs);
        }
        if constexpr (kIsForm<std::vector, T>) {
            if (info.rules.single && value.size() == 1) {
                json_[std::string(name)] = jsonOf(value.front());
                return;
            }
        }
        json_[std::string(name)] = jsonOf(value);
    }
    [[nodiscard]] Json take();

  private:
    Json json_ = Json::object();
    std::string_view selected_;
    std::vector<std::pair<std::string, std::string_view>>
        needs_;  // keys, and those without any of which they go
};

template <class T>
Json jsonOf(const T& value) {
    using namespace fields_detail;
    if constexpr (requires { jsonField(value); }) {
        return jsonField(value);
    } else if constexpr (std::same_as<T, Json>) {
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
    } else if constexpr (kIsForm<std::optional, T>) {
        return value ? jsonOf(*value) : Json(nullptr);
    } else if constexpr (kIsForm<FieldSpan, T>) {
        return Json::array({jsonOf(value.least), jsonOf(value.most)});
    } else if constexpr (kIsForm<FieldPair, T>) {
        return Json::array({jsonOf(value.first), jsonOf(value.second)});
    } else if constexpr (kIsForm<FieldMaybe, T>) {
        return jsonOf(value.value);
    } else if constexpr (kIsForm<FieldFile, T>) {
        return jsonOf(value.path);
    } else if constexpr (kIsForm<std::variant, T>) {
        return std::visit([](const auto& one) { return jsonOf(one); }, value);
    } else if constexpr (WithFields<const T>) {
        if constexpr (kIsForm<FieldGroup, T>) {
            if (!value.present) {
                return nullptr;
            }
        }
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

/// The schema of a field of type T: type, range, description; closed objects, of which every field is required that is
/// not left_out. \param value  any: of a struct that visits other fields by its kind, one of that kind.
template <class T>
[[nodiscard]] Json schemaOf(const T& value, const FieldInfo& info = {});

/// "type" with the limits of its range, or the words.
[[nodiscard]] Json numberSchema(bool whole, bool is_unsigned, const FieldInfo& info);
/// "type" with its pattern, or the words.
[[nodiscard]] Json textSchema(const FieldInfo& info);
[[nodiscard]] Json arraySchema(Json items, const FieldRange& count);
/// The same, or null.
[[nodiscard]] Json nullable(Json schema);

/// Collects the schema of an object.
class SchemaWriter {
  public:
    template <class T>
    void operator()(std::string_view name, const T& value, const FieldInfo& info) {
        Json schema = {{"description", description(info)}};
        schema.update(schemaOf(value, info));
        if (info.rules.single) {
            const Json one = schema["items"];
            schema = Json::object();
            schema["description"] = description(info);
            schema["anyOf"] = Json::array({one, arraySchema(one, {2.0})});
        }
        properties_[std::string(name)] = std::move(schema);
        if (!info.left_out && info.rules.only.empty()) {
            required_.push_back(name);
        }
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

/// The file formats/schemas/NAME.schema.json: `schema` with its heading.
[[nodiscard]] GeneratedText schemaFile(const std::string& name, std::string_view title,
                                       std::string_view description, Json schema);

template <class T>
Json schemaOf(const T& value, const FieldInfo& info) {
    using namespace fields_detail;
    FieldInfo inner = info;  // of what a vector holds
    inner.items = kFromZero;
    inner.left_out = false;
    if constexpr (requires { schemaField(value); }) {
        return schemaField(value);
    } else if constexpr (kIsForm<FieldSpan, T>) {
        return arraySchema(schemaOf(PartOf<decltype(value.most)>{}, inner), {2.0, 2.0});
    } else if constexpr (kIsForm<FieldPair, T>) {
        return arraySchema(schemaOf(PartOf<decltype(value.second)>{}, inner), {2.0, 2.0});
    } else if constexpr (kIsForm<FieldMaybe, T>) {
        return schemaOf(value.value, inner);
    } else if constexpr (kIsForm<FieldFile, T>) {
        return textSchema(info);
    } else if constexpr (std::same_as<T, bool>) {
        return info.words.empty() ? Json{{"type", "boolean"}} : numberSchema(false, false, info);
    } else if constexpr (std::is_arithmetic_v<T>) {
        Json schema = numberSchema(std::is_integral_v<T>, std::is_unsigned_v<T>, info);
        // JSON has no infinity.
        const auto number = static_cast<double>(value);
        return number == std::numeric_limits<double>::infinity() && !info.range.holds(number)
                   ? nullable(std::move(schema))
                   : schema;
    } else if constexpr (WithWords<T>) {
        return {{"enum", kWordsOf<T>}};
    } else if constexpr (std::same_as<T, std::filesystem::path> || Text<T>) {
        return textSchema(info);
    } else if constexpr (std::same_as<T, glm::vec3>) {
        return arraySchema(numberSchema(false, false, info), {3.0, 3.0});
    } else if constexpr (kIsForm<std::optional, T>) {
        Json schema = schemaOf(value ? *value : typename T::value_type{}, inner);
        return info.left_out ? schema : nullable(std::move(schema));
    } else if constexpr (kIsForm<std::variant, T>) {
        return [&]<std::size_t... I>(std::index_sequence<I...>) {
            return Json{{"anyOf", Json::array({schemaOf(std::variant_alternative_t<I, T>{}, info)...})}};
        }
        (std::make_index_sequence<std::variant_size_v<T>>());
    } else if constexpr (WithFields<const T>) {
        const auto object = [](const T& one) {
            SchemaWriter writer;
            fields(writer, one);
            return writer.take();
        };
        if constexpr (WithKinds<T>) {
            Json kinds = Json::array();
            for (const T& one : T::kinds()) {
                kinds.push_back(object(one));
            }
            return {{"anyOf", std::move(kinds)}};
        } else if constexpr (kIsForm<FieldGroup, T>) {
            return value.nullable && !info.left_out ? nullable(object(value)) : object(value);
        } else {
            return object(value);
        }
    } else if constexpr (kIsArray<T>) {
        constexpr double kSize = std::tuple_size_v<T>;
        return arraySchema(schemaOf(typename T::value_type{}, inner), {kSize, kSize});
    } else {
        const bool some = info.left_out && info.items.low < 1.0;
        return arraySchema(schemaOf(typename T::value_type{}, inner), some ? kFromOne : info.items);
    }
}

}  // namespace relief
