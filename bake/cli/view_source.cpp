#include "bake/cli/view_source.h"

#include <algorithm>
#include <cstdlib>
#include <glm/geometric.hpp>

#include "bake/cli/command.h"
#include "bake/cli/mesh_options.h"
#include "bake/director/mesh_check_report.h"
#include "bake/import/mesh_import.h"
#include "bake/pipeline/bake.h"
#include "bake/repair/winding.h"
#include "bake/report/parts_report.h"
#include "bake/view/view_page.h"
#include "formats/bake_first.h"
#include "formats/base/error_context.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/container.h"
#include "formats/fields/json.h"
#include "runtime/scene/loaded_scene.h"
#include "runtime/scene/scene_pictures.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

std::string textOf(const std::vector<std::byte>& bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// The template, and what is put in.
struct Page {
    ViewPageInput input;
    std::vector<std::byte> container;
    std::vector<fs::path> files;

    /// Reads a file that the page depends on.
    Result<std::vector<std::byte>> read(const fs::path& path) {
        files.push_back(path);
        return readFile(path, kViewBytesMax);
    }

    Result<MadePage> make() {
        const fs::path page = RELIEF_TRY(findViewPage());
        const std::string text = textOf(RELIEF_TRY(read(page)));
        input.container = container;
        std::string html = RELIEF_TRY(viewPage(text, quotedPath(page), input));
        std::sort(files.begin(), files.end());
        return MadePage{std::move(html), std::move(files)};
    }
};

/// The report, and what the page needs to show it.
Result<MadePage> checkPage(Page page, const MeshCheck& check, std::optional<float> max_error) {
    Json report = jsonOf(MeshCheckReport{check, page.input.name, max_error});
    report.erase("times_ms");  // no two runs have the same
    report["verdict"]["text"] = verdictText(check.wrongPercent(), check.part_accuracy);
    report["parts"]["text"] = partsText(check.part_accuracy, check.parts, check.collider);
    for (std::size_t i = 0; i < check.places.size(); ++i) {
        const ClosestPoint closest = check.query->closest(check.places[i].position);
        const glm::dvec3 normal = planeOf(check.query->mesh(), closest.triangle).normal;
        report["worst_places"][i]["normal"] = jsonOf(glm::vec3(glm::normalize(normal)));
    }
    page.input.mesh = &*check.imported;
    page.input.check = &report;
    return page.make();
}

Result<MadePage> colliderPage(const ViewSource& source, Page page) {
    page.container = RELIEF_TRY(page.read(source.file));
    RELIEF_TRY(refuseMesh(source.file, page.container));
    Collider collider =
        RELIEF_TRY(inFront(shownInput(source.file), readContainer(page.container, source.limits)));
    if (source.check.mesh.empty()) {
        return page.make();
    }
    const MeshCheck check = RELIEF_TRY(relief::check(source.check, std::move(collider)));
    showCheckWarnings(check);
    for (const std::string& file : check.imported->dependencies) {
        page.files.emplace_back(file);
    }
    return checkPage(std::move(page), check, {});
}

/// A body that deforms has no container: its mesh at rest, baked, to look at.
/// \param files  gets those that the mesh refers to.
Result<std::vector<std::byte>> bakedAtRest(const SceneCollider& live, std::vector<fs::path>& files) {
    TriangleMesh mesh = RELIEF_TRY(importMeshInWorker(live.path, {}, {}));
    files.insert(files.end(), mesh.dependencies.begin(), mesh.dependencies.end());
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
Result<void> chooseShown(const Scene& scene, const fs::path& file, Page& page) {
    for (const SceneCollider& collider : scene.colliders) {
        if (!collider.live) {
            page.input.shows = nameInScene(collider.path, file);
            return {};
        }
    }
    page.container = RELIEF_TRY(bakedAtRest(scene.colliders.front(), page.files));
    return {};
}

Result<MadePage> scenePage(const ViewSource& source, Page page) {
    const fs::path file = source.file;
    page.input.scene = textOf(RELIEF_TRY(page.read(file)));
    SceneOverrides overrides;
    overrides.limits = source.limits;
    const LoadedScene loaded = RELIEF_TRY(loadAll(file, overrides));
    RELIEF_TRY(checkPictures(loaded.scene, loaded.bounds));
    if (loaded.scene.flow) {
        return fail(ErrorCode::kUnsupported,
                    quotedPath(file) +
                        " has a [flow], which browsers do not read; take relief-sim, or "
                        "leave it out");
    }
    for (const fs::path& named : filesOf(loaded.scene)) {
        page.input.files[nameInScene(named, file)] = RELIEF_TRY(page.read(named));
    }
    RELIEF_TRY(chooseShown(loaded.scene, file, page));
    return page.make();
}

}  // namespace

bool ViewSource::isScene() const {
    return lowerCase(fs::path(file).extension().native()) == ".toml";
}

Result<fs::path> findViewPage() {
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
                "there is no page to put a collider in; run scripts/build.sh web in the sources once, which "
                "makes it, or name one with RELIEF_VIEW_PAGE");
}

Result<MadePage> makeViewPage(const ViewSource& source) {
    Page page;
    page.input.name = inputName(source.file);
    page.input.events = source.events;
    return source.isScene() ? scenePage(source, std::move(page)) : colliderPage(source, std::move(page));
}

Result<std::string> makeCheckPage(const std::string& name, std::vector<std::byte> container,
                                  const MeshCheck& check, std::optional<float> max_error) {
    Page page;
    page.input.name = name;
    page.container = std::move(container);
    MadePage made = RELIEF_TRY(checkPage(std::move(page), check, max_error));
    return std::move(made.html);
}

}  // namespace relief
