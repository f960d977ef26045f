// relief export: every map as OpenEXR.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>

#include "bake/cli/command.h"
#include "bake/cli/preflight.h"
#include "bake/picture/map_image.h"
#include "formats/base/file_io.h"
#include "formats/container.h"

namespace relief {
namespace {

struct ExportCommand {
    CommonOptions common;
    std::string file;
    std::string output;
};

Result<void> runExport(const ExportCommand& command) {
    startLogging(command.common);
    const Collider collider = RELIEF_TRY(loadCollider(command.file));
    const std::filesystem::path folder = command.output;
    RELIEF_TRY(preflightFolder(folder));
    std::size_t count = 0;
    for (std::size_t i = 0; i < collider.maps.size(); ++i) {
        const DepthMap& map = collider.maps[i];
        for (std::uint32_t face = 0; face < map.faceCount(); ++face) {
            const std::filesystem::path path = folder / mapImageName(map, i, face);
            const std::vector<std::byte> bytes = RELIEF_TRY(encodeExr(mapImage(map, face, collider.unit)));
            RELIEF_TRY(writeFile(path, bytes));
            spdlog::debug("wrote {}", quotedPath(path));
            ++count;
        }
    }
    spdlog::info("wrote {} images into {}", count, quotedPath(folder));
    return {};
}

}  // namespace

void addExport(CLI::App& app, Action& action) {
    auto command = std::make_shared<ExportCommand>();
    CLI::App& verb =
        addVerb(app, command->common, "export",
                "Writes every map as OpenEXR\n\nFiles are map0_front-back.exr, and map3_cube_+x.exr to "
                "map3_cube_-z.exr for the "
                "six faces\nof a cube. Channels Z and N.X N.Y N.Z, and ZBack and NBack.X NBack.Y NBack.Z of "
                "front-back maps;\nZ is in object units from the near plane or the cube's centre, +inf where "
                "there is no surface",
                "relief export bunny.relief -o maps/");
    verb.add_option("FILE", command->file, "The collider; - for standard input")->type_name("")->required();
    verb.add_option("-o,--output", command->output, "The folder; made if it is missing")
        ->option_text("DIR")
        ->required();
    verb.callback([command, &action] { action = [command] { return runExport(*command); }; });
}

}  // namespace relief
