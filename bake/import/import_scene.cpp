#include "bake/import/import_scene.h"

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "bake/import/import_instances.h"
#include "bake/import/polygon_cutter.h"

namespace relief {
namespace {

/// What assimp adds to nodes of FBX that it splits.
constexpr std::string_view kHelperNode = "_$AssimpFbx$_";

Transform transformOf(const aiMatrix4x4& m) {
    return {glm::dmat3(m.a1, m.b1, m.c1, m.a2, m.b2, m.c2, m.a3, m.b3, m.c3), {m.a4, m.b4, m.c4}};
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
        const Transform transform = next.parent * transformOf(next.node->mTransformation);
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

std::size_t unplacedMeshes(const aiScene& scene) {
    std::set<const aiMesh*> placed;
    if (scene.mRootNode != nullptr) {
        forEachUse(scene, {},
                   [&](const aiMesh& mesh, const Transform& /*transform*/, const aiNode* /*node*/) {
                       placed.insert(&mesh);
                       return true;
                   });
    }
    const std::span meshes(scene.mMeshes, scene.mNumMeshes);
    return static_cast<std::size_t>(std::count_if(meshes.begin(), meshes.end(), [&](const aiMesh* mesh) {
        return mesh->HasPositions() && mesh->mNumFaces > 0 && placed.count(mesh) == 0;
    }));
}

std::string_view textOf(const aiString& text) {
    return {text.data, std::min<std::size_t>(text.length, sizeof(text.data))};
}

/// What assimp calls what has no name.
bool isMadeUp(std::string_view name) {
    return name == AI_DEFAULT_MATERIAL_NAME || (name.starts_with('<') && name.ends_with('>')) ||
           name.find(kHelperNode) != std::string_view::npos;
}

/// Tells NameMarks the names of a scene's triangles.
class SceneNames {
  public:
    /// \param scene  borrowed, and so is the job.
    SceneNames(const aiScene& scene, const ImportJob& job)
        : scene_(scene), marks_(job.options.names, job.file_name) {}

    [[nodiscard]] const NameMarks& marks() const { return marks_; }

    /// As TriangleMesh::marks has it, for the triangles of a mesh. \param node  that uses it.
    std::uint8_t of(const aiMesh& mesh, const aiNode* node) {
        std::vector<const aiNode*> chain;
        const aiNode* above = node;
        for (; above != nullptr && !nodes_.contains(above); above = above->mParent) {
            chain.push_back(above);
        }
        std::uint8_t mark = above != nullptr ? nodes_.at(above) : std::uint8_t{0};
        for (auto it = chain.rbegin(); it != chain.rend(); ++it) {
            mark = std::max(mark, meet(textOf((*it)->mName)));
            nodes_[*it] = mark;
        }
        return std::max({mark, meet(textOf(mesh.mName)), meetMaterial(mesh)});
    }

    /// The node, or what bears a name above it, and the material. \param node  null: none uses the mesh.
    SurfaceName surfaceOf(const aiMesh& mesh, const aiNode* node) {
        SurfaceName name;
        name.node_index =
            indices_.try_emplace(node, static_cast<std::uint32_t>(indices_.size())).first->second;
        const auto unnamed = [](std::string_view text) { return text.empty() || isMadeUp(text); };
        while (node != nullptr && unnamed(textOf(node->mName)) && node->mParent != nullptr) {
            node = node->mParent;
        }
        if (node != nullptr && node->mParent != nullptr) {  // the topmost is the file
            name.node = textOf(node->mName);
        }
        if (const std::string material = materialOf(mesh); !isMadeUp(material)) {
            name.material = material;
        }
        return name;
    }

  private:
    std::uint8_t meet(std::string_view name) { return marks_.meet(name, !isMadeUp(name)); }

    std::uint8_t meetMaterial(const aiMesh& mesh) {
        const std::string name = materialOf(mesh);
        return name.empty() ? std::uint8_t{0} : meet(name);
    }

    /// "" without one.
    [[nodiscard]] std::string materialOf(const aiMesh& mesh) const {
        aiString name;
        return mesh.mMaterialIndex < scene_.mNumMaterials &&
                       scene_.mMaterials[mesh.mMaterialIndex]->Get(AI_MATKEY_NAME, name) == AI_SUCCESS
                   ? std::string(textOf(name))
                   : std::string();
    }

    const aiScene& scene_;
    NameMarks marks_;
    std::map<const aiNode*, std::uint8_t> nodes_;     // with those above them
    std::map<const aiNode*, std::uint32_t> indices_;  // of nodes that use a mesh
};

/// \param out  is cleared.
void trianglesOf(const aiMesh& mesh, std::vector<glm::uvec3>& out) {
    out.clear();
    for (const aiFace& face : std::span(mesh.mFaces, mesh.mNumFaces)) {
        if (face.mNumIndices == 3) {
            out.emplace_back(face.mIndices[0], face.mIndices[1], face.mIndices[2]);
        }
    }
}

/// \param out  is cleared.
void positionsOf(const aiMesh& mesh, std::vector<glm::vec3>& out) {
    out.clear();
    for (const aiVector3D& v : std::span(mesh.mVertices, mesh.mNumVertices)) {
        out.emplace_back(v.x, v.y, v.z);
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
    parts.unplaced = unplacedMeshes(scene);
    for (const aiMesh* mesh : std::span(scene.mMeshes, scene.mNumMeshes)) {
        if (!mesh->HasPositions()) {
            continue;
        }
        std::vector<std::uint8_t> used(mesh->mNumVertices, 0);
        for (const aiFace& face : std::span(mesh->mFaces, mesh->mNumFaces)) {
            const bool polygon = face.mNumIndices >= 3;
            parts.polygons += polygon ? 1 : 0;
            parts.lines += face.mNumIndices == 2 ? 1 : 0;
            parts.points += face.mNumIndices == 1 ? 1 : 0;
            for (const unsigned index : std::span(face.mIndices, face.mNumIndices)) {
                used[index] |= polygon ? kByPolygon : kByOther;
            }
        }
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

void triangulate(aiScene& scene) {
    PolygonCutter cutter;
    std::vector<glm::vec3> corners;
    std::vector<glm::uvec3> triangles;
    for (aiMesh* mesh : std::span(scene.mMeshes, scene.mNumMeshes)) {
        const std::span faces(mesh->mFaces, mesh->mNumFaces);
        std::size_t count = 0;
        for (const aiFace& face : faces) {
            count += face.mNumIndices > 3 ? face.mNumIndices - 2 : 1;
        }
        if (count == faces.size()) {
            continue;
        }
        auto* const cut = new aiFace[count];
        aiFace* next = cut;
        TriangleStarts starts;
        for (aiFace& face : faces) {
            if (face.mNumIndices < 3) {
                next->mNumIndices = face.mNumIndices;
                next->mIndices = std::exchange(face.mIndices, nullptr);
                ++next;
                continue;
            }
            corners.clear();
            for (const unsigned index : std::span(face.mIndices, face.mNumIndices)) {
                const aiVector3D& v = mesh->mVertices[index];
                corners.emplace_back(v.x, v.y, v.z);
            }
            triangles.clear();
            for (const glm::uvec3& t : cutter.cut(corners)) {
                triangles.emplace_back(face.mIndices[t.x], face.mIndices[t.y], face.mIndices[t.z]);
            }
            starts.turn(triangles);
            for (const glm::uvec3& t : triangles) {
                next->mNumIndices = 3;
                next->mIndices = new unsigned[3]{t.x, t.y, t.z};
                ++next;
            }
        }
        delete[] mesh->mFaces;
        mesh->mFaces = cut;
        mesh->mNumFaces = static_cast<unsigned>(count);
        mesh->mPrimitiveTypes &= ~static_cast<unsigned>(aiPrimitiveType_POLYGON);
        mesh->mPrimitiveTypes |= aiPrimitiveType_TRIANGLE;
    }
}

Result<TriangleMesh> flatten(const aiScene& scene, const glm::dmat3& linear, const ImportJob& job,
                             TriangleMesh mesh) {
    const Transform root{linear, glm::dvec3(0.0)};
    MeshInstances instances(job.shown, job.triangle_max, std::move(mesh));
    const bool counted = forEachUse(
        scene, root, [&](const aiMesh& source, const Transform& transform, const aiNode* /*node*/) {
            return instances.count(source.mNumVertices, source.mNumFaces, transform);
        });
    if (!counted) {
        return instances.tooMany();
    }
    SceneNames names(scene, job);
    instances.begin(names.marks().any());
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    forEachUse(scene, root, [&](const aiMesh& source, const Transform& transform, const aiNode* node) {
        positionsOf(source, positions);
        trianglesOf(source, triangles);
        const std::uint8_t mark = names.marks().any() && !triangles.empty() ? names.of(source, node) : 0;
        if (!triangles.empty()) {
            instances.surface(names.surfaceOf(source, node));
        }
        instances.add(positions, triangles, transform, mark);
        return true;
    });
    return instances.finish(names.marks());
}

}  // namespace relief
