// SPDX-License-Identifier: Apache-2.0
#include "bake/import/import_source.h"

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "bake/import/import_format.h"
#include "formats/animation/mesh_pose.h"
#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/base/text.h"
#include "formats/validate.h"

namespace relief {

ImportSource::ImportSource(std::filesystem::path path, std::string extension, std::vector<std::byte> bytes)
    : path_(std::move(path)),
      extension_(std::move(extension)),
      bytes_(std::move(bytes)),
      hash_(xxh3_128Hex(bytes_)) {
    const std::filesystem::path parent = path_.parent_path();
    folder_ = Descriptor(::open(parent.empty() ? "." : parent.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
}

Result<ImportSource> ImportSource::open(const std::filesystem::path& path) {
    std::vector<std::byte> bytes = RELIEF_TRY(readFile(path));
    const std::string extension = lowerCase(path.extension().string());
    if (extension.empty() || meshFormat(extension.substr(1)) == nullptr) {
        constexpr std::array<std::string_view, 5> kHeightMaps = {".png", ".exr", ".raw", ".r16", ".hgt"};
        const bool image = std::ranges::find(kHeightMaps, extension) != kHeightMaps.end();
        return fail(
            ErrorCode::kUnsupported,
            quotedPath(path) + ": no mesh format has the extension '" + cleanUtf8(extension) + "'; " +
                (image ? "if it is a height map, bake it with --heights" : "convert it to glTF, OBJ or PLY"));
    }
    if (bytes.empty()) {
        return invalidInput(quotedPath(path) + ": the file is empty; export the mesh again");
    }
    return ImportSource(path, extension.substr(1), std::move(bytes));
}

tl::unexpected<Error> ImportSource::invalidResult(const char* what) const {
    return invalidInput(quotedPath(path_) + ": the importer returned " + what + "; export the mesh again");
}

Result<TriangleMesh> ImportSource::finish(TriangleMesh raw, std::size_t names) const {
    if (!raw.level_meshes.empty() || !raw.level_bodies.empty()) {
        return invalidResult("a level that was not requested");
    }
    if (!raw.animation.empty()) {
        return invalidResult("an animation that was not requested");
    }
    return finishMesh(RELIEF_TRY(named(std::move(raw), names)));
}

Result<Level> ImportSource::finishLevel(TriangleMesh raw, std::size_t names, bool materials) const {
    if (!raw.animation.empty()) {
        return invalidResult("an animation that was not requested");
    }
    TriangleMesh all = RELIEF_TRY(named(std::move(raw), names));
    return withPrefix(quotedPath(path_), splitLevel(std::move(all), materials));
}

Result<AnimatedImport> ImportSource::finishAnimated(TriangleMesh raw, ImportKind kind) const {
    const bool clips = kind == ImportKind::kClips;
    Result<AnimatedMesh> mesh = clips ? readAnimatedClips(raw.animation) : readAnimatedMesh(raw.animation);
    if (!mesh) {
        return invalidResult("bytes that are not an animated mesh");
    }
    if (!raw.level_meshes.empty() || !raw.level_bodies.empty() || !raw.positions.empty() ||
        !raw.triangles.empty() || !raw.surface_names.empty()) {
        return invalidResult("more than an animated mesh");
    }
    raw.animation.clear();
    raw = RELIEF_TRY(named(std::move(raw), 0));
    if (!clips) {
        raw.positions = posed(*mesh, restPose(*mesh));
        raw.triangles = mesh->triangles;
        raw = RELIEF_TRY(finishMesh(std::move(raw)));
    }
    return AnimatedImport{std::move(*mesh), std::move(raw)};
}

Result<TriangleMesh> ImportSource::named(TriangleMesh raw, std::size_t names) const {
    if (!(raw.unit.empty() || raw.unit == "m") || raw.dependencies.size() != raw.dependency_hashes.size()) {
        return invalidResult("an invalid unit or list of files");
    }
    if (raw.marks.size() != (names > 0 ? raw.triangles.size() : 0) ||
        std::ranges::any_of(raw.marks, [&](std::uint8_t mark) { return mark > names; })) {
        return invalidResult("names that were not requested");
    }
    const std::string name = cleanUtf8(path_.filename().string(), kMeshNameMax);
    std::vector<std::pair<std::string, std::string>> files;  // path, hash
    for (std::size_t i = 0; i < raw.dependencies.size(); ++i) {
        const std::string& file = raw.dependencies[i];
        const std::filesystem::path relative(file);
        const bool beneath = !file.empty() && relative.is_relative() &&
                             std::find(relative.begin(), relative.end(), "..") == relative.end() &&
                             file.find('\0') == std::string::npos;
        if (!beneath || !isHash(raw.dependency_hashes[i])) {
            return invalidResult("a file that is not below the mesh's folder, or has no hash");
        }
        files.emplace_back((path_.parent_path() / relative).string(), raw.dependency_hashes[i]);
    }
    std::ranges::sort(files);
    raw.dependencies = {path_.string()};
    raw.dependency_hashes = {hash_};
    for (auto& [file, hash] : files) {
        raw.dependencies.push_back(std::move(file));
        raw.dependency_hashes.push_back(std::move(hash));
    }
    for (std::string& warning : raw.warnings) {
        warning = name + ": " + cleanUtf8(warning);
    }
    raw.name = name;
    raw.content_hash = hash_;
    return raw;
}

}  // namespace relief
