// relief info: what is in a container.
#include <CLI/CLI.hpp>

#include "bake/cli/command.h"
#include "bake/report/report.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "runtime/tool/command_line.h"

namespace relief {
namespace {

struct InfoCommand {
    CommonOptions common;
    std::string file;
    bool json = false;
};

std::string rowText(const glm::vec4& row) {
    return shortest(row.x) + " " + shortest(row.y) + " " + shortest(row.z) + " " + shortest(row.w);
}

std::string vectorText(const glm::vec3& v) {
    return "(" + shortest(v.x) + ", " + shortest(v.y) + ", " + shortest(v.z) + ")";
}

std::string humanReport(const Collider& collider, const ContainerInfo& info) {
    const Provenance& from = collider.provenance;
    std::string text = "Relief container " + std::to_string(info.major) + "." + std::to_string(info.minor) +
                       ", " + bytesText(info.file_size) + "\n";
    text += "bounds   " + vectorText(collider.bounds.min) + " to " + vectorText(collider.bounds.max) +
            (collider.unit.empty() ? " object units" : " " + collider.unit) + "\n";
    text += "mesh     " + from.mesh_name + ", " + std::to_string(from.triangles) + " triangles, XXH3-128 " +
            (from.mesh_hash.empty() ? "unknown" : from.mesh_hash) + "\n";
    text += "baked    by " + from.tool_version + " with " + from.options + "\n";
    std::vector<std::vector<std::string>> rows = {
        {"map", "format", "projection", "keeps", "size>", "bytes>", "stored>", "encloses", "empty is"}};
    for (std::size_t i = 0; i < collider.maps.size(); ++i) {
        const DepthMap& map = collider.maps[i];
        const std::string size = std::to_string(map.width) + "x" + std::to_string(map.height);
        rows.push_back({std::to_string(i), mapFormatName(map.format),
                        map.projection() == Projection::kCube ? "cube" : "orthographic",
                        compareName(map.compare), map.faceCount() == 1 ? size : "6x" + size,
                        bytesText(info.payloads[i].raw_size),
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

Result<void> runInfo(const InfoCommand& command) {
    startLogging(command.common);
    const std::vector<std::byte> bytes = RELIEF_TRY(readFile(command.file));
    const auto named = [&](const Error& error) {
        return fail(error.code, shownInput(command.file) + ": " + error.message);
    };
    // The whole container is checked, payloads too: what info shows can be relied on.
    const Result<Collider> collider = readContainer(bytes);
    if (!collider) {
        return named(collider.error());
    }
    const Result<ContainerInfo> info = readContainerInfo(bytes);
    if (!info) {
        return named(info.error());
    }
    return printOut(command.json ? colliderJson(*collider, *info) : humanReport(*collider, *info));
}

}  // namespace

void addInfo(CLI::App& app, Action& action) {
    auto command = std::make_shared<InfoCommand>();
    CLI::App& verb =
        addVerb(app, command->common, "info", "Shows what is in a collider, and where it comes from",
                "relief info bunny.relief\n"
                "relief info bunny.relief --json | jq .maps[0].object_to_map");
    verb.add_option("FILE", command->file, "The collider; - for standard input")->type_name("")->required();
    verb.add_flag("--json", command->json, "Print JSON");
    verb.callback([command, &action] { action = [command] { return runInfo(*command); }; });
}

}  // namespace relief
