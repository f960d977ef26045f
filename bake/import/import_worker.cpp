// SPDX-License-Identifier: Apache-2.0
// Implements importMeshInWorker and similar functions: starts relief-import, waits for it, and validates its result.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "bake/import/import_format.h"
#include "bake/import/import_job.h"
#include "bake/import/import_process.h"
#include "bake/import/import_protocol.h"
#include "bake/import/import_source.h"
#include "bake/import/level.h"
#include "bake/import/mesh_import.h"
#include "formats/base/descriptor.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/fields/text.h"
#include "formats/validate.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

/// Returns the maximum size of a memfd, which the file size limit restricts, too.
std::uint64_t largestFile(std::uint64_t wanted) {
    rlimit limit{};
    return ::getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY
               ? std::min<std::uint64_t>(wanted, limit.rlim_cur)
               : wanted;
}

/// Runs the worker for a mesh file, and reads its result.
class MeshWorker {
  public:
    MeshWorker(const fs::path& path, const ImportOptions& options, const ImportLimits& limits)
        : path_(path), options_(options), worker_("mesh", "simplify the mesh", limits) {}

    /// Reads a file, and frees the bytes of `source`. Errors name the file.
    Result<TriangleMesh> read(ImportSource& source, ImportKind kind) {
        Result<TriangleMesh> raw = workOn(source, kind);
        return raw || raw.error().message.find(quotedPath(path_)) != std::string::npos
                   ? std::move(raw)
                   : withPrefix("cannot read the mesh " + quotedPath(path_), std::move(raw));
    }

  private:
    Result<TriangleMesh> workOn(ImportSource& source, ImportKind kind) {
        RELIEF_TRY(worker_.checkLimits());
        Descriptor mesh = sharedBytes(source.bytes());
        if (!mesh) {
            return ImportProcess::notStarted(errno);
        }
        source.dropBytes();
        const Descriptor result = memoryFile(largestFile(worker_.limits().memory));
        if (!result) {
            return ImportProcess::notStarted(errno);
        }
        Descriptor alive;
        Descriptor alive_end;
        if (const int failed = makePipe(alive, alive_end)) {
            return ImportProcess::notStarted(failed);
        }
        RELIEF_TRY(worker_.start(path_.string(), wordOf(kind), arguments(),
                                 {mesh.get(), source.folder(), result.get(), alive_end.get()}));
        alive_end.reset();
        RELIEF_TRY(worker_.await(alive.get(), 0));  // wait until it closes
        std::byte begun{};
        RELIEF_TRY(worker_.finish(::read(alive.get(), &begun, 1) == 1));
        mesh.reset();
        return message(result.get());
    }

    [[nodiscard]] std::vector<std::string> arguments() const {
        std::vector<std::string> words;
        for (const FieldWords& option : changedFields(options_)) {
            words.push_back(option.name);
            words.push_back(option.words.front());
        }
        words.emplace_back(kImportNamesMarker);
        words.insert(words.end(), options_.names.begin(), options_.names.end());
        return words;
    }

    Result<TriangleMesh> message(int result) const {
        constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE;
        struct stat status {};
        // An unsealed file could change while it is read.
        const int seals = ::fcntl(result, F_GET_SEALS);
        if (seals < 0 || (seals & kSeals) != kSeals || ::fstat(result, &status) != 0 || status.st_size == 0) {
            return fail(ErrorCode::kFailure,
                        "the importer returned no result; try again, or export the mesh in another format");
        }
        const auto size = static_cast<std::size_t>(status.st_size);
        const auto unmap = [size](void* pages) { ::munmap(pages, size); };
        const std::unique_ptr<void, decltype(unmap)> pages(
            ::mmap(nullptr, size, PROT_READ, MAP_SHARED | MAP_POPULATE, result, 0), unmap);
        if (pages.get() == MAP_FAILED) {
            return fail(ErrorCode::kLimit, std::string("its triangles do not fit into memory (") +
                                               std::strerror(errno) + "); simplify the mesh, or free memory");
        }
        Result<TriangleMesh> raw =
            readImportMessage({static_cast<const std::byte*>(pages.get()), size}, worker_.limits().triangles);
        if (!raw && raw.error().message.find(quotedPath(path_)) == std::string::npos) {
            return fail(raw.error().code, raw.error().message + "; export the mesh again");
        }
        return raw;
    }

    const fs::path& path_;
    const ImportOptions& options_;
    ImportProcess worker_;
};

// --- folders ---

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
    std::ranges::sort(files);
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

Result<TriangleMesh> importMeshInWorker(const fs::path& path, const ImportOptions& options,
                                        const ImportLimits& limits) {
    ImportSource source = RELIEF_TRY(ImportSource::open(path));
    TriangleMesh raw = RELIEF_TRY(MeshWorker(path, options, limits).read(source, ImportKind::kMesh));
    return source.finish(std::move(raw), options.names.size());
}

Result<Level> importLevelInWorker(const fs::path& path, const ImportOptions& options,
                                  const ImportLimits& limits) {
    ImportSource source = RELIEF_TRY(ImportSource::open(path));
    TriangleMesh raw = RELIEF_TRY(MeshWorker(path, options, limits).read(source, ImportKind::kLevel));
    return source.finishLevel(std::move(raw), options.names.size(), options.materials);
}

Result<AnimatedImport> importAnimatedFileInWorker(const fs::path& path, ImportKind kind,
                                                  const ImportOptions& options, const ImportLimits& limits) {
    ImportSource source = RELIEF_TRY(ImportSource::open(path));
    TriangleMesh raw = RELIEF_TRY(MeshWorker(path, options, limits).read(source, kind));
    return source.finishAnimated(std::move(raw), kind);
}

Result<Level> importLevel(const fs::path& path, const ImportOptions& options, const ImportLimits& limits) {
    std::error_code error;
    return fs::is_directory(path, error) ? importFolder(path, options, limits)
                                         : importLevelInWorker(path, options, limits);
}

}  // namespace relief
