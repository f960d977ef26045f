// SPDX-License-Identifier: Apache-2.0
// relief view: a page to turn a collider round in and see where it is wrong, or to fly through a world in.
#include "bake/cli/command_view.h"

#include <spdlog/spdlog.h>

#include <glm/geometric.hpp>
#include <span>

#include "bake/cli/command.h"
#include "bake/report/mesh_check_report.h"
#include "bake/verdict/parts_report.h"
#include "formats/base/file_io.h"
#include "formats/base/result.h"
#include "formats/base/text.h"
#include "formats/container.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/option_values.h"
#include "runtime/page/page.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

struct ViewCommand {
    CommonOptions common;
    std::string file;        ///< a container, "-" for standard input, or a world (.json)
    CheckRequest check;      ///< mesh empty: none
    ContainerLimits limits;  ///< of the container, or of those of a world
    std::string output;
};

/// The report, and what the page needs to show it.
Result<std::string> checkPage(Page page, const MeshCheck& check, std::optional<float> max_error) {
    Json report = jsonOf(MeshCheckReport{check, page.name, max_error});
    report.erase("times_ms");  // no two runs have the same
    report["parts"]["text"] = partsText(check.part_accuracy, check.parts, check.collider);
    for (std::size_t i = 0; i < check.places.size(); ++i) {
        const ClosestPoint closest = check.query->closest(check.places[i].position);
        const glm::dvec3 normal = planeOf(check.query->mesh(), closest.triangle).normal;
        report["worst_places"][i]["normal"] = jsonOf(glm::vec3(glm::normalize(normal)));
    }
    page.collider = &check.collider;
    const TriangleMesh& mesh = *check.imported;
    page.mesh = PageMesh{mesh.name, mesh.positions, mesh.triangles};
    page.check = std::move(report);
    return page.make(viewPage());
}

Result<std::string> colliderPage(const ViewCommand& command, FileGuard& files) {
    const std::string container = RELIEF_TRY(readForPage(files, command.file));
    const std::span<const std::byte> bytes = std::as_bytes(std::span(container));
    RELIEF_TRY(refuseMesh(command.file, bytes));
    Collider collider =
        RELIEF_TRY(withPrefix(shownInput(command.file), readContainer(bytes, command.limits)));
    Page page{.name = inputName(command.file), .bytes = container.size(), .collider = &collider};
    if (command.check.mesh.empty()) {
        return page.make(viewPage());
    }
    const MeshCheck check = RELIEF_TRY(relief::check(command.check, std::move(collider)));
    showCheckWarnings(check);
    for (const std::string& file : check.imported->dependencies) {
        RELIEF_TRY(files.reads(file));
    }
    return checkPage(std::move(page), check, {});
}

/// \param check  null: none.
Result<std::string> worldPage(const std::string& name, const World& world, const Json& check,
                              const std::string& player, FileGuard& files) {
    const fs::path file = name;
    // The default scene of a world: a string of JSON is one of TOML.
    Page page{
        .name = inputName(name), .check = check, .scene = "world = " + jsonOf(file.filename()).dump() + "\n"};
    const auto hold = [&](const fs::path& held) -> Result<void> {
        page.files[nameBeside(held, file)] = RELIEF_TRY(readForPage(files, held));
        return {};
    };
    RELIEF_TRY(hold(file));
    for (const WorldCollider& collider : world.colliders) {
        RELIEF_TRY(hold(file.parent_path() / collider.file));
        if (collider.coarse) {
            RELIEF_TRY(files.reads(file.parent_path() / collider.coarse->file));
        }
    }
    page.shows = nameBeside(file.parent_path() / world.colliders[world.bodies.front().collider].file, file);
    return page.make(player);
}

/// The report, and what the page needs to show it.
Result<Json> worldCheckJson(const WorldCheckJson& check) {
    Json report = jsonOf(check);
    Json& accuracy = report["accuracy"];
    accuracy.erase("seconds");  // no two runs have the same
    for (std::size_t i = 0; i < check.accuracy->places.size(); ++i) {
        const std::vector<std::byte> picture =
            RELIEF_TRY(drawVerdicts(*check.accuracy->places[i].slice, check.field->world().unit));
        accuracy["places"][i]["picture"] = base64(picture);
    }
    return report;
}

Result<std::string> worldPage(const ViewCommand& command, FileGuard& files) {
    const std::string player = RELIEF_TRY(playerPage(files));
    const WorldField field(RELIEF_TRY(loadWorld(command.file, command.limits)));
    if (command.check.mesh.empty()) {
        return worldPage(command.file, field.world(), nullptr, player, files);
    }
    const WorldAccuracy accuracy = RELIEF_TRY(checkWorld({command.check, {}, true}, field));
    for (const std::string& warning : accuracy.warnings) {
        spdlog::warn(warning);
    }
    return makeWorldPage(command.file, {inputName(command.file), &field, &accuracy, {}}, player, files);
}

/// Beside FILE unless -o names another place.
Result<std::string> outputOf(const ViewCommand& command) {
    if (!command.output.empty()) {
        return command.output;
    }
    if (command.file == "-") {
        return fail(ErrorCode::kUsage,
                    "a page of standard input has no name of its own; give it one with -o");
    }
    return fs::path(command.file).replace_extension(".html").string();
}

/// The same input gives the same bytes. Files are checked as `relief check` does.
Result<void> runView(const ViewCommand& command, FileGuard& files) {
    const bool world = namesWorld(command.file);
    if (lowerCase(fs::path(command.file).extension().native()) == ".toml") {
        return fail(ErrorCode::kUsage,
                    quotedPath(command.file) + " is a scene, whose page relief-sim writes: relief-sim " +
                        shellQuoted(command.file) + " --page " +
                        shellQuoted(fs::path(command.file).replace_extension(".html").string()));
    }
    if (world && !command.check.mesh.empty() && command.check.detail) {
        return fail(ErrorCode::kUsage, "--detail is for one collider; leave it out for a world");
    }
    const std::string output = RELIEF_TRY(outputOf(command));
    RELIEF_TRY(files.reads(command.file));
    RELIEF_TRY(files.reads(command.check.mesh));
    RELIEF_TRY(files.writes(output, "-o"));
    const std::string html = RELIEF_TRY(world ? worldPage(command, files) : colliderPage(command, files));
    return writeFile(output, std::as_bytes(std::span(html)));
}

}  // namespace

Result<std::string> makeCheckPage(const std::string& name, std::size_t bytes, const MeshCheck& check,
                                  std::optional<float> max_error) {
    return checkPage({.name = name, .bytes = bytes}, check, max_error);
}

Result<std::string> preflightPage(const std::string& file, const std::string& mesh, const std::string& html,
                                  FileGuard& files) {
    if (html.empty()) {
        return "";
    }
    RELIEF_TRY(files.reads(file));
    RELIEF_TRY(files.reads(mesh));
    RELIEF_TRY(files.writes("-", "the report"));
    RELIEF_TRY(files.writes(html, "--html"));
    return namesWorld(file) ? playerPage(files) : "";
}

Result<std::string> makeWorldPage(const std::string& file, const WorldCheckJson& check,
                                  const std::string& player, FileGuard& files) {
    for (const std::string& named : check.accuracy->dependencies) {
        RELIEF_TRY(files.reads(named));
    }
    return worldPage(file, check.field->world(), RELIEF_TRY(worldCheckJson(check)), player, files);
}

OptionRef addMeshOptions(CLI::App& verb, CheckRequest& request) {
    OptionRef mesh = addOption(verb, "--mesh", request.mesh, "The mesh or the level that it was baked from")
                         ->valueText("MESH");
    const auto measurement = [&](FieldVisitor& visit) { measurementFields(visit, request); };
    for (const OptionRef option : addFields(verb, group(measurement))) {
        option->needs(mesh);
    }
    return mesh;
}

void showCheckWarnings(const MeshCheck& check) {
    for (const std::string& warning : check.warnings) {
        spdlog::warn(warning);
    }
    spdlog::debug("truth {:.2f} s, field {:.2f} s", check.original.samples.seconds,
                  check.original.accuracy.field.seconds);
}

void addView(CLI::App& app, Action& action) {
    auto command = std::make_shared<ViewCommand>();
    CLI::App& verb = addVerb(
        app, command->common, "view",
        "Makes a page to look at a collider or a world\n\nOne HTML file that holds everything and "
        "opens from disk in any browser with WebGL2: the surface as the maps see it,\nevery map, and slices. "
        "With --mesh also the mesh, the errors on it and the worst places of `relief check`.\n"
        "Of a world: snow on it, each body's name, and with --mesh, the level, the bodies coloured by what "
        "is "
        "wrong near\nthem, and pictures of the ten worst. Such a page needs the player that "
        "`scripts/build.sh web` builds once.\n"
        "The page of a scene is written by relief-sim SCENE.toml --page OUT.html.",
        "relief view bunny.relief\n"
        "relief view bunny.relief --mesh bunny.obj -o page.html\n"
        "relief view level/world.json --mesh level.glb");
    addOption(verb, "FILE", command->file, "The collider or a world.json; - for a collider on standard input")
        ->typeName("")
        ->required();
    addMeshOptions(verb, command->check);
    addFields(verb, command->check.import);
    addFields(verb, command->check.import_limits);
    addMemoryOption(verb, command->limits);
    addOption(verb, "-o,--output", command->output,
              "The page; - for standard output; default FILE with .html in place of its extension")
        ->valueText("OUT");
    onVerb(verb,
           [command, &action] { action = [command](FileGuard& files) { return runView(*command, files); }; });
}

}  // namespace relief
