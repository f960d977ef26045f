#include "formats/fields/json_reader.h"

#include <algorithm>

#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::size_t kShownMax = 80;  // bytes of a key

std::string decimal(double value) {
    return value == std::floor(value) && std::abs(value) < 1e15
               ? std::to_string(static_cast<std::int64_t>(value))
               : shortest(static_cast<float>(value));
}

std::string rangeText(const FieldRange& range) {
    const std::string low = (range.low_included ? "" : "above ") + decimal(range.low);
    return std::isfinite(range.high) ? "choose " + low + " to " + decimal(range.high)
                                     : "choose " + low + " or more";
}

}  // namespace

void JsonValue::fail(const std::string& what) const {
    throw JsonMistake{(place_.empty() ? "the document" : place_) + " " + what +
                      (what.find(';') == std::string::npos ? "; mend it" : "")};
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
        fail("= " + decimal(value) + " is out of range; " + rangeText(range));
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
             rangeText({std::max(range.low, 0.0), range.high}));
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
        fail("has " + std::to_string(json_->size()) + " elements; give at most " + decimal(count.high));
    }
}

void JsonValue::refuseUnknown(const std::vector<std::string_view>& fields) const {
    for (const auto& [key, value] : json_->items()) {
        if (std::find(fields.begin(), fields.end(), key) == fields.end()) {
            const std::string hint = didYouMean(key, fields);
            fail("has an unknown key '" + cleanUtf8(key, kShownMax) + "'" +
                 (hint.empty() ? "; known are " + listed(fields) : hint));
        }
    }
}

}  // namespace relief
