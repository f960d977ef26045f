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
#include "bake/import/import_assembly.h"
#include "bake/import/import_files.h"
#include "bake/import/import_format.h"
#include "bake/import/import_gltf.h"
#include "bake/import/import_parts.h"
#include "bake/import/import_readers.h"
#include "bake/import/import_scene.h"
#include "bake/import/import_source.h"
#include "bake/import/polygon_mesh.h"
#include "formats/base/file_io.h"
#include "formats/base/retry.h"
#include "formats/base/text.h"
#include "formats/polygons/obj_mesh.h"
#include "formats/polygons/ply_mesh.h"

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

/// FBX has its unit in centimetres, and its axes by number and sign; assimp applies neither.
SourceFrame fbxFrame(const ImportJob& job, const aiScene& scene) {
    SourceFrame frame{0.01, UpAxis::kPlusY};
    double factor = metadata<double>(scene, "UnitScaleFactor").value_or(1.0);
    // assimp takes 10 of 10,5 and nothing but a number of the type double.
    const std::optional<FbxUnit> stated = fbxUnit(job.bytes);
    if (stated && stated->value && std::abs(factor / *stated->value - 1.0) > 1e-6) {
        factor = *stated->value;
    }
    if ((!stated || stated->value) && std::isfinite(factor) && factor > 0.0) {
        frame.metres = 0.01 * factor;
    } else {
        frame.metres.reset();
        frame.unit_fault = "its UnitScaleFactor is " +
                           (stated ? stated->text : shortest(static_cast<float>(factor))) +
                           ", which is no length";
    }
    const int axis = metadata<std::int32_t>(scene, "UpAxis").value_or(1);
    const int sign = metadata<std::int32_t>(scene, "UpAxisSign").value_or(1);
    if (axis >= 0 && axis <= 2) {
        frame.up = static_cast<UpAxis>(2 * axis + (sign < 0 ? 1 : 0));
    } else {
        frame.up.reset();
        frame.up_fault = "its UpAxis is " + std::to_string(axis) + ", which is none of 0, 1 and 2";
    }
    return frame;
}

/// assimp scales the root by the document's unit as it understands it. \param scene  loses that scale where it is another.
Result<SourceFrame> daeFrame(const ImportJob& job, aiScene& scene) {
    SourceFrame frame = RELIEF_TRY(colladaFrame(job.bytes));
    const double applied = double{scene.mRootNode->mTransformation.a1};  // as it was rounded
    frame.scaled = frame.metres && std::abs(applied / *frame.metres - 1.0) < 1e-5;
    if (frame.scaled) {
        frame.metres = applied;
    } else {
        scene.mRootNode->mTransformation = aiMatrix4x4();
    }
    return frame;
}

/// assimp turns the root, and divides it by the file's master scale, whatever that is. \param scene  loses that scale where
/// it is none.
SourceFrame frameOf3ds(aiScene& scene) {
    SourceFrame frame{std::nullopt, UpAxis::kPlusZ, false, true};
    const float scale = scene.mRootNode->mTransformation.a1;
    if (!(scale > 0.0F && std::isfinite(scale))) {
        frame.unit_fault = "its master scale is " + shortest(1.0F / scale) + ", which is none";
        scene.mRootNode->mTransformation = {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};
    }
    return frame;
}

/// \param scene  may lose what a reader has applied of it.
/// Errors: kInvalidInput, without the file's name.
Result<SourceFrame> frameOf(AssimpFrame format, const ImportJob& job, aiScene& scene) {
    SourceFrame frame;
    switch (format) {
        case AssimpFrame::kAsIs:
            break;
        case AssimpFrame::kMirrored:
            frame.mirrored = true;
            break;
        case AssimpFrame::kZUp:
            frame.up = UpAxis::kPlusZ;
            frame.turned = true;
            break;
        case AssimpFrame::k3ds:
            return frameOf3ds(scene);
        case AssimpFrame::kDae:
            return daeFrame(job, scene);
        case AssimpFrame::kDxf:
            return dxfFrame(job.bytes);
        case AssimpFrame::kFbx:
            return fbxFrame(job, scene);
    }
    return frame;
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
    if (logged.say("UnitScaleFactor must be non-zero")) {
        return fail(ErrorCode::kInvalidInput,
                    "cannot read the mesh " + job.shown +
                        ": its UnitScaleFactor is 0, which is no length; export it again "
                        "with a unit");
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
/// Errors: as checkFrame.
Result<glm::dmat3> takeFrame(const SourceFrame& frame, const ImportOptions& options, TriangleMesh& mesh) {
    RELIEF_TRY(checkFrame(frame, options.unit, options.up));
    const FrameChange change = changeOf(frame, options.unit, options.up);
    mesh.unit = change.unit;
    mesh.warnings.insert(mesh.warnings.end(), change.warnings.begin(), change.warnings.end());
    return change.scale * change.turn;
}

Result<TriangleMesh> importWithAssimp(const MeshFormat& format, const ImportJob& job, ImportFiles& files) {
    TriangleMesh mesh;
    const LoggedErrors logged;
    Assimp::Importer importer;
    MeshParts parts;
    keepReadersOf(job.extension, importer);
    const aiScene* const scene = RELIEF_TRY(readScene(job, files, logged, importer, parts));
    mesh.unused_vertices = parts.unused;
    warnOfParts(parts, mesh.warnings);
    warnOfScene(*scene, mesh.warnings);
    // The importer's own; it hands out nothing that could be changed.
    const Result<SourceFrame> frame = frameOf(format.frame, job, const_cast<aiScene&>(*scene));
    const Result<glm::dmat3> linear =
        frame.and_then([&](const SourceFrame& known) { return takeFrame(known, job.options, mesh); });
    if (!linear) {
        return unreadable(job.shown, linear.error());
    }
    for (const std::string& error : logged.errors()) {
        mesh.warnings.push_back("its importer says: " + error);
    }
    return flatten(*scene, *linear, job, std::move(mesh));
}

std::string upperCase(std::string word) {
    for (char& c : word) {
        c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    }
    return word;
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

Result<PolygonMesh> readObjOf(const ImportJob& job, ImportFiles& files) {
    ObjMesh obj = RELIEF_TRY(readObj(job.bytes));
    openLibraries(job, obj.libraries, files);
    return std::move(obj.polygons);
}

/// \param apart  as flatten() has it.
Result<TriangleMesh> importPolygons(const ImportJob& job, ImportFiles& files,
                                    const Result<PolygonMesh>& polygons, bool apart) {
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
    const glm::dmat3 linear = RELIEF_TRY(takeFrame({}, job.options, mesh));
    return flatten(*polygons, apart, linear, job, std::move(mesh));
}

Result<TriangleMesh> importAssembly(const ImportJob& job, const Result<AssemblyFile>& file) {
    TriangleMesh mesh;
    const Result<glm::dmat3> linear =
        file.and_then([&](const AssemblyFile& read) { return takeFrame(read.frame, job.options, mesh); });
    if (!linear) {
        return unreadable(job.shown, linear.error());
    }
    mesh.warnings.insert(mesh.warnings.end(), file->warnings.begin(), file->warnings.end());
    return flatten(file->assembly, *linear, job, std::move(mesh));
}

Result<TriangleMesh> importGltf(const ImportJob& job, ImportFiles& files) {
    TriangleMesh mesh;
    const glm::dmat3 linear = RELIEF_TRY(takeFrame({1.0, UpAxis::kPlusY}, job.options, mesh));
    return readGltf(job, files, linear, std::move(mesh));
}

Result<TriangleMesh> importAs(const MeshFormat& format, const ImportJob& job, ImportFiles& files) {
    switch (format.reader) {
        case MeshReader::kAssimp:
            return importWithAssimp(format, job, files);
        case MeshReader::kGltf:
            return importGltf(job, files);
        case MeshReader::kObj:
            return importPolygons(job, files, readObjOf(job, files), true);
        case MeshReader::kOff:
            return importPolygons(job, files, readOff(job.bytes), false);
        case MeshReader::kPly:
            return importPolygons(job, files, readPly(job.bytes), false);
        case MeshReader::kRaw:
            return importPolygons(job, files, readRaw(job.bytes), true);
        case MeshReader::kStl:
            return importPolygons(job, files, readStl(job.bytes), true);
        case MeshReader::kAmf:
            return importAssembly(job, readAmf(job.bytes));
        case MeshReader::k3mf:
            return importAssembly(job, read3mf(job.bytes));
    }
    return fail(ErrorCode::kUnsupported, "cannot read the mesh " + job.shown + ": it has no reader");
}

Result<TriangleMesh> importWhatItIs(const ImportJob& job) {
    const MeshFormat* const format = meshFormat(job.extension);
    if (format == nullptr) {
        return fail(ErrorCode::kUnsupported, "cannot read the mesh " + job.shown +
                                                 ": no mesh format has the extension '" +
                                                 cleanUtf8(job.extension) + "'");
    }
    if (job.extension == "ac" && isAcCutOff(job.bytes)) {
        return fail(ErrorCode::kInvalidInput, "cannot read the mesh " + job.shown +
                                                  ": it holds less than its counts say and was probably cut "
                                                  "off; copy or export it again");
    }
    ImportFiles files(job.folder, job.file_name, job.bytes);
    TriangleMesh mesh = RELIEF_TRY(importAs(*format, job, files));
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
    if (const MeshFormat* const named = meshFormat(job.extension);
        named != nullptr && !named->alias.empty()) {
        unmarked.extension = named->alias;
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
