// SPDX-License-Identifier: Apache-2.0
// relief view: a page to turn a collider round in and see where it is wrong, or to play a scene in.
#include "bake/cli/command_view.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <map>
#include <span>

#include "bake/cli/command.h"
#include "bake/cli/view_page.h"
#include "bake/director/mesh_check_report.h"
#include "bake/import/mesh_import.h"
#include "bake/pipeline/bake.h"
#include "bake/repair/winding.h"
#include "bake/report/parts_report.h"
#include "bake/report/report_text.h"
#include "formats/base/file_io.h"
#include "formats/base/result.h"
#include "formats/base/text.h"
#include "formats/container.h"
#include "formats/fields/json_value.h"
#include "formats/world/collider_info.h"
#include "runtime/command_line/command_line.h"
#include "runtime/command_line/option_values.h"
#include "runtime/gl/gl_object.h"
#include "runtime/layout/gpu_image.h"
#include "runtime/scene/loaded_scene.h"
#include "runtime/scene/scene_meshes.h"
#include "runtime/scene/scene_pictures.h"
#include "runtime/scene/scene_world.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

struct ViewCommand {
    CommonOptions common;
    std::string file;        ///< a container, "-" for standard input, a scene (.toml) or a world (.json)
    CheckRequest check;      ///< mesh empty: none
    ContainerLimits limits;  ///< of the container, or of those of a scene
    std::string output;

    [[nodiscard]] bool isScene() const {
        return namesWorld(file) || lowerCase(fs::path(file).extension().native()) == ".toml";
    }
};

std::string textOf(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The page of scenes: what RELIEF_VIEW_PAGE names, else that of an installed tool, or of a build beside this one.
/// Errors: kUnsupported (there is none).
Result<fs::path> findPlayer() {
    if (const char* named = std::getenv("RELIEF_VIEW_PAGE"); named != nullptr && *named != '\0') {
        return fs::path(named);
    }
    std::error_code error;
    const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
    for (const char* place : {"../share/relief/view.html", "../../web/bin/view.html"}) {
        const fs::path page = folder / place;
        if (fs::is_regular_file(page, error)) {
            return page;
        }
    }
    return fail(ErrorCode::kUnsupported,
                "the page of a scene or a world plays particles, which needs the player of browsers; run "
                "scripts/build.sh web in the sources once, name a player with RELIEF_VIEW_PAGE, or view one "
                "collider");
}

/// The place for data in a page, and the format of that data. The player of another release may expect another format.
struct DataPlace {
    std::string text;
    std::uint64_t format;
};

const DataPlace& dataPlace() {
    static const DataPlace place = [] {
        const std::string page = viewPage();
        const auto between = [&](std::string_view first, std::string_view last) {
            const std::size_t at = page.find(first);
            return page.substr(at, page.find(last, at + first.size()) - at);
        };
        constexpr std::string_view kFormat = "data-format=\"";
        return DataPlace{between("<script type=\"application/json\"", "\n"),
                         parseUnsigned(between(kFormat, "\"").substr(kFormat.size())).value()};
    }();
    return place;
}
constexpr std::string_view kEmpty = "null";

// Vertices and corners go as they lie in memory.
static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(glm::vec3) == 12 && sizeof(glm::uvec3) == 12);

/// RFC 4648, with padding and without line ends.
std::string base64(std::span<const std::byte> bytes) {
    constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t j = 0; j < 3; ++j) {
            group = group << 8 | (j < count ? std::to_integer<std::uint32_t>(bytes[i + j]) : 0U);
        }
        for (std::size_t j = 0; j < 4; ++j) {
            text += j <= count ? kDigits[group >> (18 - 6 * j) & 63U] : '=';
        }
    }
    return text;
}

/// Ready to stand between <script> and </script>: whatever a name says, it ends nothing there.
std::string scriptText(const Json& json) {
    const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    std::string safe;
    safe.reserve(text.size());
    for (const char c : text) {
        if (c == '<') {
            safe += "\\u003c";
        } else {
            safe += c;
        }
    }
    return safe;
}

/// Bytes of everything that one page holds, before they become text: more, and browsers give up.
constexpr std::uint64_t kViewBytesMax = std::uint64_t{128} << 20;

/// A collider as a page draws it: what `relief export --gpu` writes, and facts.
Result<Json> colliderJson(const Collider& collider) {
    const GpuImage image = RELIEF_TRY(gpuImage(collider));
    const std::string core = RELIEF_TRY(shaderText("collider/collider.glsl"));
    Json textures = Json::array();
    for (const TexelKind kind : {kFloatTexels, kFixedTexels, kFrontBackTexels}) {
        const GpuTexture& texture = image.textures[kind];
        textures.push_back(
            {{"width", texture.width},
             {"height", texture.height},
             {"texels", isUsed(collider, kind) ? Json(base64(texture.texels)) : Json(nullptr)}});
    }
    return Json{{"info", colliderInfo(collider)},
                {"animated", !collider.animation.empty()},
                {"glsl", std::string(kShaderLicence) + image.defines + core},
                {"block", base64(image.block)},
                {"textures", textures}};
}

/// The contents of a page.
struct Page {
    std::string name = {};               ///< without its folder
    std::size_t bytes = 0;               ///< of the collider's file; of a scene: 0
    const Collider* collider = nullptr;  ///< what is shown, of a page without a scene
    const TriangleMesh* mesh = nullptr;
    Json check = nullptr;                           ///< the report of `relief check`
    std::optional<std::string> scene = {};          ///< text of a scene.toml
    std::string shows = {};                         ///< which of `files` is in the panel; empty: `container`
    std::vector<std::byte> container = {};          ///< of the collider in the panel
    std::map<std::string, std::string> files = {};  ///< that the scene names, by the names it has for them

    /// \param page  with a place for data.
    [[nodiscard]] Result<std::string> make(const std::string& page) const {
        RELIEF_TRY(checkSize());
        const std::string& place = dataPlace().text;
        const std::size_t data = page.find(place) + place.find(kEmpty);
        return page.substr(0, data) + scriptText(RELIEF_TRY(json())) + page.substr(data + kEmpty.size());
    }

  private:
    [[nodiscard]] Result<void> checkSize() const {
        std::uint64_t rest = container.size() + (scene ? scene->size() : 0) +
                             (collider != nullptr ? collider->texelBytes() : 0);
        for (const auto& [name_in_scene, file] : files) {
            rest += file.size();
        }
        const std::uint64_t of_mesh =
            mesh == nullptr ? 0 : std::uint64_t{12} * (mesh->positions.size() + mesh->triangles.size());
        if (rest + of_mesh <= kViewBytesMax) {
            return {};
        }
        const std::string limit = "; a page holds " + bytesText(kViewBytesMax);
        if (rest <= kViewBytesMax) {
            return fail(ErrorCode::kLimit,
                        mesh->name + " has " + std::to_string(mesh->triangles.size()) + " triangles, " +
                            bytesText(of_mesh) + limit +
                            "; leave out the page or the mesh, or give it with fewer triangles");
        }
        return fail(ErrorCode::kLimit, name + " has " + bytesText(rest) + limit +
                                           "; bake with a smaller --budget, or smaller maps");
    }

    [[nodiscard]] Result<Json> json() const {
        Json shown = nullptr;
        if (collider != nullptr) {
            shown = RELIEF_TRY(inFront(name, colliderJson(*collider)));
        } else if (shows.empty()) {
            shown = base64(container);
        }
        Json all = {{"format", dataPlace().format},
                    {"name", name},
                    {"bytes", bytes},
                    {"collider", shown},
                    {"shows", shows.empty() ? Json(nullptr) : Json(shows)},
                    {"mesh", nullptr},
                    {"check", check},
                    {"scene", scene ? Json(*scene) : Json(nullptr)},
                    {"files", scene ? Json::object() : Json(nullptr)}};
        if (mesh != nullptr) {
            all["mesh"] = {{"name", mesh->name},
                           {"vertices", base64(std::as_bytes(std::span(mesh->positions)))},
                           {"triangles", base64(std::as_bytes(std::span(mesh->triangles)))}};
        }
        for (const auto& [name_in_scene, file] : files) {
            all["files"][name_in_scene] = base64(std::as_bytes(std::span(file)));
        }
        return all;
    }
};

/// Reads a file that the page depends on.
Result<std::vector<std::byte>> readFor(FileGuard& files, const fs::path& path) {
    RELIEF_TRY(files.reads(path));
    return readFile(path, kViewBytesMax);
}

/// The page that plays scenes, without data.
Result<std::string> playerPage(FileGuard& files) {
    const fs::path file = RELIEF_TRY(findPlayer());
    std::string text = textOf(RELIEF_TRY(readFor(files, file)));
    const std::string& place = dataPlace().text;
    const std::size_t at = text.find(place);
    if (at == std::string::npos || text.find(place, at + 1) != std::string::npos) {
        return invalidInput(quotedPath(file) +
                            " is the page of another release; run scripts/build.sh web again");
    }
    return text;
}

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
    page.mesh = &*check.imported;
    page.check = std::move(report);
    return page.make(viewPage());
}

Result<std::string> colliderPage(const ViewCommand& command, FileGuard& files) {
    const std::vector<std::byte> container = RELIEF_TRY(readFor(files, command.file));
    RELIEF_TRY(refuseMesh(command.file, container));
    Collider collider =
        RELIEF_TRY(inFront(shownInput(command.file), readContainer(container, command.limits)));
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

/// A body that deforms has no container: its mesh at rest, baked, to look at.
/// \param files  gets those that the mesh refers to.
Result<std::vector<std::byte>> bakedAtRest(const SceneCollider& live, FileGuard& files) {
    TriangleMesh mesh = RELIEF_TRY(importMeshInWorker(live.path, {}, {}));
    for (const std::string& file : mesh.dependencies) {
        RELIEF_TRY(files.reads(file));
    }
    const Winding winding = RELIEF_TRY(windOutwards(std::move(mesh)));
    BakeOptions options;
    options.resolution = live.resolution;
    const Baked baked = RELIEF_TRY(bake(winding.mesh, options));
    return writeContainer(baked.collider, {9});
}

/// Of a file that a scene names, as the scene names it.
std::string nameInScene(const fs::path& file, const fs::path& scene) {
    return file.lexically_normal().lexically_relative(scene.parent_path().lexically_normal());
}

/// The first collider that has texels, else the first.
Result<void> chooseShown(const Scene& scene, const fs::path& file, Page& page, FileGuard& files) {
    for (const SceneCollider& collider : scene.colliders) {
        if (!collider.live) {
            page.shows = nameInScene(collider.path, file);
            return {};
        }
    }
    page.container = RELIEF_TRY(bakedAtRest(scene.colliders.front(), files));
    return {};
}

/// \param check  of a world; null: none.
Result<std::string> scenePage(const std::string& name, const ContainerLimits& limits, const Json& check,
                              const std::string& player, FileGuard& files) {
    Page page{.name = inputName(name), .check = check};
    const fs::path file = name;
    // The default scene of a world: a string of JSON is one of TOML.
    page.scene = namesWorld(name) ? "world = " + jsonOf(file.filename()).dump() + "\n"
                                  : textOf(RELIEF_TRY(readFor(files, file)));
    SceneOverrides overrides;
    overrides.limits = limits;
    const LoadedScene loaded = RELIEF_TRY(loadAll(file, overrides));
    for (const std::string& warning : loaded.warnings) {
        spdlog::warn(warning);
    }
    RELIEF_TRY(checkPictures(loaded.scene, loaded.bounds));
    if (loaded.scene.flow) {
        return fail(ErrorCode::kUnsupported,
                    quotedPath(file) +
                        " has a [flow], which browsers do not read; take relief-sim, or "
                        "leave it out");
    }
    for (const fs::path& file_of_scene : allFilesOf(loaded)) {
        RELIEF_TRY(files.reads(file_of_scene));
    }
    for (const fs::path& named : filesOf(loaded.scene)) {
        page.files[nameInScene(named, file)] = textOf(RELIEF_TRY(readFor(files, named)));
    }
    for (const WorldCollider& collider : loaded.world.colliders) {
        if (loaded.scene.stream && collider.coarse) {
            const fs::path coarse = containerOf(loaded.scene, *collider.coarse);
            page.files[nameInScene(coarse, file)] = textOf(RELIEF_TRY(readFor(files, coarse)));
        }
    }
    if (!loaded.scene.render.meshes.empty()) {
        RELIEF_TRY(loadDrawnMeshes(loaded));  // what cannot be read is told here, not on the page
        for (const fs::path& drawn : RELIEF_TRY(drawnFiles(loaded))) {
            page.files[nameInScene(drawn, file)] = textOf(RELIEF_TRY(readFor(files, drawn)));
        }
    }
    RELIEF_TRY(chooseShown(loaded.scene, file, page, files));
    return page.make(player);
}

/// The report, and what the page needs to show it.
Result<Json> worldCheckJson(const WorldCheckJson& check) {
    Json report = jsonOf(check);
    Json& accuracy = report["accuracy"];
    accuracy.erase("seconds");  // no two runs have the same
    for (std::size_t i = 0; i < check.accuracy->places.size(); ++i) {
        const std::vector<std::byte> picture =
            RELIEF_TRY(drawMistakes(*check.accuracy->places[i].slice, check.field->world().unit));
        accuracy["places"][i]["picture"] = base64(picture);
    }
    return report;
}

Result<std::string> worldPage(const ViewCommand& command, FileGuard& files) {
    const std::string player = RELIEF_TRY(playerPage(files));
    const WorldField field(RELIEF_TRY(loadWorld(command.file, command.limits)));
    const WorldAccuracy accuracy = RELIEF_TRY(checkWorld({command.check, {}, true}, field));
    for (const std::string& warning : accuracy.warnings) {
        spdlog::warn(warning);
    }
    return makeWorldPage(command.file, command.limits, {inputName(command.file), &field, &accuracy, {}},
                         player, files);
}

Result<std::string> scenePage(const ViewCommand& command, FileGuard& files) {
    return scenePage(command.file, command.limits, nullptr, RELIEF_TRY(playerPage(files)), files);
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

/// The same input gives the same bytes. Files are checked as `relief check` and `relief-sim` do.
Result<void> runView(const ViewCommand& command, FileGuard& files) {
    const bool measured = !command.check.mesh.empty();
    if (measured && command.isScene() && !namesWorld(command.file)) {
        return fail(ErrorCode::kUsage, "--mesh is for a collider or a world, and " +
                                           quotedPath(command.file) +
                                           " is a scene; leave out --mesh, or view what it names");
    }
    if (measured && namesWorld(command.file) && command.check.detail) {
        return fail(ErrorCode::kUsage, "--detail is for one collider; leave it out for a world");
    }
    const std::string output = RELIEF_TRY(outputOf(command));
    RELIEF_TRY(files.reads(command.file));
    RELIEF_TRY(files.reads(command.check.mesh));
    RELIEF_TRY(files.writes(output, "-o"));
    const std::string html = RELIEF_TRY(measured && namesWorld(command.file) ? worldPage(command, files)
                                        : command.isScene()                  ? scenePage(command, files)
                                                                             : colliderPage(command, files));
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

Result<std::string> makeWorldPage(const std::string& file, const ContainerLimits& limits,
                                  const WorldCheckJson& check, const std::string& player, FileGuard& files) {
    for (const std::string& named : check.accuracy->dependencies) {
        RELIEF_TRY(files.reads(named));
    }
    return scenePage(file, limits, RELIEF_TRY(worldCheckJson(check)), player, files);
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
        "Makes a page to look at a collider, or to play a scene\n\nOne HTML file that holds everything and "
        "opens from disk in any browser with WebGL2: the surface as the maps see it,\nevery map, and slices. "
        "With --mesh also the mesh, the errors on it and the worst places of `relief check`.\n"
        "Of a scene or a world: its particles, as relief-sim plays them; of a world each body's name, and "
        "with "
        "--mesh,\nthe level, the bodies coloured by what is wrong near them, and pictures of the ten worst. "
        "Such a page\nneeds the player that `scripts/build.sh web` builds once.",
        "relief view bunny.relief\n"
        "relief view bunny.relief --mesh bunny.obj -o page.html\n"
        "relief view scene.toml\n"
        "relief view level/world.json --mesh level.glb");
    addOption(verb, "FILE", command->file,
              "The collider, a scene (.toml) or a world.json; - for a collider on standard input")
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
