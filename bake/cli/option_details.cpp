// SPDX-License-Identifier: Apache-2.0
#include "bake/cli/option_details.h"

#include <algorithm>

#include "bake/height_map/heights_spec.h"
#include "bake/views/map_spec.h"
#include "formats/fields/text.h"

namespace relief {
namespace {

/// Returns a line of the manual: a key and its meaning.
std::string keyLine(std::string_view key, const std::string& text) {
    constexpr std::size_t kWidth = 9;
    std::string line = "\n" + std::string(key);
    line.resize(std::max(line.size() + 1, kWidth + 1), ' ');
    return line + text;
}

/// "uint16|int16|float32: Type of raw samples (default: …)"
std::string heightsKeyText(const FieldWords& field) {
    const std::string value = field.choices.empty() ? "" : valueText(field) + ": ";
    const std::string fallback = defaultText(field);
    return value + std::string(field.info.help) + (fallback.empty() ? "" : " (default: " + fallback + ")");
}

/// Appends the headings that all verbs share.
std::vector<OptionGroup> withShared(std::vector<OptionGroup> groups) {
    groups.push_back({"Limits",
                      {"--threads", "--timeout", "--max-import-memory", "--import-timeout", "--max-triangles",
                       "--max-memory"}});
    groups.push_back(
        {"Help and messages", {"--help", "--manual", "--quiet", "--verbose", "--warnings-only"}});
    return groups;
}

}  // namespace

void addKeyDetails(CLI::App& verb) {
    std::string maps;
    for (const MapKey& key : kMapKeys) {
        maps += keyLine(key.key, std::string(key.text) + " (" + std::string(key.formats) + ")");
    }
    addDetails(verb, "--map", maps);
    std::string heights;
    for (const FieldWords& field : fieldsOf(HeightsSpec())) {
        heights += keyLine(field.name, heightsKeyText(field));
    }
    addDetails(verb, "--heights", heights);
}

void groupBakeOptions(CLI::App& verb) {
    groupOptions(verb,
                 withShared({
                     {"Output", {"--output", "--compress", "--json", "--depfile"}},
                     {"Size and quality",
                      {"--budget", "--texel", "--max-error", "--quality", "--prefer", "--no-check"}},
                     {"Shape", {"--as", "--thickness", "--holes", "--voids", "--repair", "--materials"}},
                     {"Mesh file", {"--unit", "--up", "--hidden", "--strict"}},
                     {"Animations", {"--animated", "--clips"}},
                     {"Levels", {"--world"}},
                     {"Height maps", {"--heights"}},
                     {"Maps instead of patches", {"--map", "--decode", "--depth", "--paper", "--resolution"}},
                     {"Recipes", {"--recipe", "--shard", "--events", "--stamp", "--dry-run"}},
                 }));
}

void groupVerbOptions(CLI::App& verb, std::vector<OptionGroup> groups) {
    groups.push_back({"Mesh file", {"--unit", "--up", "--hidden"}});
    groupOptions(verb, withShared(std::move(groups)));
}

}  // namespace relief
