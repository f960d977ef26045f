// SPDX-License-Identifier: Apache-2.0
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

/// Formats a number; powers of 10 and 2 as "10⁶" and "2²⁴".
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

/// Lists the values of small integer ranges: "0 … 2" would suggest that 0.5 is valid.
std::string listOfWhole(const FieldReference& field) {
    constexpr double kListedRange = 4.0;
    const FieldRange& range = field.info.range;
    const auto type = field.type.schema.find("type");
    std::string text;
    if (type != field.type.schema.end() && *type == "integer" && range.high - range.low <= kListedRange) {
        for (double value = range.low; value <= range.high; ++value) {
            text += (text.empty() ? "" : ", ") + prettyNumber(value);
        }
    }
    return text;
}

std::string rangeText(const FieldReference& field) {
    const FieldRange& range = field.info.range;
    std::string text;
    for (const std::string_view word : field.type.words) {
        text += (text.empty() ? "\"" : ", \"") + std::string(word) + "\"";
    }
    if (const std::string list = listOfWhole(field); !list.empty()) {
        text = list;
    } else if (std::isfinite(range.high)) {
        text = range.low == -range.high ? "±" + prettyNumber(range.high)
                                        : (range.low_included ? "" : "above ") + prettyNumber(range.low) +
                                              " … " + prettyNumber(range.high);
    }
    return text + (field.info.rules.not_zero || field.info.rules.unit_length ? ", not 0" : "");
}

/// "`a`, `b`"
std::string quotedKeys(std::string_view keys, const char* separator = ", ") {
    std::string text;
    for (const std::string_view key : split(keys, ' ')) {
        text += (text.empty() ? "" : separator) + ("`" + std::string(key) + "`");
    }
    return text;
}

std::string meaning(const FieldReference& field) {
    const FieldInfo& info = field.info;
    std::string text(info.help);
    text += info.unit.empty() ? "" : ", " + std::string(info.unit);
    text += info.rules.only.empty() ? "" : "; for " + quotedKeys(info.rules.only);
    text += info.rules.needs.empty() ? "" : "; needs " + quotedKeys(info.rules.needs, " or ");
    text += info.rules.instead_of.empty() ? "" : "; instead of " + quotedKeys(info.rules.instead_of);
    return text;
}

/// Reformats JSON's "[0.5,1.0]" as "[0.5, 1]".
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

Json numbersSchema(std::size_t count, bool whole, const FieldInfo& info) {
    const auto size = static_cast<double>(count);
    return arraySchema(numberSchema(whole, false, info), {size, size});
}

Json listSchema(const Json& items) {
    return {{"type", "array"}, {"items", items}};
}

bool isWhole(FieldRef value) {
    return value.form() == FieldForm::kUnsigned || value.form() == FieldForm::kSigned;
}

FieldSchema schemaInFile(FieldRef value, const FieldInfo& info, const CustomSchemas& custom) {
    const FieldType& type = value.type();
    if (const auto found = custom.find(type.custom); found != custom.end()) {
        return found->second;
    }
    switch (value.form()) {
        case FieldForm::kMaybe:
            return schemaInFile(value.as<FieldMaybe>().value, info, custom);
        case FieldForm::kPlaced:
            return schemaInFile(value.as<FieldPlaced>().value, info, custom);
        case FieldForm::kOptional:
            return schemaInFile(FieldRef(type.held->blank(), *type.held), info, custom);
        case FieldForm::kSpan: {
            const bool whole = isWhole(value.as<FieldSpan>().most);
            return {{{"oneOf", {numberSchema(whole, false, info), numbersSchema(2, whole, info)}}}, {}};
        }
        case FieldForm::kPair:
            return {numbersSchema(2, isWhole(value.as<FieldPair>().first), info), {}};
        case FieldForm::kPath:
        case FieldForm::kString:
            return {{{"type", "string"}}, {}};
        case FieldForm::kBool:
            return {{{"type", "boolean"}}, {}};
        case FieldForm::kWord: {
            const std::vector<std::string_view> words(type.words.begin(), type.words.end());
            return {{{"enum", words}}, words};
        }
        case FieldForm::kUnsigned:
        case FieldForm::kSigned:
        case FieldForm::kReal: {
            const Json schema = numberSchema(isWhole(value), value.form() == FieldForm::kUnsigned, info);
            return info.rules.index_of.empty() ? FieldSchema{schema, {}}
                                               : FieldSchema{{{"oneOf", {schema, {{"type", "string"}}}}}, {}};
        }
        default:
            return {numbersSchema(value.count(), isWhole(value[0]), info), {}};
    }
}

/// Collects the fields of a struct.
class ReferenceMaker : public FieldVisitor {
  public:
    explicit ReferenceMaker(const CustomSchemas& custom) : custom_(custom) {}
    void operator()(std::string_view name, FieldRef value, const FieldInfo& info) override {
        FieldReference& made = fields_.emplace_back();
        made.name = name;
        made.info = info;
        describe(made, value);
    }
    std::vector<FieldReference> take() { return std::move(fields_); }

  private:
    void describe(FieldReference& made, FieldRef value) {
        const FieldType& type = value.type();
        if (const auto found = custom_.find(type.custom); found != custom_.end()) {
            made.type = found->second;
            return;
        }
        switch (value.form()) {
            case FieldForm::kList:
                made.several = true;
                made.fields = referenceOf(FieldRef(type.held->blank(), *type.held), custom_);
                return;
            case FieldForm::kOptional:
                describe(made, FieldRef(type.held->blank(), *type.held));
                made.fallback.clear();
                return;
            case FieldForm::kStruct:
                made.fields = referenceOf(value, custom_);
                return;
            default:
                break;
        }
        made.type = schemaInFile(value, made.info, custom_);
        if (value.form() != FieldForm::kPlaced) {
            made.fallback =
                made.info.fallback.empty() && !made.info.rules.required ? jsonOf(value).dump() : "";
        }
    }

    const CustomSchemas& custom_;
    std::vector<FieldReference> fields_;
};

}  // namespace

std::vector<FieldReference> referenceOf(FieldRef value, const CustomSchemas& custom) {
    ReferenceMaker maker(custom);
    value.visit(maker);
    return maker.take();
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

Json fileSchema(const std::vector<FieldReference>& fields, const std::string& place) {
    Json properties = Json::object();
    Json required = Json::array();
    for (const FieldReference& field : fields) {
        Json schema = {{"description", fieldDescription(field.info)}};
        const std::string here = place + "/properties/" + std::string(field.name);
        if (field.fields.empty()) {
            schema.update(field.type.schema);
        } else if (field.info.rules.single) {
            const std::string table = here + "/oneOf/0";
            schema["oneOf"] = {fileSchema(field.fields, table), listSchema({{"$ref", table}})};
        } else if (field.several) {
            schema.update(listSchema(fileSchema(field.fields, here + "/items")));
        } else {
            schema.update(fileSchema(field.fields, here));
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
