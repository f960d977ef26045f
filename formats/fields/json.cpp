#include "formats/fields/json.h"

#include <algorithm>

#include "formats/base/text.h"

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

Json JsonWriter::take() {
    for (const auto& [name, keys] : needs_) {
        const std::vector<std::string_view> needs = listWords(keys);
        if (std::none_of(needs.begin(), needs.end(),
                         [&](std::string_view key) { return json_.contains(std::string(key)); })) {
            json_.erase(name);
        }
    }
    return std::move(json_);
}

std::string SchemaWriter::description(const FieldInfo& info) {
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

GeneratedText schemaFile(const std::string& name, std::string_view title, std::string_view description,
                         Json schema) {
    Json file = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                 {"$id", "urn:relief:schema:" + name},
                 {"title", title},
                 {"description", description}};
    file.update(schema);
    return {"formats/schemas/" + name + ".schema.json", "", jsonText(file)};
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

}  // namespace relief
