// SPDX-License-Identifier: Apache-2.0
#include "bake/import/mesh_import.h"

#include <pthread.h>

#include <cstring>
#include <optional>

#include "bake/import/import_files.h"
#include "bake/import/import_format.h"
#include "bake/import/import_readers.h"
#include "bake/import/import_scene.h"
#include "bake/import/import_source.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "formats/polygons/polygon_mesh.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

/// assimp and flatten() recurse along chains of nodes; this stack suffices for a million nodes. Only touched pages use
/// memory.
constexpr std::size_t kStackBytes = std::size_t{1} << 30;
constexpr std::size_t kStackBytesMin = std::size_t{8} << 20;

/// Prefixes the file name, and appends advice if the message has none.
tl::unexpected<Error> unreadable(const ImportJob& job, const Error& error) {
    const bool has_advice = error.message.find(';') != std::string::npos;
    return fail(error.code, "cannot read the mesh " + job.shown + ": " + error.message +
                                (has_advice ? "" : "; repair the file or export it again"));
}

/// \param apart  as in addPolygons().
Result<ImportScene> sceneOf(const Result<PolygonMesh>& polygons, bool apart, const ImportJob& job) {
    if (!polygons) {
        return tl::unexpected<Error>(polygons.error());
    }
    if (polygons->positions.empty()) {
        // The OBJ reader accepts any text; other formats have signatures.
        return invalidInput(job.extension == "obj" ? "it has no vertices, and is probably not an .obj file"
                                                   : "it has no triangles; export the mesh again");
    }
    ImportScene scene;
    RELIEF_TRY(addPolygons(*polygons, apart, job, scene));
    return scene;
}

/// Reads an OBJ and opens its material libraries, which are dependencies although they do not affect the shape. If
/// a library is missing, the library named after the mesh replaces it.
Result<PolygonMesh> readObjOf(const ImportJob& job, ImportFiles& files) {
    ObjMesh obj = RELIEF_TRY(readObj(job.bytes));
    const std::string own = fs::path(job.file_name).replace_extension("mtl").string();
    for (const std::string& library : obj.libraries) {
        if (!files.open(library) && library != own && files.exists(own)) {
            static_cast<void>(files.open(own));
        }
    }
    return std::move(obj.polygons);
}

Result<ImportScene> readScene(const MeshFormat& format, const ImportJob& job, ImportFiles& files) {
    switch (format.reader) {
        case MeshReader::kAc3d:
            return readAc3d(job);
        case MeshReader::kGltf:
            return readGltf(job, files);
        case MeshReader::kObj:
            return sceneOf(readObjOf(job, files), true, job);
        case MeshReader::kOff:
            return sceneOf(readOff(job.bytes), false, job);
        case MeshReader::kPly:
            return sceneOf(readPly(job.bytes), false, job);
        case MeshReader::kStl:
            return sceneOf(readStl(job.bytes), true, job);
        default:
            return readWithAssimp(format.frame, job, files);
    }
}

Result<TriangleMesh> readMesh(const MeshFormat& format, const ImportJob& job, ImportFiles& files) {
    if (job.kind == ImportKind::kAnimated || job.kind == ImportKind::kClips) {
        return format.reader == MeshReader::kGltf
                   ? readAnimatedGltf(job, files)
                   : fail(ErrorCode::kUnsupported, "animations in ." + job.extension +
                                                       " files are not supported; convert the file to glTF");
    }
    ImportScene scene = RELIEF_TRY(readScene(format, job, files));
    return job.kind == ImportKind::kLevel ? flattenLevel(std::move(scene), job)
                                          : flatten(std::move(scene), job);
}

Result<TriangleMesh> importFile(const ImportJob& job) {
    const MeshFormat* const format = meshFormat(job.extension);
    if (format == nullptr) {
        return fail(ErrorCode::kUnsupported, "no mesh format has the extension '" + cleanUtf8(job.extension) +
                                                 "'; convert it to glTF, OBJ or PLY");
    }
    ImportFiles files(job.folder, job.file_name, job.bytes);
    TriangleMesh mesh = RELIEF_TRY(readMesh(*format, job, files));
    for (const std::string& refused : files.refused()) {
        mesh.warnings.push_back("left out " + refused);
    }
    for (const auto& [path, hash] : files.read()) {
        mesh.dependencies.push_back(path);
        mesh.dependency_hashes.push_back(hash);
    }
    return mesh;
}

// --- a thread with a deep stack ---

struct Import {
    const ImportJob& job;
    std::optional<Result<TriangleMesh>> result;

    void run() {
        try {
            result.emplace(importFile(job));
        } catch (const std::bad_alloc&) {
            result.emplace(fail(ErrorCode::kLimit, "out of memory; simplify the mesh"));
        } catch (const std::exception& e) {
            result.emplace(invalidInput(oneCleanLine(e.what()) + "; export it again"));
        } catch (...) {
            result.emplace(invalidInput("the importer failed; export the file again"));
        }
    }
    static void* start(void* self) {
        static_cast<Import*>(self)->run();
        return nullptr;
    }
};

/// \return 0 or an errno.
int startOnDeepStack(Import& import) {
    int failed = 0;
    for (std::size_t stack = kStackBytes; stack >= kStackBytesMin; stack /= 2) {
        pthread_attr_t attributes;
        pthread_attr_init(&attributes);
        pthread_t thread{};
        failed = pthread_attr_setstacksize(&attributes, stack);
        failed = failed == 0 ? pthread_create(&thread, &attributes, Import::start, &import) : failed;
        pthread_attr_destroy(&attributes);
        if (failed == 0) {
            pthread_join(thread, nullptr);
            break;
        }
    }
    return failed;
}

}  // namespace

Result<TriangleMesh> importRaw(const ImportJob& job) {
    if (job.options.names.size() > kSelectedNamesMax) {
        return fail(ErrorCode::kLimit, job.shown + ": more than " + std::to_string(kSelectedNamesMax) +
                                           " names are requested at once; use fewer");
    }
    ImportJob without_mark = job;
    without_mark.bytes = job.bytes.last(withoutByteOrderMark(textOf(job.bytes)).size());
    const std::optional<std::string> format = otherFormat(job.extension, without_mark.bytes);
    if (format) {
        without_mark.file_name += "." + *format;
        without_mark.extension = *format;
    }
    Import import{without_mark, std::nullopt};
    if (const int failed = startOnDeepStack(import)) {
        return unreadable(
            job, {ErrorCode::kFailure, std::string("no thread could be started (") + std::strerror(failed) +
                                           "); free memory, or end processes or raise their "
                                           "limit (ulimit -u)"});
    }
    Result<TriangleMesh>& mesh = *import.result;
    if (!mesh) {
        return unreadable(job, mesh.error());
    }
    if (format) {
        mesh->warnings.push_back("its contents are those of a ." + *format + ", not of a ." + job.extension +
                                 "; it is read as ." + *format + "; rename it");
    }
    return std::move(mesh);
}

Result<TriangleMesh> importMesh(const fs::path& path, const ImportOptions& options) {
    const ImportSource source = RELIEF_TRY(ImportSource::open(path));
    Result<TriangleMesh> raw = importRaw({quotedPath(path), path.filename().string(), source.extension(),
                                          source.bytes(), source.folder(), options});
    return raw ? source.finish(std::move(*raw), options.names.size()) : raw;
}

}  // namespace relief
