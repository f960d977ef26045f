// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_reference.h"

#include <string>
#include <vector>

#include "formats/fields/reference.h"
#include "runtime/scene/scene.h"

namespace relief {
namespace {

const Json kNumber = {{"type", "number"}};

Json listOf(const Json& items, std::size_t min_items, std::size_t max_items) {
    return {{"type", "array"}, {"items", items}, {"minItems", min_items}, {"maxItems", max_items}};
}

CustomSchemas customSchemas() {
    const Json name = {{"type", "string"}, {"minLength", 1}};
    return {
        {&kNumberTrackField, {{{"oneOf", {kNumber, listOf(listOf(kNumber, 2, 2), 1, kLookKeysMax)}}}, {}}},
        {&kColorTrackField,
         {{{"oneOf", {listOf(kNumber, 3, 3), listOf(listOf(kNumber, 4, 4), 1, kLookKeysMax)}}}, {}}},
        {&kEmitterSpeedField,
         {{{"oneOf", {kNumber, listOf(kNumber, 2, 2), fileSchema(referenceOf<NormalSpeed>(), "#")}}}, {}}},
        {&kNameListField, {{{"oneOf", {name, {{"type", "array"}, {"items", name}, {"minItems", 1}}}}}, {}}},
        {&kCollidesListField,
         {{{"type", "array"}, {"items", {{"oneOf", {{{"type", "integer"}}, {{"const", "ground"}}}}}}},
          {"ground"}}}};
}

/// Returns JSON text. A value that is too long for one line has one line per member.
std::string tableText(const Json& json, std::size_t indent = 0) {
    constexpr std::size_t kColumns = 200;
    if (!json.is_structured()) {
        return json.dump();
    }
    std::vector<std::string> members;
    std::size_t width = indent;
    bool several = false;  // lines
    for (const auto& [key, value] : json.items()) {
        const std::string name = json.is_object() ? Json(key).dump() + ": " : "";
        members.push_back(name + tableText(value, indent + 2));
        width += members.back().size() + 2;
        several = several || width > kColumns || members.back().find('\n') != std::string::npos;
    }
    const std::string line = several ? "\n" + std::string(indent, ' ') : "";
    std::string text;
    for (const std::string& member : members) {
        text += (text.empty() ? "" : several ? "," : ", ") + (several ? line + "  " : "") + member;
    }
    return (json.is_object() ? "{" : "[") + text + line + (json.is_object() ? "}" : "]");
}

}  // namespace

GeneratedTexts sceneReference() {
    const std::vector<FieldReference> fields = referenceOf(Scene{}, customSchemas());
    const std::string readme = "runtime/scene/README.md";
    GeneratedTexts texts;
    std::vector<std::string_view> tables;
    for (const FieldReference& field : fields) {
        const std::string part(field.name);
        if (part == "collider" || part == "emitter") {
            texts.push_back({readme, part, markdownTables(fields, {&field.name, 1})});
        } else if (part == "type" || part == "spawn") {
            texts.push_back({readme, part, markdownTable(field.fields)});
        } else {
            tables.push_back(field.name);
        }
    }
    texts.push_back({readme, "tables", markdownTables(fields, tables)});
    Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                   {"title", "A scene of relief-sim"}};
    schema.update(fileSchema(fields, "#"));
    texts.push_back({"runtime/scene/scene.schema.json", "", tableText(schema) + "\n"});
    texts.push_back({.path = "scene.dict", .part = {}, .text = fuzzDictionary(fields), .built = true});
    return texts;
}

}  // namespace relief
