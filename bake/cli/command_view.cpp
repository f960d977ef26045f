// SPDX-License-Identifier: Apache-2.0
// relief view: makes a page that shows a collider and its errors, or a world.
#include "bake/cli/command_view.h"

#include <spdlog/spdlog.h>

#include <glm/geometric.hpp>
#include <span>

#include "bake/cli/command.h"
#include "bake/cli/option_details.h"
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
    std::string file;        ///< container, world (.json), or "-" for a container on standard input
    CheckRequest check;      ///< empty mesh: no check
    ContainerLimits limits;  ///< for the container, or each container of a world
    std::string output;
};

/// Returns the page of a check: the collider, the mesh, and the report with normals at the worst places.
Result<std::string> checkPage(Page page, const MeshCheck& check, std::optional<float> max_error) {
    Json report = jsonOf(MeshCheckReport{check, page.name, max_error});
    report.erase("times_ms");  // differs in each run
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
    RELIEF_TRY(rejectMesh(command.file, bytes));
    Collider collider = RELIEF_TRY(withPrefix(inputText(command.file), readContainer(bytes, command.limits)));
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

/// \param check  null: no check
Result<std::string> worldPage(const std::string& name, const World& world, const Json& check,
                              const std::string& player, FileGuard& files) {
    const fs::path file = name;
    // The default scene of a world. A JSON string is also a TOML string.
    Page page{
        .name = inputName(name), .check = check, .scene = "world = " + jsonOf(file.filename()).dump() + "\n"};
    const auto embed = [&](const fs::path& path) -> Result<void> {
        page.files[relativeName(path, file)] = RELIEF_TRY(readForPage(files, path));
        return {};
    };
    RELIEF_TRY(embed(file));
    for (const WorldCollider& collider : world.colliders) {
        RELIEF_TRY(embed(file.parent_path() / collider.file));
        if (collider.coarse) {
            RELIEF_TRY(files.reads(file.parent_path() / collider.coarse->file));
        }
    }
    page.shows = relativeName(file.parent_path() / world.colliders[world.bodies.front().collider].file, file);
    return page.make(player);
}

/// Returns the report, with a picture of each of the worst places.
Result<Json> worldCheckJson(const WorldCheckJson& check) {
    Json report = jsonOf(check);
    Json& accuracy = report["accuracy"];
    accuracy.erase("seconds");  // differs in each run
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
    logWarnings(accuracy.warnings);
    return makeWorldPage(command.file, {inputName(command.file), &field, &accuracy, {}}, player, files);
}

/// Writes the page; equal inputs give identical bytes. Validates files like `relief check`.
Result<void> runView(const ViewCommand& command, FileGuard& files) {
    const bool world = isWorldFile(command.file);
    const std::string beside = fs::path(command.file).replace_extension(".html").string();
    if (lowerCase(fs::path(command.file).extension().native()) == ".toml") {
        return fail(ErrorCode::kUsage, quotedPath(command.file) +
                                           " is a scene; make its page with relief-sim " +
                                           shellQuoted(command.file) + " --page " + shellQuoted(beside));
    }
    if (world && !command.check.mesh.empty() && command.check.min_part) {
        return fail(ErrorCode::kUsage, "--min-part has no effect on worlds; remove it");
    }
    if (command.output.empty() && command.file == "-") {
        return fail(ErrorCode::kUsage,
                    "a page made from standard input has no default name; add -o OUT.html");
    }
    const std::string& output = command.output.empty() ? beside : command.output;
    RELIEF_TRY(files.reads(command.file));
    RELIEF_TRY(files.reads(command.check.mesh));
    RELIEF_TRY(files.writes(output, "-o"));
    const std::string html = RELIEF_TRY(world ? worldPage(command, files) : colliderPage(command, files));
    return writeText(output, html);
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
    RELIEF_TRY(files.writes(html, "--page"));
    return isWorldFile(file) ? playerPage(files) : "";
}

Result<std::string> makeWorldPage(const std::string& file, const WorldCheckJson& check,
                                  const std::string& player, FileGuard& files) {
    for (const std::string& named : check.accuracy->dependencies) {
        RELIEF_TRY(files.reads(named));
    }
    return worldPage(file, check.field->world(), RELIEF_TRY(worldCheckJson(check)), player, files);
}

OptionRef addMeshOptions(CLI::App& verb, CheckRequest& request) {
    OptionRef mesh =
        addOption(verb, "--mesh", request.mesh, "Mesh or level that FILE was baked from")->valueText("MESH");
    const auto measurement = [&](FieldVisitor& visit) { measurementFields(visit, request); };
    for (const OptionRef option : addFields(verb, group(measurement))) {
        option->needs(mesh);
    }
    return mesh;
}

void showCheckWarnings(const MeshCheck& check) {
    logWarnings(check.warnings);
    spdlog::debug("truth {:.2f} s, field {:.2f} s", check.original.samples.seconds,
                  check.original.accuracy.field.seconds);
}

void addView(CLI::App& app, Action& action) {
    auto command = std::make_shared<ViewCommand>();
    CLI::App& verb = addVerb(
        app, command->common, "view",
        withDetails(
            "Make a web page that shows a collider or a world\n\n"
            "The page is a single HTML file that any browser with WebGL2 opens from disk. It shows the "
            "surface that the maps represent, each map, and slices. --mesh adds the mesh and the worst "
            "places of relief check.",
            "The page of a world shows falling snow and the name of each body. With --mesh, it also shows "
            "the level, bodies coloured by the errors near them, and slices through the ten worst places. It "
            "needs the player page that `scripts/build.sh web` builds.\n"
            "`relief-sim SCENE.toml --page OUT.html` writes the page of a scene."),
        "relief view bunny.relief\n"
        "relief view bunny.relief --mesh bunny.obj -o page.html\n"
        "relief view level/world.json --mesh level.glb");
    addOption(verb, "FILE", command->file, "Collider or world.json; - for a collider on standard input")
        ->typeName("")
        ->required();
    addMeshOptions(verb, command->check);
    addFields(verb, command->check.import);
    addFields(verb, command->check.import_limits);
    addMemoryOption(verb, command->limits);
    addOption(verb, "-o,--output", command->output,
              "Page to write; - for standard output (default: FILE with the extension .html)")
        ->valueText("OUT");
    groupVerbOptions(verb, {{"Output", {"--output"}},
                            {"Comparison with the mesh", {"--mesh", "--samples", "--seed", "--min-part"}}});
    setAction(verb, action, [command](FileGuard& files) { return runView(*command, files); });
}

}  // namespace relief
