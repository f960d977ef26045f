// SPDX-License-Identifier: Apache-2.0
#include "formats/fields/json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "formats/base/text.h"
#include "formats/fields/json_value.h"

namespace relief {

Json jsonNumber(float value) {
    return parseDouble(shortest(value)).value_or(0.0);
}

std::string jsonText(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string jsonLine(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

namespace {

/// Returns whether a field is unset, empty, or out of range.
bool isNone(FieldRef value, const FieldInfo& info) {
    switch (value.form()) {
        case FieldForm::kOptional:
        case FieldForm::kList:
            return value.count() == 0;
        case FieldForm::kSpan:
            return isNone(value.as<FieldSpan>().least, info);
        case FieldForm::kPair:
            return isNone(value.as<FieldPair>().first, info) || isNone(value.as<FieldPair>().second, info);
        case FieldForm::kMaybe:
            return !value.as<FieldMaybe>().given;
        case FieldForm::kPlaced:
            return isNone(value.as<FieldPlaced>().value, info);
        case FieldForm::kGroup:
            return !value.as<FieldGroup>().present;
        case FieldForm::kBool:
            return !info.range.holds(value.as<bool>() ? 1.0 : 0.0);
        default:
            return value.isNumber() ? !info.range.holds(value.number())
                                    : value.isText() && value.text().empty();
    }
}

class JsonWriter : public FieldVisitor {
  public:
    void operator()(std::string_view name, FieldRef value, const FieldInfo& info) override {
        if (value.form() == FieldForm::kWord) {
            selected_ = info.rules.selects ? value.word() : selected_;
        }
        if ((info.left_out && isNone(value, info)) ||
            (!info.rules.only.empty() && !listHas(info.rules.only, selected_))) {
            return;
        }
        if (info.left_out && !info.rules.needs.empty()) {
            needs_.emplace_back(name, info.rules.needs);
        }
        const bool unwrapped = value.form() == FieldForm::kList && info.rules.single && value.count() == 1;
        json_[std::string(name)] = jsonOf(unwrapped ? value[0] : value);
    }
    Json take() {
        for (const auto& [name, keys] : needs_) {
            const std::vector<std::string_view> needs = listWords(keys);
            if (std::none_of(needs.begin(), needs.end(),
                             [&](std::string_view key) { return json_.contains(std::string(key)); })) {
                json_.erase(name);
            }
        }
        return std::move(json_);
    }

  private:
    Json json_ = Json::object();
    std::string_view selected_;
    /// Written keys, each with its FieldRules::needs.
    std::vector<std::pair<std::string, std::string_view>> needs_;
};

Json arrayOf(FieldRef first, FieldRef second) {
    Json array = Json::array();
    array.push_back(jsonOf(first));
    array.push_back(jsonOf(second));
    return array;
}

}  // namespace

Json jsonOf(FieldRef value) {
    if (const FieldCustom* custom = value.type().custom; custom != nullptr && custom->json != nullptr) {
        FieldJson made;
        custom->json(value.value(), made);
        return std::move(made.json);
    }
    switch (value.form()) {
        case FieldForm::kBool:
            return value.as<bool>();
        case FieldForm::kUnsigned:
            return value.whole();
        case FieldForm::kSigned:
            return value.integer();
        case FieldForm::kReal:
            return value.type().size == sizeof(float) ? jsonNumber(value.as<float>()) : Json(value.number());
        case FieldForm::kWord:
            return value.word();
        case FieldForm::kString:
        case FieldForm::kText:
        case FieldForm::kPath:
            return value.text();
        case FieldForm::kOptional:
            return value.count() == 0 ? Json(nullptr) : jsonOf(value[0]);
        case FieldForm::kVariant:
            return jsonOf(value.type().chosen(value.value()));
        case FieldForm::kSpan:
            return arrayOf(value.as<FieldSpan>().least, value.as<FieldSpan>().most);
        case FieldForm::kPair:
            return arrayOf(value.as<FieldPair>().first, value.as<FieldPair>().second);
        case FieldForm::kMaybe:
            return jsonOf(value.as<FieldMaybe>().value);
        case FieldForm::kPlaced:
            return jsonOf(value.as<FieldPlaced>().value);
        case FieldForm::kGroup:
            if (!value.as<FieldGroup>().present) {
                return nullptr;
            }
            [[fallthrough]];
        case FieldForm::kStruct: {
            JsonWriter writer;
            value.visit(writer);
            return writer.take();
        }
        case FieldForm::kVector:
        case FieldForm::kArray:
        case FieldForm::kList:
        case FieldForm::kCustom:
            break;
    }
    Json array = Json::array();
    for (std::size_t i = 0; i < value.count(); ++i) {
        array.push_back(jsonOf(value[i]));
    }
    return array;
}

std::string jsonTextOf(FieldRef value) {
    return jsonText(jsonOf(value));
}

std::string jsonLineOf(FieldRef value) {
    return jsonLine(jsonOf(value));
}

std::string fieldDescription(const FieldInfo& info) {
    std::string text(info.help);
    return info.unit.empty() ? text : text.append(", ").append(info.unit);
}

Json numberSchema(bool whole, bool is_unsigned, const FieldInfo& info) {
    if (!info.words.empty()) {
        Json numbers = Json::array();
        for (const std::string_view word : info.words) {
            numbers.push_back(Json::parse(word));
        }
        return {{"enum", std::move(numbers)}};
    }
    const FieldRange& range = info.range;
    Json schema = {{"type", whole ? "integer" : "number"}};
    const auto limit = [whole](double value) {
        return whole || value == std::floor(value) ? Json(static_cast<std::int64_t>(value)) : Json(value);
    };
    if (std::isfinite(range.low)) {
        schema[range.low_included ? "minimum" : "exclusiveMinimum"] = limit(range.low);
    } else if (is_unsigned) {
        schema["minimum"] = 0;
    }
    if (std::isfinite(range.high)) {
        schema["maximum"] = limit(range.high);
    }
    return schema;
}

Json textSchema(const FieldInfo& info) {
    if (!info.words.empty()) {
        return {{"enum", std::vector<std::string_view>(info.words.begin(), info.words.end())}};
    }
    Json schema = {{"type", "string"}};
    if (!info.pattern.empty()) {
        schema["pattern"] = info.pattern;
    }
    return schema;
}

Json arraySchema(Json items, const FieldRange& count) {
    Json schema = {{"type", "array"}, {"items", std::move(items)}};
    if (count.low > 0.0) {
        schema["minItems"] = static_cast<std::int64_t>(count.low);
    }
    if (std::isfinite(count.high)) {
        schema["maxItems"] = static_cast<std::int64_t>(count.high);
    }
    return schema;
}

Json nullable(Json schema) {
    if (schema.contains("enum")) {
        schema["enum"].push_back(nullptr);
        return schema;
    }
    if (schema.contains("type") && schema["type"].is_string() && !schema.contains("properties")) {
        schema["type"] = Json::array({schema["type"], "null"});
        return schema;
    }
    return {{"oneOf", Json::array({std::move(schema), {{"type", "null"}}})}};
}

namespace {

class SchemaWriter : public FieldVisitor {
  public:
    void operator()(std::string_view name, FieldRef value, const FieldInfo& info) override {
        Json schema = {{"description", fieldDescription(info)}};
        schema.update(schemaOf(value, info));
        if (info.rules.single) {
            const Json one = schema["items"];
            schema = Json::object();
            schema["description"] = fieldDescription(info);
            schema["anyOf"] = Json::array({one, arraySchema(one, {2.0})});
        }
        properties_[std::string(name)] = std::move(schema);
        if (!info.left_out && info.rules.only.empty()) {
            required_.push_back(name);
        }
    }
    Json take() {
        return {{"type", "object"},
                {"additionalProperties", false},
                {"required", std::move(required_)},
                {"properties", std::move(properties_)}};
    }

  private:
    Json properties_ = Json::object();
    Json required_ = Json::array();
};

Json objectSchema(FieldRef value) {
    SchemaWriter writer;
    value.visit(writer);
    return writer.take();
}

Json structSchema(FieldRef value) {
    if (value.type().kinds == nullptr) {
        return objectSchema(value);
    }
    Json kinds = Json::array();
    value.type().kinds([&](FieldRef one) { kinds.push_back(objectSchema(one)); });
    return {{"anyOf", std::move(kinds)}};
}

Json realSchema(FieldRef value, const FieldInfo& info) {
    const bool whole = value.form() != FieldForm::kReal;
    Json schema = numberSchema(whole, value.form() == FieldForm::kUnsigned, info);
    // JSON has no infinity.
    const double number = value.number();
    return number == std::numeric_limits<double>::infinity() && !info.range.holds(number)
               ? nullable(std::move(schema))
               : schema;
}

}  // namespace

Json schemaOf(FieldRef value) {
    return schemaOf(value, FieldInfo{});
}

Json schemaOf(FieldRef value, const FieldInfo& info) {
    FieldInfo inner = info;  // for the elements of a list
    inner.items = kFromZero;
    inner.left_out = false;
    const FieldType& type = value.type();
    const auto held = [&] { return schemaOf(FieldRef(type.held->blank(), *type.held), inner); };
    const auto blankPart = [&](FieldRef part) {
        return schemaOf(part.blank().valueOrDefault().blank(), inner);
    };
    if (type.custom != nullptr && type.custom->schema != nullptr) {
        FieldJson made;
        type.custom->schema(made);
        return std::move(made.json);
    }
    switch (value.form()) {
        case FieldForm::kSpan:
            return arraySchema(blankPart(value.as<FieldSpan>().most), {2.0, 2.0});
        case FieldForm::kPair:
            return arraySchema(blankPart(value.as<FieldPair>().second), {2.0, 2.0});
        case FieldForm::kMaybe:
            return schemaOf(value.as<FieldMaybe>().value, inner);
        case FieldForm::kPlaced:
            return schemaOf(value.as<FieldPlaced>().value, info);
        case FieldForm::kBool:
            return info.words.empty() ? Json{{"type", "boolean"}} : numberSchema(false, false, info);
        case FieldForm::kUnsigned:
        case FieldForm::kSigned:
        case FieldForm::kReal:
            return realSchema(value, info);
        case FieldForm::kWord:
            return {{"enum", std::vector<std::string_view>(type.words.begin(), type.words.end())}};
        case FieldForm::kString:
        case FieldForm::kText:
        case FieldForm::kPath:
            return textSchema(info);
        case FieldForm::kVector:
            return arraySchema(numberSchema(false, false, info), {3.0, 3.0});
        case FieldForm::kOptional: {
            Json schema = schemaOf(value.valueOrDefault(), inner);
            return info.left_out ? schema : nullable(std::move(schema));
        }
        case FieldForm::kVariant: {
            Json kinds = Json::array();
            for (const FieldType* one : type.alternatives) {
                kinds.push_back(schemaOf(FieldRef(one->blank(), *one), info));
            }
            return {{"anyOf", std::move(kinds)}};
        }
        case FieldForm::kGroup:
            return value.as<FieldGroup>().nullable && !info.left_out ? nullable(objectSchema(value))
                                                                     : objectSchema(value);
        case FieldForm::kStruct:
            return structSchema(value);
        case FieldForm::kArray: {
            const auto size = static_cast<double>(type.count);
            return arraySchema(held(), {size, size});
        }
        case FieldForm::kList:
        case FieldForm::kCustom:
            break;
    }
    const bool some = info.left_out && info.items.low < 1.0;
    return arraySchema(held(), some ? kFromOne : info.items);
}

GeneratedText schemaFile(const std::string& name, std::string_view title, std::string_view description,
                         FieldRef value) {
    Json file = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                 {"$id", "urn:relief:schema:" + name},
                 {"title", title},
                 {"description", description}};
    file.update(schemaOf(value));
    return {name + ".schema.json", "", jsonText(file), true};
}

}  // namespace relief
