// SPDX-License-Identifier: Apache-2.0
#include "bake/import/gltf_data.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "formats/fields/strict_json.h"

namespace relief {
namespace {

using Json = nlohmann::json;

constexpr std::uint64_t kWholeMax = std::uint64_t{1} << 53U;

// Each overload reads a value of one type. Returns the fault ("[3] is not a number"), or "".
std::string parseMember(const Json& json, bool& value) {
    value = json.is_boolean() && json.get<bool>();
    return json.is_boolean() ? "" : " is not true or false";
}

std::string parseMember(const Json& json, float& value) {
    value = json.is_number() ? static_cast<float>(json.get<double>()) : 0.0F;
    return json.is_number() ? "" : " is not a number";
}

std::string parseMember(const Json& json, std::uint64_t& value) {
    const double number = json.is_number() ? json.get<double>() : -1.0;
    value = number >= 0.0 && number <= static_cast<double>(kWholeMax) ? json.get<std::uint64_t>() : 0;
    return value <= kWholeMax && number == static_cast<double>(value) ? "" : " is not a whole number";
}

std::string parseMember(const Json& json, std::string& value) {
    value = json.is_string() ? json.get<std::string>() : "";
    return json.is_string() ? "" : " is not a string";
}

template <class T>
std::string parseMember(const Json& json, std::vector<T>& values) {
    if (!json.is_array()) {
        return " is not an array";
    }
    for (std::size_t i = 0; i < json.size(); ++i) {
        if (std::string fault = parseMember(json[i], values.emplace_back()); !fault.empty()) {
            return "[" + std::to_string(i) + "]" + fault;
        }
    }
    return "";
}

}  // namespace

Result<Json> parseGltfJson(std::string_view text) {
    // Some files are padded with zeros, at which the parser would stop.
    text = text.substr(0, text.find_last_not_of(std::string_view(" \t\r\n\0", 5)) + 1);
    Result<Json> json = parseStrictJson(text);
    return json ? std::move(json) : fail(json.error().code, json.error().message + "; export it again");
}

tl::unexpected<Error> GltfValue::wrong(const std::string& what, ErrorCode code) const {
    return fail(code, (path_.empty() ? "the document" : path_) + " " + what);
}

bool GltfValue::has(const char* name) const {
    return json_->contains(name);
}

template <class T>
Result<std::optional<T>> GltfValue::get(const char* name) const {
    std::optional<T> value;
    if (const auto found = json_->find(name); found != json_->end()) {
        if (const std::string fault = parseMember(*found, value.emplace()); !fault.empty()) {
            return invalidInput(pathOf(name) + fault);
        }
    }
    return value;
}

template Result<std::optional<bool>> GltfValue::get(const char* name) const;
template Result<std::optional<float>> GltfValue::get(const char* name) const;
template Result<std::optional<std::uint64_t>> GltfValue::get(const char* name) const;
template Result<std::optional<std::string>> GltfValue::get(const char* name) const;
template Result<std::optional<std::vector<float>>> GltfValue::get(const char* name) const;
template Result<std::optional<std::vector<std::uint64_t>>> GltfValue::get(const char* name) const;
template Result<std::optional<std::vector<std::string>>> GltfValue::get(const char* name) const;

std::string GltfValue::pathOf(const char* name) const {
    return (path_.empty() ? "" : path_ + ".") + name;
}

Result<GltfValue> GltfValue::child(const Json& json, std::string path, std::uint64_t index) const {
    GltfValue value = *this;
    value.json_ = &json;
    value.path_ = std::move(path);
    value.index_ = index;
    return json.is_object() ? Result<GltfValue>(std::move(value)) : value.wrong("is not an object");
}

Result<std::uint64_t> GltfValue::number(const char* name) const {
    const std::optional<std::uint64_t> value = RELIEF_TRY(get<std::uint64_t>(name));
    return value ? Result<std::uint64_t>(*value) : wrong(std::string("has no ") + name);
}

Result<std::vector<float>> GltfValue::numbers(const char* name, std::size_t count) const {
    std::optional<std::vector<float>> values = RELIEF_TRY(get<std::vector<float>>(name));
    if (values && values->size() != count) {
        return invalidInput(pathOf(name) + " has " + std::to_string(values->size()) + " numbers instead of " +
                            std::to_string(count));
    }
    return std::move(values).value_or(std::vector<float>());
}

Result<std::optional<GltfValue>> GltfValue::object(const char* name) const {
    const auto found = json_->find(name);
    return found == json_->end() ? std::optional<GltfValue>()
                                 : std::optional(RELIEF_TRY(child(*found, pathOf(name))));
}

Result<std::vector<GltfValue>> GltfValue::objects(const char* name) const {
    std::vector<GltfValue> values;
    const auto found = json_->find(name);
    if (found != json_->end() && !found->is_array()) {
        return invalidInput(pathOf(name) + " is not an array");
    }
    for (std::size_t i = 0; found != json_->end() && i < found->size(); ++i) {
        values.push_back(RELIEF_TRY(child((*found)[i], pathOf(name) + "[" + std::to_string(i) + "]", i)));
    }
    return values;
}

Result<std::optional<GltfValue>> GltfValue::named(const char* member, const char* list) const {
    const std::optional<std::uint64_t> index = RELIEF_TRY(get<std::uint64_t>(member));
    return index ? std::optional(RELIEF_TRY(at(*index, list, member))) : std::optional<GltfValue>();
}

Result<GltfValue> GltfValue::needed(const char* member, const char* list) const {
    return at(RELIEF_TRY(number(member)), list, member);
}

Result<GltfValue> GltfValue::at(std::uint64_t index, const char* list, const char* member) const {
    const auto found = document_->find(list);
    const std::string path = std::string(list) + "[" + std::to_string(index) + "]";
    if (found == document_->end() || !found->is_array() || index >= found->size()) {
        return wrong(std::string("has ") + member + " " + path + ", which does not exist");
    }
    return child((*found)[index], path, index);
}

}  // namespace relief
