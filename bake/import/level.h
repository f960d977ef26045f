// SPDX-License-Identifier: Apache-2.0
// Imports a level: each distinct mesh of a file once, with all the nodes that place it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bake/import/import_job.h"
#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

inline constexpr std::size_t kLevelMeshesMax = 4096;
inline constexpr std::size_t kLevelBodiesMax = 65'536;

struct Level {
    std::string name;  ///< name of the file or folder
    std::string unit;  ///< "m" or ""
    /// After finishMesh(), each in its own space. `content_hash` covers positions and triangles. No two meshes are
    /// equal in geometry, TriangleMesh::marks and materials.
    std::vector<TriangleMesh> meshes;
    std::vector<LevelBody> bodies;          ///< in file order; every mesh has at least one
    std::vector<std::string> dependencies;  ///< as in TriangleMesh
    std::vector<std::string> dependency_hashes;
    std::vector<std::string> warnings;
};

/// XXH3-128 of the materials and of their assignment to triangles.
[[nodiscard]] std::string materialHash(const TriangleMesh& mesh);

/// Whether the surfaces have more than one material name.
[[nodiscard]] bool hasSeveralMaterials(std::span<const TriangleMesh> meshes);

/// Collects the meshes of a level, and merges equal ones.
class LevelMeshes {
  public:
    /// Adds a mesh, and computes its content_hash. \param mesh  after finishMesh().
    /// \param materials  true: meshes that differ only in materials stay separate.
    /// \return its index.
    std::uint32_t add(TriangleMesh mesh, bool materials);
    [[nodiscard]] std::vector<TriangleMesh> take() { return std::move(meshes_); }

  private:
    std::vector<TriangleMesh> meshes_;
    /// By hash, marks and materials.
    std::map<std::tuple<std::string, std::vector<std::uint8_t>, std::string>, std::uint32_t> known_;
};

/// Imports a level like importMeshInWorker(). In glTF, each node places its mesh; in OBJ, each object or group is a
/// mesh with one placement. `limits.triangles` counts each mesh once. Errors: also kLimit (kLevelMeshesMax,
/// kLevelBodiesMax).
[[nodiscard]] Result<Level> importLevelInWorker(const std::filesystem::path& path,
                                                const ImportOptions& options = {},
                                                const ImportLimits& limits = {});

/// Imports a file as importLevelInWorker() does. In a folder, imports each mesh file as one mesh without a
/// transform, sorted by name; skips other files and subfolders.
/// \param path  a file or a folder.
/// Errors: those of importLevelInWorker; for a folder also kUsage (ImportOptions::names is not empty), kInvalidInput
/// (no mesh file, or only some have a unit), kLimit.
[[nodiscard]] Result<Level> importLevel(const std::filesystem::path& path, const ImportOptions& options = {},
                                        const ImportLimits& limits = {});

/// Splits a level into its meshes, finishes them, and merges equal ones. Skips meshes without area and their bodies,
/// with a warning.
/// \param all        its name is set; its lists of meshes and bodies are untrusted.
/// \param materials  as in LevelMeshes::add().
/// Errors, without the file path: kInvalidInput (inconsistent lists, or no mesh left).
[[nodiscard]] Result<Level> splitLevel(TriangleMesh all, bool materials = true);

}  // namespace relief
