// SPDX-License-Identifier: Apache-2.0
#include "bake/cli/option_details.h"

#include <algorithm>
#include <array>
#include <utility>

#include "bake/height_map/heights_spec.h"
#include "formats/fields/text.h"

namespace relief {
namespace {

struct OptionDetails {
    std::string_view name;
    std::string_view text;
};

constexpr std::array kBakeDetails = std::to_array<OptionDetails>({
    {"map",
     "A map covers the whole mesh from one view. It can be drawn and inspected as an image, but has more "
     "errors than patches of the same size. --map excludes --paper, --budget, --texel and --max-error."},
    {"decode",
     "plane measures the distance to a plane that is fitted to the whole texel. projected measures along the "
     "ray, to a flat texel."},
    {"depth", "unorm16 is 16-bit fixed point; half is half floats."},
    {"paper", "The maps have the keys depth=half and decode=projected."},
    {"resolution",
     "Applies to --paper, --holes keep, --animated, and to each --map without the key size. It has no effect "
     "on patches."},
    {"budget",
     "The file is a few hundred bytes larger, or smaller with --compress. With --max-error and --texel, the "
     "budget is an upper limit. With --world, it is shared by all colliders, and its default is 16MB."},
    {"texel",
     "A cell is split while its patch is off by more than a quarter of the texel and its side is longer than "
     "two texels; all patches take at most 134 MB. With --budget, the texel grows until the patches fit, and "
     "a warning states its length. "
     "With --world, the length is in units of the level, and each mesh is baked for its largest scale."},
    {"max_error",
     "Tries budgets from 32kB to 64MB, or up to --budget, and measures each as `relief check` does, with "
     "50000 points. If none is accurate enough, the exit code is 7 and nothing is written. It excludes "
     "--texel."},
    {"quality",
     "fast fits each plane to 1 ray per texel, normal to 16 and best to 36. Higher settings also try more "
     "lines and cells for patches."},
    {"prefer",
     "inside keeps particles out of walls, outside keeps free space free. Each removes most errors of one "
     "kind and adds errors of the other kind."},
    {"threads", "Results do not depend on it."},
    {"holes",
     "keep uses three front-back maps along the axes, or the maps of --map or --paper. An open surface has "
     "no inside, so it cannot be baked into patches."},
    {"no_check",
     "A bake of patches otherwise ends with a verdict from 4000 points. It warns, with remedies, if more "
     "than 1 % of them are wrong or a part is lost."},
    {"unit", "If neither the option nor the file states a unit, lengths are not converted."},
    {"strict", "With --repair, it rejects a repaired mesh that is still open."},
    {"as",
     "auto classifies each part by casting rays. solid closes holes. shell makes a wall with two sides. "
     "terrain is solid below the surface. NAME is a node and everything below it, a mesh, an OBJ group or a "
     "material. If several names match, the last option counts."},
    {"materials",
     "The collider stores which material covers each part of its surface, in at most 6 % of its bytes, or 4 "
     "KiB if that is more."},
    {"animated",
     "The runtime poses the collider. Three front-back maps along the axes, with --resolution texels a side, "
     "store its rest pose. Besides the options of its output, only --clips, --resolution, --quality, "
     "--prefer, --unit, --up and limits apply."},
    {"heights",
     "Heights go along +y, columns along +x and rows along +z. A PNG is grey, of 8 or 16 bits. An EXR image "
     "has one channel of heights in metres; NaN marks holes. Raw samples are files .raw, .r16 or .hgt. "
     "Squares with a hole at a corner have no ground. Besides the options of its output, only limits apply."},
    {"output", "With --recipe, it is the output folder, by default the recipe's folder."},
    {"recipe",
     "Each bake runs in a process of its own; -j sets how many run at once. Options of the bakes are keys of "
     "the recipe."},
    {"stamp", "--depfile names this file as its target."},
    {"world",
     "Each distinct mesh is baked once, however many nodes place it. Only what has changed is baked again. "
     "Options that choose maps, such as --map, --holes keep and --max-error, are for one mesh; the others "
     "apply to every mesh."},
});

struct MapKey {
    std::string_view key;
    std::string_view formats;
    std::string_view text;
};

constexpr std::array kMapKeys = std::to_array<MapKey>({
    {"bytes", "patches", "size on the GPU, 1MB by default"},
    {"texel", "patches", "texel length as in --texel; bytes is then an upper limit"},
    {"dir", "float, fixed8, front-back", "view direction: +x, -x, +y, -y, +z, -z or a vector a/b/c"},
    {"up", "float, fixed8, front-back", "up direction of the image, as in dir"},
    {"size", "all but patches", "texels: N, or WxH for all but cube"},
    {"compare", "float, fixed8, cube",
     "less (default) keeps the nearest surface, greater the farthest; a cube whose centre is inside the mesh "
     "defaults to greater"},
    {"center", "cube", "viewpoint a/b/c, by default the middle of the box"},
    {"depth", "front-back", "unorm16 (default): 16-bit fixed point; half: half floats, as in the paper"},
    {"decode", "all but patches",
     "plane (default): distance to a plane fitted to the whole texel; projected: along the ray to a flat "
     "texel, as in the paper"},
    {"box", "all but patches", "region to cover: tight (default) or x0/y0/z0/x1/y1/z1"},
});

/// A line of the manual: a key, and what it means.
std::string keyLine(std::string_view key, const std::string& text) {
    constexpr std::size_t kWidth = 9;
    std::string line = "\n" + std::string(key);
    line.resize(std::max(line.size() + 1, kWidth + 1), ' ');
    return line + text;
}

std::string mapKeyLines() {
    std::string text;
    for (const MapKey& key : kMapKeys) {
        text += keyLine(key.key, std::string(key.text) + " (" + std::string(key.formats) + ")");
    }
    return text;
}

/// "uint16|int16|float32: Type of raw samples (default: …)"
std::string heightsKeyText(const FieldWords& field) {
    const std::string value = field.choices.empty() ? "" : valueText(field) + ": ";
    const std::string fallback = defaultText(field);
    return value + std::string(field.info.help) + (fallback.empty() ? "" : " (default: " + fallback + ")");
}

std::string heightsKeyLines() {
    std::string text;
    for (const FieldWords& field : fieldsOf(HeightsSpec())) {
        text += keyLine(field.name, heightsKeyText(field));
    }
    return text;
}

std::string cell(std::string_view text) {
    std::string out;
    for (const char c : text) {
        out += c == '|' ? "\\|" : std::string(1, c);
    }
    return out;
}

const std::vector<OptionGroup>& sharedGroups() {
    static const std::vector<OptionGroup> kGroups = {
        {"Limits",
         {"--threads", "--timeout", "--max-import-memory", "--import-timeout", "--max-triangles",
          "--max-memory"}},
        {"Help and messages", {"--help", "--manual", "--quiet", "--verbose", "--warnings-only"}}};
    return kGroups;
}

std::vector<OptionGroup> withShared(std::vector<OptionGroup> groups) {
    const std::vector<OptionGroup>& shared = sharedGroups();
    groups.insert(groups.end(), shared.begin(), shared.end());
    return groups;
}

}  // namespace

std::string_view bakeDetails(std::string_view name) {
    const auto* const found = std::ranges::find(kBakeDetails, name, &OptionDetails::name);
    return found == kBakeDetails.end() ? std::string_view() : found->text;
}

std::string mapKeyTable() {
    std::string text = "| key | formats | value |\n| --- | --- | --- |\n";
    for (const MapKey& key : kMapKeys) {
        text.append("| `").append(key.key).append("` | ").append(key.formats).append(" | ");
        text.append(key.text).append(" |\n");
    }
    return text;
}

std::string heightsKeyTable() {
    std::string text = "| key | meaning | default |\n| --- | --- | --- |\n";
    for (const FieldWords& field : fieldsOf(HeightsSpec())) {
        text += "| `" + field.name + (field.choices.empty() ? "" : "=" + cell(valueText(field))) + "` | " +
                std::string(field.info.help) + " | " + defaultText(field) + " |\n";
    }
    return text;
}

void addBakeDetails(CLI::App& verb) {
    for (const OptionDetails& option : kBakeDetails) {
        const std::string keys = option.name == "map"       ? mapKeyLines()
                                 : option.name == "heights" ? heightsKeyLines()
                                                            : "";
        addDetails(verb, optionName(option.name), std::string(option.text) + keys);
    }
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
