// Reads a JSON document into a struct with fields() (formats/base/field.h): the counterpart of jsonOf(). Unknown keys, wrong
// types, numbers out of their range and required fields that are missing are mistakes, each reported as
// "bodies[3].rotation must be …; the cure".
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "formats/base/field.h"
#include "formats/base/result.h"

namespace relief {

/// Thrown by everything below where a value is wrong; readJson() turns it into an Error.
struct JsonMistake {
    std::string message;
};

/// A value of a document with its place: "bodies[3].rotation"; empty for the document itself.
class JsonValue {
  public:
    JsonValue(const nlohmann::json& json, std::string place) : json_(&json), place_(std::move(place)) {}

    [[nodiscard]] const nlohmann::json& json() const { return *json_; }
    [[nodiscard]] const std::string& place() const { return place_; }

    [[nodiscard]] std::optional<JsonValue> find(std::string_view key) const;
    [[nodiscard]] JsonValue operator[](std::size_t i) const;

    [[nodiscard]] double number(const FieldRange& range) const;
    [[nodiscard]] std::uint64_t whole(const FieldRange& range) const;
    [[nodiscard]] bool boolean() const;
    [[nodiscard]] std::string text() const;
    void needObject() const;
    /// \param count  of elements.
    void needArray(const FieldRange& count) const;

    /// "PLACE WHAT", with a cure if that has none.
    [[noreturn]] void fail(const std::string& what) const;
    /// Fails at the first key that none of the fields has.
    void refuseUnknown(const std::vector<std::string_view>& fields) const;

  private:
    const nlohmann::json* json_;
    std::string place_;
};

/// Reads the members of an object.
class JsonReader {
  public:
    explicit JsonReader(const JsonValue& from) : from_(from) { from.needObject(); }

    template <class T>
    void operator()(std::string_view name, T& value, const FieldInfo& info) {
        fields_.push_back(name);
        if (const std::optional<JsonValue> given = from_.find(name)) {
            read(*given, value, info);
        } else if (info.rules.required) {
            from_.fail("has no " + std::string(name) + "; give it: " + std::string(info.help));
        }
    }
    void refuseUnknown() const { from_.refuseUnknown(fields_); }

    template <class T>
    static void readObject(const JsonValue& from, T& value) {
        JsonReader reader(from);
        fields(reader, value);
        reader.refuseUnknown();
        if constexpr (requires(const GivenFields& given) { check(value, given); }) {
            const auto given = [&](const std::string& key) { return from.find(key).has_value(); };
            if (const std::optional<FieldFault> fault = check(value, GivenFields(given))) {
                from.find(fault->path).value_or(from).fail(fault->text);
            }
        }
    }

  private:
    template <class T>
    static void readNumbers(const JsonValue& from, T& values, std::size_t count, const FieldInfo& info) {
        from.needArray({static_cast<double>(count), static_cast<double>(count)});
        for (std::size_t i = 0; i < count; ++i) {
            values[static_cast<int>(i)] = static_cast<float>(from[i].number(info.range));
        }
    }

    template <class T>
    static void read(const JsonValue& from, T& value, const FieldInfo& info) {
        if constexpr (std::same_as<T, bool>) {
            value = from.boolean();
        } else if constexpr (std::is_unsigned_v<T>) {
            FieldRange range = info.range;
            range.high = std::min(range.high, static_cast<double>(std::numeric_limits<T>::max()));
            value = static_cast<T>(from.whole(range));
        } else if constexpr (std::same_as<T, float>) {
            value = static_cast<float>(from.number(info.range));
        } else if constexpr (std::same_as<T, std::string>) {
            value = from.text();
        } else if constexpr (std::same_as<T, glm::vec3>) {
            readNumbers(from, value, 3, info);
        } else if constexpr (requires { std::tuple_size<T>::value; }) {
            readNumbers(from, value, std::tuple_size_v<T>, info);
        } else if constexpr (kIsForm<std::optional, T>) {
            read(from, value.emplace(), info);
        } else if constexpr (kIsForm<std::vector, T>) {
            from.needArray(info.items);
            value.clear();
            for (std::size_t i = 0; i < from.json().size(); ++i) {
                readObject(from[i], value.emplace_back());
            }
        } else {
            readObject(from, value);
        }
    }

    const JsonValue& from_;
    std::vector<std::string_view> fields_;
};

/// \param value  whose floats have ranges that floats can hold. Changed also where it fails.
/// Errors: kInvalidInput, kLimit (more elements than a field may have), without the file's name.
template <class T>
[[nodiscard]] Result<void> readJson(const nlohmann::json& json, T& value) {
    try {
        JsonReader::readObject(JsonValue(json, ""), value);
        return {};
    } catch (const JsonMistake& mistake) {
        return invalidInput(mistake.message);
    }
}

}  // namespace relief
