// SPDX-License-Identifier: Apache-2.0
#include "bake/import/level_folder.h"

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "bake/import/import_format.h"
#include "bake/import/mesh_import.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/validate.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

/// Returns the mesh files of a folder, sorted by name.
Result<std::vector<fs::path>> meshFilesOf(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        const std::string extension = entry->path().extension().string();
        std::error_code unknown;
        if (!extension.empty() && meshFormat(extension.substr(1)) != nullptr &&
            entry->is_regular_file(unknown)) {
            files.push_back(entry->path());
        }
    }
    if (error) {
        return fail(ErrorCode::kIo, "cannot read the folder " + quotedPath(folder) + ": " + error.message() +
                                        "; check its permissions");
    }
    if (files.empty()) {
        return invalidInput(quotedPath(folder) +
                            " contains no mesh files; give a folder of OBJ, PLY or glTF files");
    }
    if (files.size() > kLevelMeshesMax) {
        return fail(ErrorCode::kLimit, quotedPath(folder) + " has " + std::to_string(files.size()) +
                                           " mesh files, more than " + std::to_string(kLevelMeshesMax) +
                                           "; bake it in parts");
    }
    std::sort(files.begin(), files.end());
    return files;
}

void append(std::vector<std::string>& to, std::vector<std::string> more) {
    to.insert(to.end(), more.begin(), more.end());
}

Result<Level> importFolder(const fs::path& folder, const ImportOptions& options, ImportLimits limits) {
    if (!options.names.empty()) {
        return fail(ErrorCode::kUsage, "--as NAME=KIND applies to names in one file, but " +
                                           quotedPath(folder) + " is a folder; leave out NAME=");
    }
    Level level;
    level.name = cleanUtf8(fs::path(folder / ".").parent_path().filename().string(), kMeshNameMax);
    LevelMeshes meshes;
    for (const fs::path& file : RELIEF_TRY(meshFilesOf(folder))) {
        TriangleMesh mesh = RELIEF_TRY(importMeshInWorker(file, options, limits));
        limits.triangles -= std::min(limits.triangles - 1, std::uint64_t{mesh.triangles.size()});
        if (!level.bodies.empty() && mesh.unit != level.unit) {
            return invalidInput(quotedPath(file) + (mesh.unit.empty() ? " has no unit" : " has a unit") +
                                ", unlike earlier files; give --unit");
        }
        level.unit = mesh.unit;
        append(level.dependencies, std::exchange(mesh.dependencies, {}));
        append(level.dependency_hashes, std::exchange(mesh.dependency_hashes, {}));
        append(level.warnings, std::exchange(mesh.warnings, {}));
        LevelBody body;
        body.node = mesh.name;
        mesh.name = cleanUtf8(file.stem().string(), kMeshNameMax);
        body.mesh = meshes.add(std::move(mesh), options.materials);
        level.bodies.push_back(std::move(body));
    }
    level.meshes = meshes.take();
    return level;
}

}  // namespace

Result<Level> importLevel(const fs::path& path, const ImportOptions& options, const ImportLimits& limits) {
    std::error_code error;
    return fs::is_directory(path, error) ? importFolder(path, options, limits)
                                         : importLevelInWorker(path, options, limits);
}

}  // namespace relief
