#include "bake/import/mesh_import.h"

#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <pthread.h>

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

#include "bake/import/assimp_io.h"
#include "bake/import/import_ac.h"
#include "bake/import/import_files.h"
#include "bake/import/import_format.h"
#include "bake/import/import_gltf.h"
#include "bake/import/import_obj.h"
#include "bake/import/import_off.h"
#include "bake/import/import_parts.h"
#include "bake/import/import_ply.h"
#include "bake/import/import_raw.h"
#include "bake/import/import_scene.h"
#include "bake/import/import_source.h"
#include "bake/import/import_stl.h"
#include "bake/import/polygon_mesh.h"
#include "formats/base/file_io.h"
#include "formats/base/retry.h"
#include "formats/base/text.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

/// assimp recurses along chains of nodes: it runs on a stack that holds a million of them. Only what is used
/// of it takes memory.
constexpr std::size_t kStackBytes = std::size_t{1} << 30;
constexpr std::size_t kStackBytesMin = std::size_t{8} << 20;

// --- units and axes ---

template <class T>
std::optional<T> metadata(const aiScene& scene, const char* key) {
    T value{};
    if (scene.mMetaData == nullptr || !scene.mMetaData->Get(key, value)) {
        return std::nullopt;
    }
    return value;
}

/// FBX says its unit in centimetres, and its axes by number and sign; assimp applies neither.
SourceFrame fbxFrame(const aiScene& scene) {
    SourceFrame frame{0.01, UpAxis::kPlusY, false, false};
    double factor = 1.0;
    if (const auto wide = metadata<double>(scene, "UnitScaleFactor")) {
        factor = *wide;
    } else if (const auto narrow = metadata<float>(scene, "UnitScaleFactor")) {
        factor = double{*narrow};
    }
    if (std::isfinite(factor) && factor > 0.0) {
        frame.metres = 0.01 * factor;
    }
    const int axis = metadata<std::int32_t>(scene, "UpAxis").value_or(1);
    const int sign = metadata<std::int32_t>(scene, "UpAxisSign").value_or(1);
    if (axis >= 0 && axis <= 2) {
        frame.up = static_cast<UpAxis>(2 * axis + (sign < 0 ? 1 : 0));
    }
    return frame;
}

bool isGltf(const ImportJob& job) {
    return job.extension == "gltf" || job.extension == "glb";
}

SourceFrame frameOf(const ImportJob& job, const aiScene& scene) {
    if (job.extension == "fbx") {
        return fbxFrame(scene);
    }
    if (job.extension == "dae") {
        // The root holds nothing but the document's unit.
        const double metres = double{scene.mRootNode->mTransformation.a1};
        const std::string_view document(reinterpret_cast<const char*>(job.bytes.data()), job.bytes.size());
        return {std::isfinite(metres) && metres > 0.0 ? metres : 1.0, colladaUp(document), true, false};
    }
    if (job.extension == "3ds") {
        return {std::nullopt, UpAxis::kPlusZ, false, true};  // assimp has turned it
    }
    return {};
}

// --- the importer ---

/// Leaves only the readers that claim the extension: which one reads a file does not depend on its contents.
void keepReadersOf(const std::string& extension, Assimp::Importer& importer) {
    std::vector<Assimp::BaseImporter*> others;
    for (std::size_t i = 0; i < importer.GetImporterCount(); ++i) {
        const std::string_view claimed = importer.GetImporterInfo(i)->mFileExtensions;
        const std::vector<std::string_view> extensions = split(claimed, ' ');
        if (std::find(extensions.begin(), extensions.end(), extension) == extensions.end()) {
            others.push_back(importer.GetImporter(i));
        }
    }
    for (Assimp::BaseImporter* other : others) {
        importer.UnregisterLoader(other);
        delete other;
    }
}

/// The error of a file that assimp does not read, with the files that it was not given.
tl::unexpected<Error> unreadable(const ImportJob& job, const std::string& words, const ImportFiles& files) {
    std::string text = "cannot read the mesh " + job.shown + ": " +
                       (words.empty() ? "its contents are not what its extension says" : words);
    for (const std::string& refused : files.refused()) {
        text += "; it refers to " + refused;
    }
    return fail(ErrorCode::kInvalidInput, text + "; repair the file or export it again");
}

/// Reads the file; the importer owns the scene.
/// \param parts  set to what the file holds.
/// Errors: kInvalidInput. Throws std::bad_alloc where assimp has run out of memory.
Result<const aiScene*> readScene(const ImportJob& job, ImportFiles& files, const LoggedErrors& logged,
                                 Assimp::Importer& importer, MeshParts& parts) {
    importer.SetIOHandler(new ReadOnlyFiles(files));  // owned by the importer
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    // Without it, files that hold bones alone get a made-up mesh.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);  // turned here
    const aiScene* scene = importer.ReadFile(job.file_name, 0);
    if (scene != nullptr &&
        (!indicesExist(*scene) || logged.say("out of range") || logged.say("out-of-range"))) {
        return unreadable(job, "a face uses a vertex that does not exist", files);
    }
    parts = scene != nullptr ? partsOf(*scene) : MeshParts();
    if (const std::optional<std::string> refusal = partsRefusal(parts)) {
        return fail(ErrorCode::kInvalidInput, "cannot read the mesh " + job.shown + ": " + *refusal);
    }
    if (scene != nullptr) {
        triangulate(*const_cast<aiScene*>(scene));  // the importer's own, and no constant
        scene = importer.ApplyPostProcessing(aiProcess_SortByPType);
    }
    if (scene != nullptr && scene->mRootNode != nullptr) {
        return scene;
    }
    if (const std::exception_ptr& thrown = importer.GetException(); thrown != nullptr) {
        try {
            std::rethrow_exception(thrown);
        } catch (const std::bad_array_new_length&) {
            // A size that is no size: the file is wrong.
        } catch (const std::bad_alloc&) {
            throw;
        } catch (...) {
            // Its words follow.
        }
    }
    return unreadable(job, oneCleanLine(importer.GetErrorString()), files);
}

/// Takes what changes the mesh into metres and +y. \param mesh  gets its unit and warnings. \return what to apply.
glm::dmat3 takeFrame(const SourceFrame& frame, const ImportOptions& options, TriangleMesh& mesh) {
    const FrameChange change = changeOf(frame, options.unit, options.up);
    mesh.unit = change.unit;
    mesh.warnings.insert(mesh.warnings.end(), change.warnings.begin(), change.warnings.end());
    return change.scale * change.turn;
}

Result<TriangleMesh> importWithAssimp(const ImportJob& job, ImportFiles& files) {
    TriangleMesh mesh;
    const LoggedErrors logged;
    Assimp::Importer importer;
    MeshParts parts;
    keepReadersOf(job.extension, importer);
    const aiScene* const scene = RELIEF_TRY(readScene(job, files, logged, importer, parts));
    mesh.unused_vertices = parts.unused;
    warnOfParts(parts, mesh.warnings);
    warnOfScene(*scene, mesh.warnings);
    const glm::dmat3 linear = takeFrame(frameOf(job, *scene), job.options, mesh);
    for (const std::string& error : logged.errors()) {
        mesh.warnings.push_back("its importer says: " + error);
    }
    return flatten(*scene, linear, job, std::move(mesh));
}

std::string upperCase(std::string word) {
    for (char& c : word) {
        c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    }
    return word;
}

bool isReadHere(const ImportJob& job) {
    constexpr std::array<std::string_view, 5> kReadHere = {"obj", "off", "ply", "raw", "stl"};
    return std::find(kReadHere.begin(), kReadHere.end(), job.extension) != kReadHere.end();
}

/// Opens the libraries of an OBJ's materials: nothing in them matters to its shape, but it depends on them. Where one is not
/// there, that of the mesh's own name stands in.
void openLibraries(const ImportJob& job, std::span<const std::string> libraries, ImportFiles& files) {
    for (const std::string& library : libraries) {
        const std::string own = fs::path(job.file_name).replace_extension("mtl").string();
        if (!files.open(library) && library != own && files.exists(own)) {
            static_cast<void>(files.open(own));
        }
    }
}

Result<PolygonMesh> readPolygons(const ImportJob& job, ImportFiles& files) {
    if (job.extension == "obj") {
        ObjMesh obj = RELIEF_TRY(readObj(job.bytes));
        openLibraries(job, obj.libraries, files);
        return std::move(obj.polygons);
    }
    return job.extension == "off"   ? readOff(job.bytes)
           : job.extension == "ply" ? readPly(job.bytes)
           : job.extension == "raw" ? readRaw(job.bytes)
                                    : readStl(job.bytes);
}

/// OBJ, OFF, PLY, RAW and STL. \param files  of materials.
Result<TriangleMesh> importPolygons(const ImportJob& job, ImportFiles& files) {
    const Result<PolygonMesh> polygons = readPolygons(job, files);
    if (!polygons) {
        return unreadable(job.shown, polygons.error());
    }
    const MeshParts parts = partsOf(*polygons);
    if (parts.vertices == 0) {
        return unreadable(job, "it has no vertices, and is probably no " + upperCase(job.extension) + " file",
                          files);
    }
    if (const std::optional<std::string> refusal = partsRefusal(parts)) {
        return fail(ErrorCode::kInvalidInput, "cannot read the mesh " + job.shown + ": " + *refusal);
    }
    TriangleMesh mesh;
    mesh.warnings = polygons->warnings;
    mesh.unused_vertices = parts.unused;
    warnOfParts(parts, mesh.warnings);
    const glm::dmat3 linear = takeFrame({}, job.options, mesh);
    return flatten(*polygons, job.extension != "off" && job.extension != "ply", linear, job, std::move(mesh));
}

Result<TriangleMesh> importGltf(const ImportJob& job, ImportFiles& files) {
    TriangleMesh mesh;
    const glm::dmat3 linear = takeFrame({1.0, UpAxis::kPlusY, false, false}, job.options, mesh);
    return readGltf(job, files, linear, std::move(mesh));
}

Result<TriangleMesh> importWhatItIs(const ImportJob& job) {
    if (job.extension == "ac" && isAcCutOff(job.bytes)) {
        return fail(ErrorCode::kInvalidInput, "cannot read the mesh " + job.shown +
                                                  ": it holds less than its counts say and was probably cut "
                                                  "off; copy or export it again");
    }
    ImportFiles files(job.folder, job.file_name, job.bytes);
    TriangleMesh mesh = RELIEF_TRY(isGltf(job)       ? importGltf(job, files)
                                   : isReadHere(job) ? importPolygons(job, files)
                                                     : importWithAssimp(job, files));
    for (const std::string& refused : files.refused()) {
        mesh.warnings.push_back("left out " + refused);
    }
    for (const ImportedFile& file : files.read()) {
        mesh.dependencies.push_back(file.path);
        mesh.dependency_hashes.push_back(file.hash);
    }
    return mesh;
}

// --- a thread with a deep stack ---

struct Import {
    const ImportJob& job;
    std::optional<Result<TriangleMesh>> result;

    void run() {
        const std::string where = "cannot read the mesh " + job.shown + ": ";
        try {
            result.emplace(importWhatItIs(job));
        } catch (const std::bad_alloc&) {
            result.emplace(fail(ErrorCode::kLimit, where + "out of memory; simplify it"));
        } catch (const std::exception& e) {
            result.emplace(
                fail(ErrorCode::kInvalidInput, where + oneCleanLine(e.what()) + "; export it again"));
        } catch (...) {
            result.emplace(fail(ErrorCode::kInvalidInput, where + "the importer gave up; export it again"));
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
    if (job.options.names.size() > kAskedNamesMax) {
        return fail(ErrorCode::kLimit, job.shown + ": more than " + std::to_string(kAskedNamesMax) +
                                           " names are asked for at once; ask for fewer");
    }
    ImportJob unmarked = job;
    const std::string_view text(reinterpret_cast<const char*>(job.bytes.data()), job.bytes.size());
    unmarked.bytes = job.bytes.subspan(job.bytes.size() - withoutByteOrderMark(text).size());
    if (job.extension == "acc") {
        unmarked.extension = "ac";  // as racing simulators call it
    }
    if (const std::optional<std::string> stranger = noMeshAtAll(job.extension, job.bytes)) {
        return fail(ErrorCode::kInvalidInput, "cannot read the mesh " + job.shown + ": " + *stranger);
    }
    const std::optional<std::string> format = otherFormat(unmarked.extension, unmarked.bytes);
    if (format) {
        unmarked.file_name += "." + *format;
        unmarked.extension = *format;
    }
    Import import{unmarked, std::nullopt};
    if (const int failed = retryTransient([&] { return startOnDeepStack(import); })) {
        return fail(ErrorCode::kFailure,
                    "cannot read the mesh " + job.shown + ": no thread could be started (" +
                        std::strerror(failed) +
                        "); free memory, or end processes or raise their limit (ulimit -u)");
    }
    if (format && *import.result) {
        (*import.result)
            ->warnings.push_back("its contents are those of a ." + *format + ", not of a ." + job.extension +
                                 ", and are read so; rename it");
    }
    return std::move(*import.result);
}

Result<TriangleMesh> importMesh(const fs::path& path, const ImportOptions& options) {
    const ImportSource source = RELIEF_TRY(ImportSource::open(path));
    Result<TriangleMesh> raw = importRaw({quotedPath(path), path.filename().string(), source.extension(),
                                          source.bytes(), source.folder(), options});
    return raw ? source.finish(std::move(*raw), options.names.size()) : raw;
}

}  // namespace relief
