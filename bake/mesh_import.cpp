#include "bake/mesh_import.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <pthread.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cstring>
#include <glm/mat3x3.hpp>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "bake/text.h"
#include "formats/file_io.h"
#include "formats/hash.h"
#include "formats/validate.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

/// assimp recurses along chains of nodes: it runs on a stack that holds a million of them. Only what is used
/// of it takes memory.
constexpr std::size_t kStackBytes = std::size_t{1} << 30;
constexpr std::size_t kStackBytesMin = std::size_t{8} << 20;
constexpr std::string_view kSomeExtensions = "obj, stl, ply, off, gltf, glb, fbx, dae, 3ds, blend, 3mf";

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

/// The mesh file from memory, whatever it refers to (glTF buffers, material libraries) from disk, and nothing
/// that is not a regular file: a mesh must not be able to hang the baker on a pipe or a device.
class ReadOnlyFiles final : public Assimp::IOSystem {
  public:
    using Read = std::map<std::string, std::string>;

    /// \param read  gets the hashes of the other files, by their paths; outlives this.
    ReadOnlyFiles(std::string main_path, std::span<const std::byte> main_bytes, Read& read)
        : main_path_(std::move(main_path)), main_bytes_(main_bytes), read_(read) {}

    bool Exists(const char* path) const override { return path == main_path_ || isRegular(path); }
    [[nodiscard]] char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* path, const char* mode) override {
        if (mode != nullptr && std::strpbrk(mode, "wa+") != nullptr) {
            return nullptr;
        }
        if (path == main_path_) {
            return new MemoryStream(main_bytes_);
        }
        if (!isRegular(path)) {
            return nullptr;
        }
        Result<std::vector<std::byte>> bytes = readFile(path);
        if (!bytes) {
            return nullptr;
        }
        read_.insert_or_assign(path, xxh3_128Hex(*bytes));
        return new MemoryStream(std::move(*bytes));
    }
    void Close(Assimp::IOStream* stream) override { delete stream; }

  private:
    static bool isRegular(const char* path) {
        std::error_code error;
        return path != nullptr && fs::is_regular_file(path, error);
    }

    std::string main_path_;
    std::span<const std::byte> main_bytes_;
    Read& read_;
};

// --- the scene's nodes, flattened ---

/// p -> linear · p + offset
struct Transform {
    glm::dmat3 linear{1.0};
    glm::dvec3 offset{0.0};

    [[nodiscard]] glm::dvec3 apply(const glm::dvec3& p) const { return linear * p + offset; }
    [[nodiscard]] bool mirrors() const {
        const glm::dmat3& m = linear;
        return m[0][0] * (m[1][1] * m[2][2] - m[2][1] * m[1][2]) -
                   m[1][0] * (m[0][1] * m[2][2] - m[2][1] * m[0][2]) +
                   m[2][0] * (m[0][1] * m[1][2] - m[1][1] * m[0][2]) <
               0.0;
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
bool forEachUse(const aiScene& scene, const Visit& visit) {
    struct Pending {
        const aiNode* node;
        Transform parent;
    };
    std::vector<Pending> pending{{scene.mRootNode, {}}};
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

bool appendMesh(const aiMesh& source, const Transform& transform, TriangleMesh& mesh) {
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
        if (std::max({a, b, c}) >= source.mNumVertices) {
            return false;
        }
        mesh.triangles.emplace_back(base + a, base + b, base + c);
    }
    return true;
}

Result<TriangleMesh> flatten(const aiScene& scene, TriangleMesh mesh) {
    // Counted before anything is allocated: a small file can name one mesh very often.
    std::uint64_t faces = 0;
    std::uint64_t vertices = 0;
    const bool fits = forEachUse(scene, [&](const aiMesh& source, const Transform& /*transform*/) {
        faces += source.mNumFaces;
        vertices += source.mNumVertices;
        return faces <= kTriangleMax && vertices <= 3 * kTriangleMax;
    });
    if (!fits) {
        return fail(ErrorCode::kLimit, mesh.name + ": more than " + std::to_string(kTriangleMax) +
                                           " triangles, instances counted one by one; simplify the mesh");
    }
    mesh.positions.reserve(vertices);
    mesh.triangles.reserve(faces);
    const bool valid = forEachUse(scene, [&](const aiMesh& source, const Transform& transform) {
        return appendMesh(source, transform, mesh);
    });
    if (!valid) {
        return fail(ErrorCode::kInvalidInput,
                    mesh.name + ": a face uses a vertex that does not exist; export the mesh again");
    }
    if (mesh.triangles.empty()) {
        return fail(ErrorCode::kInvalidInput,
                    mesh.name + ": no triangles; export the surface as polygons, not as points or lines");
    }
    return finishMesh(std::move(mesh));
}

Result<TriangleMesh> importWithAssimp(const fs::path& path, std::span<const std::byte> bytes,
                                      TriangleMesh mesh) {
    ReadOnlyFiles::Read others;
    Assimp::Importer importer;
    importer.SetIOHandler(new ReadOnlyFiles(path.string(), bytes, others));  // owned by the importer
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    // Without it, files that hold bones alone get a made-up mesh.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    const aiScene* scene = importer.ReadFile(path.string(), aiProcess_Triangulate | aiProcess_SortByPType);
    if (scene == nullptr || scene->mRootNode == nullptr) {
        const std::string words = oneLine(importer.GetErrorString());
        return fail(ErrorCode::kInvalidInput,
                    "cannot read the mesh " + quotedPath(path) + ": " +
                        (words.empty() ? "its contents are not what its extension says" : words) +
                        "; repair the file or export it again");
    }
    mesh.dependencies = {path.string()};
    mesh.dependency_hashes = {mesh.content_hash};
    for (const auto& [file, hash] : others) {
        mesh.dependencies.push_back(file);
        mesh.dependency_hashes.push_back(hash);
    }
    return flatten(*scene, std::move(mesh));
}

// --- a thread with a deep stack ---

struct Import {
    const fs::path& path;
    std::span<const std::byte> bytes;
    TriangleMesh mesh;
    std::optional<Result<TriangleMesh>> result;

    void run() {
        const std::string where = "cannot read the mesh " + quotedPath(path) + ": ";
        try {
            result.emplace(importWithAssimp(path, bytes, std::move(mesh)));
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

std::string lowerCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

}  // namespace

Result<TriangleMesh> importMesh(const fs::path& path) {
    const Result<std::vector<std::byte>> bytes = readFile(path);
    if (!bytes) {
        return forward(bytes);
    }
    const std::string extension = lowerCase(path.extension().string());
    if (extension.empty() || !Assimp::Importer().IsExtensionSupported(extension)) {
        return fail(ErrorCode::kUnsupported,
                    quotedPath(path) + ": no mesh format has the extension '" + cleanUtf8(extension) +
                        "'; use one of " + std::string(kSomeExtensions) + " or another that assimp reads");
    }
    if (bytes->empty()) {
        return fail(ErrorCode::kInvalidInput,
                    quotedPath(path) + ": the file is empty; export the mesh again");
    }
    TriangleMesh mesh;
    mesh.name = cleanUtf8(path.filename().string(), kMeshNameMax);
    mesh.content_hash = xxh3_128Hex(*bytes);
    mesh.unit = extension == ".gltf" || extension == ".glb" ? "m" : "";

    Import import{path, *bytes, std::move(mesh), std::nullopt};
    if (!runOnDeepStack(import)) {
        return fail(ErrorCode::kFailure,
                    quotedPath(path) + ": no thread could be started to read it; free some memory");
    }
    return std::move(*import.result);
}

}  // namespace relief
