#include "bake/import/import_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "formats/base/hash.h"

namespace relief {
namespace {

/// A transform whose determinant is this small, relative to the product of its columns' lengths, leaves no volume.
constexpr double kFlat = 1e-9;

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

/// Calls visit(mesh, transform, node) for every use of a mesh, parents before children. No recursion.
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
                !visit(*scene.mMeshes[index], transform, next.node)) {
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

std::vector<const aiMesh*> unplacedMeshes(const aiScene& scene) {
    std::set<const aiMesh*> placed;
    if (scene.mRootNode != nullptr) {
        forEachUse(scene, {},
                   [&](const aiMesh& mesh, const Transform& /*transform*/, const aiNode* /*node*/) {
                       placed.insert(&mesh);
                       return true;
                   });
    }
    std::vector<const aiMesh*> others;
    for (const aiMesh* mesh : std::span(scene.mMeshes, scene.mNumMeshes)) {
        if (mesh->HasPositions() && mesh->mNumFaces > 0 && placed.count(mesh) == 0) {
            others.push_back(mesh);
        }
    }
    return others;
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

}  // namespace

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

MeshParts partsOf(const aiScene& scene) {
    constexpr std::uint8_t kByPolygon = 1;
    constexpr std::uint8_t kByOther = 2;
    MeshParts parts;
    parts.meshes = scene.mNumMeshes;
    parts.unplaced = unplacedMeshes(scene).size();
    // The meshes of a glTF file often share one list of vertices, of which each uses a part; assimp gives each a copy.
    std::map<std::string, std::vector<std::uint8_t>> uses;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[m];
        if (!mesh.HasPositions()) {
            continue;
        }
        const std::span vertices(mesh.mVertices, mesh.mNumVertices);
        std::vector<std::uint8_t>& used =
            uses[scene.mNumMeshes == 1 ? std::string() : xxh3_128Hex(std::as_bytes(vertices))];
        used.resize(vertices.size());
        for (const aiFace& face : std::span(mesh.mFaces, mesh.mNumFaces)) {
            const bool polygon = face.mNumIndices >= 3;
            parts.polygons += polygon ? 1 : 0;
            parts.lines += face.mNumIndices == 2 ? 1 : 0;
            parts.points += face.mNumIndices == 1 ? 1 : 0;
            for (const unsigned index : std::span(face.mIndices, face.mNumIndices)) {
                used[index] |= polygon ? kByPolygon : kByOther;
            }
        }
    }
    for (const auto& [hash, used] : uses) {
        parts.vertices += used.size();
        for (const std::uint8_t use : used) {
            parts.unused += (use & kByPolygon) == 0 ? 1 : 0;
            parts.loose += use == 0 ? 1 : 0;
        }
    }
    return parts;
}

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

Result<TriangleMesh> flatten(const aiScene& scene, const glm::dmat3& linear, const std::string& shown,
                             Unplaced unplaced, NameMarks names, TriangleMesh mesh) {
    const Transform root{linear, glm::dvec3(0.0)};
    const std::vector<const aiMesh*> others =
        unplaced == Unplaced::kAtRoot ? unplacedMeshes(scene) : std::vector<const aiMesh*>();
    const auto for_each_use = [&](const auto& visit) {
        return forEachUse(scene, root, visit) &&
               std::all_of(others.begin(), others.end(),
                           [&](const aiMesh* other) { return visit(*other, root, nullptr); });
    };
    // Counted before anything is allocated: a small file can name one mesh very often.
    std::uint64_t faces = 0;
    std::uint64_t vertices = 0;
    std::uint64_t flat = 0;
    const auto count = [&](const aiMesh& source, const Transform& transform, const aiNode* /*node*/) {
        faces += source.mNumFaces;
        vertices += source.mNumVertices;
        flat += transform.flattens() ? 1 : 0;
        return faces <= kTriangleMax && vertices <= 3 * kTriangleMax;
    };
    if (!for_each_use(count)) {
        return fail(ErrorCode::kLimit, shown + ": more than " + std::to_string(kTriangleMax) +
                                           " triangles, instances counted one by one; simplify the mesh");
    }
    mesh.positions.reserve(vertices);
    mesh.triangles.reserve(faces);
    mesh.marks.reserve(names.any() ? faces : 0);
    for_each_use([&](const aiMesh& source, const Transform& transform, const aiNode* node) {
        const std::size_t before = mesh.triangles.size();
        appendMesh(source, transform, mesh);
        if (names.any() && mesh.triangles.size() > before) {
            mesh.marks.resize(mesh.triangles.size(), names.of(source, node));
        }
        return true;
    });
    if (mesh.triangles.empty()) {
        return fail(ErrorCode::kInvalidInput,
                    shown + ": no triangles; export the surface as polygons, not as points or lines");
    }
    RELIEF_TRY(names.allMet(shown));
    if (flat > 0) {
        mesh.warnings.push_back(std::to_string(flat) +
                                " of its parts are scaled to nothing in some direction, and hold no volume");
    }
    return mesh;
}

}  // namespace relief
