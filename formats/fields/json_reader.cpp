// SPDX-License-Identifier: Apache-2.0
#include "formats/fields/json_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::size_t kShownMax = 80;  // bytes of a key

std::string decimal(double value) {
    return value == std::floor(value) && std::abs(value) < 1e15
               ? std::to_string(static_cast<std::int64_t>(value))
               : shortest(static_cast<float>(value));
}

/// Thrown by the functions below if a value is invalid; readJson() converts it into an Error.
struct JsonError {
    std::string message;
};

/// A value of a document with its path: "bodies[3].rotation"; empty for the document itself.
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
    /// \param count  valid number of elements.
    void needArray(const FieldRange& count) const;

    /// Fails with "PATH WHAT", and appends a fix if `what` has none.
    [[noreturn]] void fail(const std::string& what) const;
    /// Fails at the first key that is not a field.
    void rejectUnknown(const std::vector<std::string_view>& fields) const;

  private:
    const nlohmann::json* json_;
    std::string place_;
};

void JsonValue::fail(const std::string& what) const {
    throw JsonError{(place_.empty() ? "the document" : place_) + " " + what +
                    (what.find(';') == std::string::npos ? "; fix it" : "")};
}

std::optional<JsonValue> JsonValue::find(std::string_view key) const {
    const auto found = json_->find(std::string(key));
    return found == json_->end()
               ? std::nullopt
               : std::optional(JsonValue(*found, (place_.empty() ? "" : place_ + ".") + std::string(key)));
}

JsonValue JsonValue::operator[](std::size_t i) const {
    return {(*json_)[i], place_ + "[" + std::to_string(i) + "]"};
}

double JsonValue::number(const FieldRange& range) const {
    if (!json_->is_number()) {
        fail("must be a number");
    }
    const auto value = json_->get<double>();
    if (!range.holds(value)) {
        fail("= " + decimal(value) + " is out of range; " + rangeAdvice(range, decimal));
    }
    return value;
}

std::uint64_t JsonValue::whole(const FieldRange& range) const {
    if (!json_->is_number_unsigned()) {
        fail("must be a whole number of at least 0");
    }
    const auto value = json_->get<std::uint64_t>();
    if (!range.holds(static_cast<double>(value))) {
        fail("= " + std::to_string(value) + " is out of range; " +
             rangeAdvice({std::max(range.low, 0.0), range.high}, decimal));
    }
    return value;
}

bool JsonValue::boolean() const {
    if (!json_->is_boolean()) {
        fail("must be true or false");
    }
    return json_->get<bool>();
}

std::string JsonValue::text() const {
    if (!json_->is_string()) {
        fail("must be a string");
    }
    return json_->get<std::string>();
}

void JsonValue::needObject() const {
    if (!json_->is_object()) {
        fail("must be an object, as in {\"key\": value}");
    }
}

void JsonValue::needArray(const FieldRange& count) const {
    if (!json_->is_array() || static_cast<double>(json_->size()) < count.low) {
        fail("must be an array" +
             (count.low > 0.0
                  ? " of " + std::string(count.low < count.high ? "at least " : "") + decimal(count.low)
                  : std::string()));
    }
    if (static_cast<double>(json_->size()) > count.high) {
        fail("has " + std::to_string(json_->size()) + " elements; at most " + decimal(count.high) +
             " are allowed");
    }
}

void JsonValue::rejectUnknown(const std::vector<std::string_view>& fields) const {
    for (const auto& [key, value] : json_->items()) {
        if (std::find(fields.begin(), fields.end(), key) == fields.end()) {
            const std::string hint = didYouMean(key, fields);
            fail("has an unknown key '" + cleanUtf8(key, kShownMax) + "'" +
                 (hint.empty() ? "; valid keys: " + listed(fields) : hint));
        }
    }
}

void readObject(const JsonValue& from, FieldRef value);

void readNumbers(const JsonValue& from, FieldRef values, const FieldInfo& info) {
    const auto count = static_cast<double>(values.count());
    from.needArray({count, count});
    for (std::size_t i = 0; i < values.count(); ++i) {
        values[i].setReal(from[i].number(info.range));
    }
}

void readValue(const JsonValue& from, FieldRef value, const FieldInfo& info) {
    switch (value.form()) {
        case FieldForm::kBool:
            value.as<bool>() = from.boolean();
            return;
        case FieldForm::kUnsigned: {
            FieldRange range = info.range;
            const double most = std::ldexp(1.0, static_cast<int>(8 * value.type().size)) - 1.0;
            range.high = std::min(range.high, most);
            value.setWhole(from.whole(range));
            return;
        }
        case FieldForm::kReal:
            value.setReal(from.number(info.range));
            return;
        case FieldForm::kString:
            value.as<std::string>() = from.text();
            return;
        case FieldForm::kVector:
        case FieldForm::kArray:
            readNumbers(from, value, info);
            return;
        case FieldForm::kOptional:
            readValue(from, value.add(), info);
            return;
        case FieldForm::kPlaced:
            readValue(from, value.as<FieldPlaced>().value, info);
            return;
        case FieldForm::kList:
            from.needArray(info.items);
            value.type().clear(value.value());
            for (std::size_t i = 0; i < from.json().size(); ++i) {
                readObject(from[i], value.add());
            }
            return;
        default:
            readObject(from, value);
    }
}

/// Reads the members of an object.
class JsonReader : public FieldVisitor {
  public:
    explicit JsonReader(const JsonValue& from) : from_(from) { from.needObject(); }

    void operator()(std::string_view name, FieldRef value, const FieldInfo& info) override {
        fields_.push_back(name);
        if (const std::optional<JsonValue> given = from_.find(name)) {
            readValue(*given, value, info);
        } else if (info.rules.required) {
            from_.fail("has no " + std::string(name) + "; add it: " + std::string(info.help));
        }
    }
    [[nodiscard]] bool fills() const override { return true; }
    void rejectUnknown() const { from_.rejectUnknown(fields_); }

  private:
    const JsonValue& from_;
    std::vector<std::string_view> fields_;
};

void readObject(const JsonValue& from, FieldRef value) {
    JsonReader reader(from);
    value.visit(reader);
    reader.rejectUnknown();
    if (value.type().check != nullptr) {
        const auto given = [&](const std::string& key) { return from.find(key).has_value(); };
        if (const std::optional<FieldFault> fault = value.type().check(value.value(), given)) {
            from.find(fault->path).value_or(from).fail(fault->text);
        }
    }
}

}  // namespace

Result<void> readJson(const nlohmann::json& json, FieldRef value) {
    try {
        readObject(JsonValue(json, ""), value);
        return {};
    } catch (const JsonError& error) {
        return invalidInput(error.message);
    }
}

}  // namespace relief
