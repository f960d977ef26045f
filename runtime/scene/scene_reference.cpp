// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_reference.h"

#include <algorithm>
#include <array>

#include "formats/fields/reference.h"
#include "runtime/scene/scene.h"

namespace relief {
namespace {

const Json kNumber = {{"type", "number"}};

Json listOf(const Json& items, std::size_t least, std::size_t most) {
    return {{"type", "array"}, {"items", items}, {"minItems", least}, {"maxItems", most}};
}

CustomSchemas customSchemas() {
    const Json name = {{"type", "string"}, {"minLength", 1}};
    return {
        {&kNumberTrackField, {{{"oneOf", {kNumber, listOf(listOf(kNumber, 2, 2), 1, kLookKeysMax)}}}, {}}},
        {&kColorTrackField,
         {{{"oneOf", {listOf(kNumber, 3, 3), listOf(listOf(kNumber, 4, 4), 1, kLookKeysMax)}}}, {}}},
        {&kEmitterSpeedField,
         {{{"oneOf", {kNumber, listOf(kNumber, 2, 2), fileSchema(referenceOf<NormalSpeed>())}}}, {}}},
        {&kNameListField, {{{"oneOf", {name, {{"type", "array"}, {"items", name}, {"minItems", 1}}}}}, {}}},
        {&kCollidesListField,
         {{{"type", "array"}, {"items", {{"oneOf", {{{"type", "integer"}}, {{"const", "ground"}}}}}}},
          {"ground"}}}};
}

const FieldReference& tableOf(const std::vector<FieldReference>& fields, std::string_view name) {
    return *std::find_if(fields.begin(), fields.end(),
                         [&](const FieldReference& f) { return f.name == name; });
}

}  // namespace

GeneratedTexts sceneReference() {
    const std::vector<FieldReference> fields = referenceOf(Scene{}, customSchemas());
    const std::string readme = "runtime/scene/README.md";
    static constexpr std::array<std::string_view, 13> kTables = {
        "material", "stream",     "time",      "particles", "forces", "attractor", "vortex",
        "flow",     "curl_noise", "collision", "ground",    "camera", "render"};
    GeneratedTexts texts{{readme, "tables", markdownTables(fields, kTables)}};
    for (const std::string_view name : {"collider", "emitter"}) {
        texts.push_back({readme, std::string(name), markdownTables(fields, {&name, 1})});
    }
    for (const std::string_view name : {"type", "spawn"}) {
        texts.push_back({readme, std::string(name), markdownTable(tableOf(fields, name).fields)});
    }
    Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                   {"title", "A scene of relief-sim"}};
    schema.update(fileSchema(fields));
    texts.push_back({"runtime/scene/scene.schema.json", "", jsonText(schema)});
    texts.push_back({.path = "scene.dict", .part = {}, .text = fuzzDictionary(fields), .built = true});
    return texts;
}

}  // namespace relief
