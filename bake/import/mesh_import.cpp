#include "bake/import/mesh_import.h"

#include <assimp/BaseImporter.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <pthread.h>

#include <algorithm>
#include <assimp/DefaultLogger.hpp>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "bake/import/import_files.h"
#include "bake/import/import_gltf.h"
#include "bake/import/import_source.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

/// assimp recurses along chains of nodes: it runs on a stack that holds a million of them. Only what is used
/// of it takes memory.
constexpr std::size_t kStackBytes = std::size_t{1} << 30;
constexpr std::size_t kStackBytesMin = std::size_t{8} << 20;
/// Of a transform's determinant, over the product of its columns' lengths: below, it has no volume.
constexpr double kFlat = 1e-9;

std::string oneLine(std::string_view text) {
    std::string line(trimmed(text));
    std::replace_if(
        line.begin(), line.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
    return cleanUtf8(trimmed(line));
}

// --- files, as assimp sees them ---

/// A file in memory.
class MemoryStream final : public Assimp::IOStream {
  public:
    explicit MemoryStream(std::span<const std::byte> bytes) : bytes_(bytes) {}
    explicit MemoryStream(std::vector<std::byte> owned) : owned_(std::move(owned)), bytes_(owned_) {}

    std::size_t Read(void* buffer, std::size_t size, std::size_t count) override {
        if (size == 0) {
            return 0;
        }
        const std::size_t whole = std::min(count, (bytes_.size() - at_) / size);
        if (whole > 0) {
            std::memcpy(buffer, bytes_.data() + at_, whole * size);
        }
        at_ += whole * size;
        return whole;
    }
    std::size_t Write(const void* /*buffer*/, std::size_t /*size*/, std::size_t /*count*/) override {
        return 0;
    }
    aiReturn Seek(std::size_t offset, aiOrigin origin) override {
        const std::size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : bytes_.size();
        // Negative offsets arrive as huge ones; the sum wraps round as it should.
        const std::size_t target = base + offset;
        if (target > bytes_.size()) {
            return aiReturn_FAILURE;
        }
        at_ = target;
        return aiReturn_SUCCESS;
    }
    [[nodiscard]] std::size_t Tell() const override { return at_; }
    [[nodiscard]] std::size_t FileSize() const override { return bytes_.size(); }
    void Flush() override {}

  private:
    std::vector<std::byte> owned_;
    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
};

/// The mesh file from memory, whatever it refers to (glTF buffers, material libraries) as ImportFiles allows.
class ReadOnlyFiles final : public Assimp::IOSystem {
  public:
    explicit ReadOnlyFiles(ImportFiles& files) : files_(files) {}

    bool Exists(const char* path) const override { return path != nullptr && files_.exists(path); }
    [[nodiscard]] char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* path, const char* mode) override {
        if (path == nullptr || (mode != nullptr && std::strpbrk(mode, "wa+") != nullptr)) {
            return nullptr;
        }
        if (files_.isMesh(path)) {
            return new MemoryStream(files_.meshBytes());
        }
        std::optional<std::vector<std::byte>> bytes = files_.open(path);
        return bytes ? new MemoryStream(std::move(*bytes)) : nullptr;
    }
    void Close(Assimp::IOStream* stream) override { delete stream; }
    // assimp's own would touch the disk.
    bool CreateDirectory(const std::string& /*path*/) override { return false; }
    bool ChangeDirectory(const std::string& /*path*/) override { return false; }
    bool DeleteFile(const std::string& /*file*/) override { return false; }

  private:
    ImportFiles& files_;
};

// --- what assimp logs ---

/// The errors that assimp logs, while this lives, from this thread: where a reader of it mends a file, such
/// as an index out of range, that is all it says.
class LoggedErrors {
  public:
    LoggedErrors() {
        static const bool kInstalled = [] {
            Assimp::DefaultLogger::set(new Listener);  // kept by assimp for the life of the process
            return true;
        }();
        static_cast<void>(kInstalled);
        errors_of_thread = &errors_;
    }
    LoggedErrors(const LoggedErrors&) = delete;
    LoggedErrors& operator=(const LoggedErrors&) = delete;
    ~LoggedErrors() { errors_of_thread = nullptr; }

    /// The first few, each once.
    [[nodiscard]] const std::vector<std::string>& errors() const { return errors_; }
    [[nodiscard]] bool say(std::string_view words) const {
        return std::any_of(errors_.begin(), errors_.end(),
                           [&](const std::string& error) { return error.find(words) != std::string::npos; });
    }

  private:
    class Listener final : public Assimp::Logger {
      public:
        bool attachStream(Assimp::LogStream* /*stream*/, unsigned /*severity*/) override { return false; }
        bool detachStream(Assimp::LogStream* /*stream*/, unsigned /*severity*/) override { return false; }

      protected:
        void OnVerboseDebug(const char* /*message*/) override {}
        void OnDebug(const char* /*message*/) override {}
        void OnInfo(const char* /*message*/) override {}
        void OnWarn(const char* /*message*/) override {}
        void OnError(const char* message) override {
            constexpr std::size_t kErrorsMax = 4;
            std::vector<std::string>* const errors = errors_of_thread;
            if (errors == nullptr || errors->size() >= kErrorsMax) {
                return;
            }
            const std::string line = oneLine(message);
            // Of what is not looked at here anyway.
            for (const char* other : {"aterial", "exture", "nimation", "angent", "inormal"}) {
                if (line.find(other) != std::string::npos) {
                    return;
                }
            }
            if (std::find(errors->begin(), errors->end(), line) == errors->end()) {
                errors->push_back(line);
            }
        }
    };

    static thread_local std::vector<std::string>* errors_of_thread;
    std::vector<std::string> errors_;
};

thread_local std::vector<std::string>* LoggedErrors::errors_of_thread = nullptr;

// --- the scene's nodes, flattened ---

/// p -> linear · p + offset
struct Transform {
    glm::dmat3 linear{1.0};
    glm::dvec3 offset{0.0};

    [[nodiscard]] glm::dvec3 apply(const glm::dvec3& p) const { return linear * p + offset; }
    [[nodiscard]] double determinant() const {
        const glm::dmat3& m = linear;
        return m[0][0] * (m[1][1] * m[2][2] - m[2][1] * m[1][2]) -
               m[1][0] * (m[0][1] * m[2][2] - m[2][1] * m[0][2]) +
               m[2][0] * (m[0][1] * m[1][2] - m[1][1] * m[0][2]);
    }
    [[nodiscard]] bool mirrors() const { return determinant() < 0.0; }
    /// A scale of 0 along some direction.
    [[nodiscard]] bool flattens() const {
        const double lengths = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
        return std::abs(determinant()) <= kFlat * lengths;
    }
};

Transform operator*(const Transform& outer, const aiMatrix4x4& inner) {
    Transform t;
    t.linear = outer.linear * glm::dmat3(inner.a1, inner.b1, inner.c1, inner.a2, inner.b2, inner.c2, inner.a3,
                                         inner.b3, inner.c3);
    t.offset = outer.apply({inner.a4, inner.b4, inner.c4});
    return t;
}

/// Calls visit(mesh, transform) for every use of a mesh, parents before children. No recursion.
/// \return false as soon as visit does.
template <class Visit>
bool forEachUse(const aiScene& scene, const Transform& root, const Visit& visit) {
    struct Pending {
        const aiNode* node;
        Transform parent;
    };
    std::vector<Pending> pending{{scene.mRootNode, root}};
    while (!pending.empty()) {
        const Pending next = pending.back();
        pending.pop_back();
        const Transform transform = next.parent * next.node->mTransformation;
        for (unsigned i = 0; i < next.node->mNumMeshes; ++i) {
            const unsigned index = next.node->mMeshes[i];
            if (index < scene.mNumMeshes && scene.mMeshes[index]->HasPositions() &&
                !visit(*scene.mMeshes[index], transform)) {
                return false;
            }
        }
        for (unsigned i = next.node->mNumChildren; i > 0; --i) {
            // Some importers (RAW in assimp 5.2) leave children out.
            if (const aiNode* child = next.node->mChildren[i - 1]; child != nullptr) {
                pending.push_back({child, transform});
            }
        }
    }
    return true;
}

void appendMesh(const aiMesh& source, const Transform& transform, TriangleMesh& mesh) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
        const aiVector3D& v = source.mVertices[i];
        mesh.positions.emplace_back(transform.apply({v.x, v.y, v.z}));
    }
    const bool mirrors = transform.mirrors();
    for (unsigned i = 0; i < source.mNumFaces; ++i) {
        const aiFace& face = source.mFaces[i];
        if (face.mNumIndices != 3) {
            continue;
        }
        const std::uint32_t a = face.mIndices[0];
        const std::uint32_t b = face.mIndices[mirrors ? 2 : 1];
        const std::uint32_t c = face.mIndices[mirrors ? 1 : 2];
        mesh.triangles.emplace_back(base + a, base + b, base + c);
    }
}

/// Before anything walks over the faces: some readers of assimp keep whatever index the file holds.
bool indicesExist(const aiScene& scene) {
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[m];
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            for (unsigned i = 0; i < face.mNumIndices; ++i) {
                if (face.mIndices[i] >= mesh.mNumVertices) {
                    return false;
                }
            }
        }
    }
    return true;
}

/// What the scene holds that a rigid surface is not.
void warnOfScene(const aiScene& scene, std::vector<std::string>& warnings) {
    bool skinned = false;
    bool morphed = false;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        skinned = skinned || scene.mMeshes[m]->HasBones();
        morphed = morphed || scene.mMeshes[m]->mNumAnimMeshes > 0;
    }
    for (const auto& [holds, warning] :
         {std::pair{skinned, "it is skinned; baked as it is modelled, without its skeleton"},
          std::pair{morphed, "it is morphed; baked as it is modelled, without its targets"}}) {
        if (holds && std::find(warnings.begin(), warnings.end(), warning) == warnings.end()) {
            warnings.emplace_back(warning);
        }
    }
}

Result<TriangleMesh> flatten(const aiScene& scene, const Transform& root, const std::string& shown,
                             TriangleMesh mesh) {
    // Counted before anything is allocated: a small file can name one mesh very often.
    std::uint64_t faces = 0;
    std::uint64_t vertices = 0;
    std::uint64_t flat = 0;
    const bool fits = forEachUse(scene, root, [&](const aiMesh& source, const Transform& transform) {
        faces += source.mNumFaces;
        vertices += source.mNumVertices;
        flat += transform.flattens() ? 1 : 0;
        return faces <= kTriangleMax && vertices <= 3 * kTriangleMax;
    });
    if (!fits) {
        return fail(ErrorCode::kLimit, shown + ": more than " + std::to_string(kTriangleMax) +
                                           " triangles, instances counted one by one; simplify the mesh");
    }
    mesh.positions.reserve(vertices);
    mesh.triangles.reserve(faces);
    forEachUse(scene, root, [&](const aiMesh& source, const Transform& transform) {
        appendMesh(source, transform, mesh);
        return true;
    });
    if (mesh.triangles.empty()) {
        return fail(ErrorCode::kInvalidInput,
                    shown + ": no triangles; export the surface as polygons, not as points or lines");
    }
    if (flat > 0) {
        mesh.warnings.push_back(std::to_string(flat) +
                                " of its parts are scaled to nothing in some direction, and hold no volume");
    }
    return mesh;
}

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

SourceFrame frameOf(const ImportJob& job, const aiScene& scene) {
    if (job.extension == "gltf" || job.extension == "glb") {
        return {1.0, UpAxis::kPlusY, false, false};
    }
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

Result<TriangleMesh> importWithAssimp(const ImportJob& job) {
    TriangleMesh mesh;
    if (job.extension == "gltf" || job.extension == "glb") {
        std::vector<std::string> warnings = RELIEF_TRY(checkGltf(job.bytes, job.shown));
        mesh.warnings = std::move(warnings);
    }
    ImportFiles files(job.folder, job.file_name, job.bytes);
    Assimp::Importer importer;
    keepReadersOf(job.extension, importer);
    importer.SetIOHandler(new ReadOnlyFiles(files));  // owned by the importer
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    // Without it, files that hold bones alone get a made-up mesh.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);  // turned here
    const LoggedErrors logged;
    const aiScene* scene = importer.ReadFile(job.file_name, 0);
    if (scene != nullptr && (!indicesExist(*scene) || logged.say("out of range"))) {
        return unreadable(job, "a face uses a vertex that does not exist", files);
    }
    if (scene != nullptr) {
        scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_SortByPType);
    }
    if (scene == nullptr || scene->mRootNode == nullptr) {
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
        const std::string words = oneLine(importer.GetErrorString());
        // What it says once points and lines are removed.
        return unreadable(
            job, words.starts_with("No meshes remaining") ? "no triangles, but points or lines" : words,
            files);
    }
    warnOfScene(*scene, mesh.warnings);
    const FrameChange change = changeOf(frameOf(job, *scene), job.options.unit, job.options.up);
    mesh.unit = change.unit;
    mesh.warnings.insert(mesh.warnings.end(), change.warnings.begin(), change.warnings.end());
    for (const std::string& error : logged.errors()) {
        mesh.warnings.push_back("its importer says: " + error);
    }
    for (const std::string& refused : files.refused()) {
        mesh.warnings.push_back("left out " + refused);
    }
    for (const ImportedFile& file : files.read()) {
        mesh.dependencies.push_back(file.path);
        mesh.dependency_hashes.push_back(file.hash);
    }
    Transform root;
    root.linear = change.scale * change.turn;
    return flatten(*scene, root, job.shown, std::move(mesh));
}

// --- a thread with a deep stack ---

struct Import {
    const ImportJob& job;
    std::optional<Result<TriangleMesh>> result;

    void run() {
        const std::string where = "cannot read the mesh " + job.shown + ": ";
        try {
            result.emplace(importWithAssimp(job));
        } catch (const std::bad_alloc&) {
            result.emplace(fail(ErrorCode::kLimit, where + "out of memory; simplify it"));
        } catch (const std::exception& e) {
            result.emplace(fail(ErrorCode::kInvalidInput, where + oneLine(e.what()) + "; export it again"));
        } catch (...) {
            result.emplace(fail(ErrorCode::kInvalidInput, where + "the importer gave up; export it again"));
        }
    }
    static void* start(void* self) {
        static_cast<Import*>(self)->run();
        return nullptr;
    }
};

bool runOnDeepStack(Import& import) {
    for (std::size_t stack = kStackBytes; stack >= kStackBytesMin; stack /= 2) {
        pthread_attr_t attributes;
        pthread_attr_init(&attributes);
        pthread_t thread{};
        const bool started = pthread_attr_setstacksize(&attributes, stack) == 0 &&
                             pthread_create(&thread, &attributes, Import::start, &import) == 0;
        pthread_attr_destroy(&attributes);
        if (started) {
            pthread_join(thread, nullptr);
            return true;
        }
    }
    return false;
}

}  // namespace

Result<TriangleMesh> importRaw(const ImportJob& job) {
    Import import{job, std::nullopt};
    if (!runOnDeepStack(import)) {
        return fail(ErrorCode::kFailure,
                    job.shown + ": no thread could be started to read it; free some memory");
    }
    return std::move(*import.result);
}

Result<TriangleMesh> importMesh(const fs::path& path, const ImportOptions& options) {
    const ImportSource source = RELIEF_TRY(ImportSource::open(path));
    Result<TriangleMesh> raw = importRaw({quotedPath(path), path.filename().string(), source.extension(),
                                          source.bytes(), source.folder(), options});
    return raw ? source.finish(std::move(*raw)) : raw;
}

}  // namespace relief
