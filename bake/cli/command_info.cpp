// SPDX-License-Identifier: Apache-2.0
// relief info: shows the contents of containers and worlds.

#include "bake/cli/command.h"
#include "bake/cli/option_details.h"
#include "bake/cli/world_info.h"
#include "bake/report/collider_report.h"
#include "formats/base/result.h"
#include "formats/base/text.h"
#include "formats/fields/json.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/option_values.h"

namespace relief {
namespace {

struct InfoCommand {
    CommonOptions common;
    std::vector<std::string> files;
    ContainerLimits limits;
    bool json = false;
};

std::string rowText(const glm::vec4& row) {
    return shortest(row.x) + " " + shortest(row.y) + " " + shortest(row.z) + " " + shortest(row.w);
}

std::string vectorText(const glm::vec3& v) {
    return "(" + shortest(v.x) + ", " + shortest(v.y) + ", " + shortest(v.z) + ")";
}

std::string humanReport(const Collider& collider, const ContainerInfo& info, const AnimatedMesh* animated) {
    const Provenance& from = collider.provenance;
    std::string text = "Relief container " + std::to_string(info.major) + "." + std::to_string(info.minor) +
                       ", " + bytesText(info.file_size) + "\n";
    text += "bounds   " + vectorText(collider.bounds.min) + " to " + vectorText(collider.bounds.max) + " " +
            unitText(collider.unit) + "\n";
    text += "mesh     " + cleanUtf8(from.mesh_name) + ", " + std::to_string(from.triangles) +
            " triangles, XXH3-128 " + (from.mesh_hash.empty() ? "unknown" : from.mesh_hash) + "\n";
    text += originText(from);
    if (animated != nullptr) {
        text += "moves    " + animationText(*animated);
    }
    if (!collider.materials.empty()) {
        text += "surface  " + materialsText(collider.materials);
    }
    std::vector<std::vector<std::string>> rows = {
        {"map", "format", "projection", "keeps", "size>", "bytes>", "stored>", "encloses", "empty is"}};
    for (std::size_t i = 0; i < collider.maps.size(); ++i) {
        const DepthMap& map = collider.maps[i];
        rows.push_back({std::to_string(i), mapFormatName(map.format), projectionText(map), keepsText(map),
                        sizeText(map), bytesText(info.payloads[i].raw_size),
                        bytesText(info.payloads[i].stored_size) +
                            (info.payloads[i].packing == Packing::kNone
                                 ? ""
                                 : std::string(" ") + packingName(info.payloads[i].packing)),
                        map.encloses ? "yes" : "no", map.empty_is_outside ? "outside" : "unknown"});
    }
    text += table(rows);
    for (std::size_t i = 0; i < collider.maps.size(); ++i) {
        const DepthMap& map = collider.maps[i];
        text += "map " + std::to_string(i) + " object to map: " + rowText(map.object_to_map.row[0]) + " | " +
                rowText(map.object_to_map.row[1]) + " | " + rowText(map.object_to_map.row[2]) +
                "; object per map: " + vectorText(map.object_per_map) + "\n";
    }
    return text;
}

Result<void> runInfo(const InfoCommand& command, const std::string& file) {
    const bool several = command.files.size() > 1;
    if (several && !command.json) {
        RELIEF_TRY(printOut((file == command.files.front() ? "" : "\n") + inputName(file) + ":\n"));
    }
    if (isWorldFile(file)) {
        const WorldInfo info = RELIEF_TRY(readWorldInfo(file, command.limits));
        return printOut(command.json ? jsonTextOf(info) : worldInfoText(info));
    }
    // Validates the whole file, including payloads.
    const ColliderFile shown = RELIEF_TRY(readColliderFile(file, command.limits));
    const ContainerInfo info =
        RELIEF_TRY(withPrefix(inputText(file), readContainerInfo(shown.bytes, command.limits)));
    std::optional<AnimatedMesh> mesh;
    if (!shown.collider.animation.empty()) {
        mesh = RELIEF_TRY(withPrefix(inputText(file), readAnimatedMesh(shown.collider.animation)));
    }
    const AnimatedMesh* const animated = mesh ? &*mesh : nullptr;
    const ColliderJson report{shown.collider, info, animated, several ? inputName(file) : ""};
    return printOut(command.json ? jsonTextOf(report) : humanReport(shown.collider, info, animated));
}

}  // namespace

void addInfo(CLI::App& app, Action& action) {
    auto command = std::make_shared<InfoCommand>();
    CLI::App& verb = addVerb(
        app, command->common, "info",
        "Show the contents and origin of colliders and worlds\n\n"
        "It lists the maps with their formats and sizes, the bounds, the source mesh, and the options of the "
        "bake.",
        "relief info bunny.relief\n"
        "relief info *.relief\n"
        "relief info level/world.json\n"
        "relief info bunny.relief --json | jq .maps[0].object_to_map");
    addOption(verb, "FILE", command->files,
              "Colliders or world.json files; - for a collider on standard input")
        ->typeName("")
        ->required();
    addMemoryOption(verb, command->limits);
    addFlag(verb, "--json", command->json, "Print the report as JSON");
    groupVerbOptions(verb, {{"Output", {"--json"}}});
    setAction(verb, action, [command](FileGuard&) {
        return forEachFile(command->files, [&](const std::string& file) { return runInfo(*command, file); });
    });
}

}  // namespace relief
