#include "formats/fields/reference.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "formats/base/text.h"

namespace relief {
namespace {

std::string superscript(int exponent) {
    static constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string text = exponent < 0 ? "⁻" : "";
    for (const char digit : std::to_string(std::abs(exponent))) {
        text += kDigits[digit - '0'];
    }
    return text;
}

/// 10⁶ and 2²⁴ instead of their digits.
std::string prettyNumber(double value) {
    for (int exponent = -15; exponent <= 15; ++exponent) {
        if ((exponent >= 4 || exponent <= -3) && value == parseDouble("1e" + std::to_string(exponent))) {
            return "10" + superscript(exponent);
        }
    }
    int exponent = 0;
    if (std::frexp(value, &exponent) == 0.5 && exponent > 17) {
        return "2" + superscript(exponent - 1);
    }
    return shortest(static_cast<float>(value));
}

std::string rangeText(const FieldReference& field) {
    const FieldRange& range = field.info.range;
    std::string text;
    for (const std::string_view word : field.type.words) {
        text += (text.empty() ? "\"" : ", \"") + std::string(word) + "\"";
    }
    if (std::isfinite(range.high)) {
        text = range.low == -range.high ? "±" + prettyNumber(range.high)
                                        : (range.low_included ? "" : "above ") + prettyNumber(range.low) +
                                              " … " + prettyNumber(range.high);
    }
    return text + (field.info.rules.not_zero || field.info.rules.unit_length ? ", not 0" : "");
}

/// "`a`, `b`"
std::string quotedKeys(std::string_view keys) {
    std::string text;
    for (const std::string_view key : split(keys, ' ')) {
        text += (text.empty() ? "`" : ", `") + std::string(key) + "`";
    }
    return text;
}

std::string meaning(const FieldReference& field) {
    const FieldInfo& info = field.info;
    std::string text(info.help);
    text += info.unit.empty() ? "" : ", " + std::string(info.unit);
    text += info.rules.only.empty() ? "" : "; for " + quotedKeys(info.rules.only);
    text += info.rules.needs.empty() ? "" : "; needs " + quotedKeys(info.rules.needs);
    text += info.rules.instead_of.empty() ? "" : "; instead of " + quotedKeys(info.rules.instead_of);
    return text;
}

/// "[0.5, 1]" of JSON's "[0.5,1.0]".
std::string prettyDefault(const std::string& json) {
    std::string text;
    for (std::size_t i = 0; i < json.size(); ++i) {
        if (json.compare(i, 2, ".0") == 0 &&
            (i + 2 == json.size() || json[i + 2] == ',' || json[i + 2] == ']')) {
            ++i;
            continue;
        }
        text += json[i];
        text += json[i] == ',' ? " " : "";
    }
    return text;
}

std::string row(const FieldReference& field, const std::string& key) {
    const std::string fallback = !field.info.fallback.empty() ? std::string(field.info.fallback)
                                 : field.info.rules.required  ? "required"
                                                              : prettyDefault(field.fallback);
    return "| " + key + " | " + meaning(field) + " | " + fallback + " | " + rangeText(field) + " |\n";
}

constexpr std::string_view kTableHead = "| key | meaning | default | range |\n| --- | --- | --- | --- |\n";

void addWords(const std::vector<FieldReference>& fields, std::set<std::string>& words) {
    for (const FieldReference& field : fields) {
        words.emplace(field.name);
        words.insert(field.type.words.begin(), field.type.words.end());
        addWords(field.fields, words);
    }
}

}  // namespace

FieldType numbersType(std::size_t count, bool whole, const FieldInfo& info) {
    return {{{"type", "array"},
             {"items", numberSchema(whole, false, info)},
             {"minItems", count},
             {"maxItems", count}},
            {}};
}

FieldType spanType(const FieldInfo& info, bool whole) {
    const Json number = numberSchema(whole, false, info);
    return {{{"oneOf", {number, numbersType(2, whole, info).schema}}}, {}};
}

std::string markdownTable(const std::vector<FieldReference>& fields) {
    std::string text(kTableHead);
    for (const FieldReference& field : fields) {
        if (field.fields.empty()) {
            text += row(field, "`" + std::string(field.name) + "`");
        }
    }
    return text;
}

std::string markdownTables(const std::vector<FieldReference>& fields,
                           std::span<const std::string_view> names) {
    std::string text(kTableHead);
    const auto add = [&](const auto& self, const FieldReference& table, const std::string& name) -> void {
        std::string head = (table.several ? "`[[" : "`[") + name + (table.several ? "]]` " : "]` ");
        for (const FieldReference& field : table.fields) {
            if (field.fields.empty()) {
                text += row(field, head + "`" + std::string(field.name) + "`");
                head.clear();
            }
        }
        for (const FieldReference& field : table.fields) {
            if (!field.fields.empty()) {
                self(self, field, name + "." + std::string(field.name));
            }
        }
    };
    for (const FieldReference& table : fields) {
        if (std::find(names.begin(), names.end(), table.name) != names.end()) {
            add(add, table, std::string(table.name));
        }
    }
    return text;
}

Json fileSchema(const std::vector<FieldReference>& fields) {
    Json properties = Json::object();
    Json required = Json::array();
    for (const FieldReference& field : fields) {
        Json schema = {{"description", SchemaWriter::description(field.info)}};
        if (field.fields.empty()) {
            schema.update(field.type.schema);
        } else {
            Json table = fileSchema(field.fields);
            Json list = {{"type", "array"}, {"items", table}};
            if (field.info.rules.single) {
                schema["oneOf"] = {table, list};
            } else {
                schema.update(field.several ? list : table);
            }
        }
        properties[std::string(field.name)] = std::move(schema);
        if (field.info.rules.required && field.info.rules.only.empty()) {
            required.push_back(field.name);
        }
    }
    return {{"type", "object"},
            {"additionalProperties", false},
            {"required", std::move(required)},
            {"properties", std::move(properties)}};
}

std::string fuzzDictionary(const std::vector<FieldReference>& fields) {
    std::set<std::string> words{"false", "nan", "inf", "true", "1e9", "-1"};
    addWords(fields, words);
    std::string text;
    for (const std::string& word : words) {
        text.append("\"").append(word).append(" = \"\n\"[").append(word).append("]\\x0a\"\n\"[[");
        text.append(word).append("]]\\x0a\"\n\"\\\"").append(word).append("\\\"\"\n");
    }
    return text;
}

}  // namespace relief
