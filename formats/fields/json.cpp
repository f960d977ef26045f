#include "formats/fields/json.h"

#include <charconv>

#include "formats/base/text.h"

namespace relief {

Json jsonNumber(float value) {
    double number = 0.0;
    const std::string text = shortest(value);
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

std::string SchemaWriter::description(const FieldInfo& info) {
    std::string text(info.help);
    return info.unit.empty() ? text : text.append(", ").append(info.unit);
}

Json numberSchema(bool whole, bool is_unsigned, const FieldRange& range) {
    Json schema = {{"type", whole ? "integer" : "number"}};
    const auto limit = [whole](double value) {
        return whole ? Json(static_cast<std::int64_t>(value)) : Json(value);
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
