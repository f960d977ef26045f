#include "bake/import/assimp_ply.h"

#include <assimp/importerdesc.h>
#include <assimp/scene.h>

#include <algorithm>

namespace relief {

const aiImporterDesc* PlyLoader::GetInfo() const {
    static const aiImporterDesc kInfo = [] {
        aiImporterDesc info{};
        info.mName = "PLY";
        info.mFileExtensions = "ply";
        return info;
    }();
    return &kInfo;
}

void PlyLoader::InternReadFile(const std::string& /*path*/, aiScene* scene, Assimp::IOSystem* /*files*/) {
    auto* const mesh = new aiMesh;
    scene->mNumMeshes = 1;
    scene->mMeshes = new aiMesh* [1] { mesh };
    scene->mRootNode = new aiNode;
    scene->mRootNode->mNumMeshes = 1;
    scene->mRootNode->mMeshes = new unsigned[1]{0};
    mesh->mNumVertices = static_cast<unsigned>(mesh_.positions.size());
    mesh->mVertices = new aiVector3D[mesh->mNumVertices];
    std::transform(mesh_.positions.begin(), mesh_.positions.end(), mesh->mVertices,
                   [](const glm::vec3& p) { return aiVector3D(p.x, p.y, p.z); });
    mesh->mNumFaces = static_cast<unsigned>(mesh_.sizes.size());
    mesh->mFaces = new aiFace[mesh->mNumFaces];
    const std::uint32_t* corner = mesh_.corners.data();
    for (unsigned i = 0; i < mesh->mNumFaces; ++i) {
        aiFace& face = mesh->mFaces[i];
        face.mNumIndices = mesh_.sizes[i];
        face.mIndices = new unsigned[face.mNumIndices];
        std::copy_n(corner, face.mNumIndices, face.mIndices);
        corner += face.mNumIndices;
    }
    mesh_ = {};
}

}  // namespace relief
