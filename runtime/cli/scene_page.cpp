// SPDX-License-Identifier: Apache-2.0
#include "runtime/cli/scene_page.h"

#include <algorithm>
#include <filesystem>
#include <span>

#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/container.h"
#include "runtime/page/page.h"
#include "runtime/scene/scene_meshes.h"
#include "runtime/scene/scene_pictures.h"
#include "runtime/scene/scene_world.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

/// Returns a container with empty maps for a deforming body, whose maps have texels only while the scene plays.
Result<std::vector<std::byte>> emptyMaps(const LiveMesh& live) {
    Collider collider = live.frames;
    for (DepthMap& map : collider.maps) {
        map.texels.resize(map.texelBytes());
    }
    return writeContainer(collider, {9});
}

/// Returns the files that the browser reads, without the scene itself.
Result<std::vector<fs::path>> filesForBrowser(const LoadedScene& loaded) {
    std::vector<fs::path> named = filesOf(loaded.scene);
    for (const WorldCollider& collider : loaded.world.colliders) {
        if (loaded.scene.stream && collider.coarse) {
            named.push_back(containerOf(loaded.scene, *collider.coarse));
        }
    }
    if (!loaded.scene.render.meshes.empty()) {
        RELIEF_TRY(loadDrawnMeshes(loaded));  // report errors here, not on the page
        const std::vector<fs::path> drawn = RELIEF_TRY(drawnFiles(loaded));
        named.insert(named.end(), drawn.begin(), drawn.end());
    }
    return named;
}

}  // namespace

Result<std::vector<std::string>> writeScenePage(PlayerOptions& options, const std::string& output) {
    const fs::path& file = options.input;
    FileGuard& guard = options.guard;
    if (lowerCase(file.extension().native()) != ".toml") {
        return fail(ErrorCode::kUsage, "--page needs a scene (.toml), not " + quotedPath(file) +
                                           "; for a collider or a world, use relief view");
    }
    RELIEF_TRY(guard.reads(file));
    RELIEF_TRY(guard.writes(output, "--page"));
    const std::string player = RELIEF_TRY(playerPage(guard));
    Page page{.name = cleanUtf8(file.filename().native())};
    page.scene = RELIEF_TRY(readForPage(guard, file));
    SceneOverrides overrides;
    overrides.limits = options.overrides.limits;
    LoadedScene loaded = RELIEF_TRY(loadAll(file, overrides));
    RELIEF_TRY(checkPictures(loaded.scene, loaded.bounds));
    if (loaded.scene.flow) {
        return fail(ErrorCode::kUnsupported,
                    quotedPath(file) +
                        " has a [flow], which pages do not support; run it without --page, or remove it");
    }
    for (const fs::path& protected_file : allFilesOf(loaded)) {
        RELIEF_TRY(guard.reads(protected_file));
    }
    for (const fs::path& named : RELIEF_TRY(filesForBrowser(loaded))) {
        page.files[relativeName(named, file)] = RELIEF_TRY(readForPage(guard, named));
    }
    const std::vector<SceneCollider>& colliders = loaded.scene.colliders;
    const auto shown = std::find_if(colliders.begin(), colliders.end(),
                                    [](const SceneCollider& collider) { return !collider.live; });
    if (shown != colliders.end()) {
        page.shows = relativeName(shown->path, file);
    } else {
        page.container = RELIEF_TRY(emptyMaps(*loaded.live.front()));
    }
    const std::string html = RELIEF_TRY(page.make(player));
    RELIEF_TRY(writeFile(output, std::as_bytes(std::span(html))));
    return std::move(loaded.warnings);
}

}  // namespace relief
