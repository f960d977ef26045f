// SPDX-License-Identifier: Apache-2.0
// A level: each different mesh of a file once, however many nodes place it.
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
    std::string name;  ///< of the file
    std::string unit;  ///< "m" or ""
    /// As finishMesh leaves them, each in its own space; content_hash is that of their positions and triangles. No two are
    /// equal, marks included.
    std::vector<TriangleMesh> meshes;
    std::vector<LevelBody> bodies;          ///< in the order of the file; every mesh has one at least
    std::vector<std::string> dependencies;  ///< as those of a TriangleMesh, with their hashes
    std::vector<std::string> dependency_hashes;
    std::vector<std::string> warnings;
};

/// XXH3-128 of its materials, and of which triangle has which.
[[nodiscard]] std::string materialHash(const TriangleMesh& mesh);

/// Whether not all of their surface is of one name.
[[nodiscard]] bool hasSeveralMaterials(std::span<const TriangleMesh> meshes);

/// The meshes of a level, equal ones joined.
class LevelMeshes {
  public:
    /// \param mesh  as finishMesh leaves it; its content_hash is made. \return its index.
    /// \param materials  meshes of other materials are not equal.
    std::uint32_t add(TriangleMesh mesh, bool materials);
    [[nodiscard]] std::vector<TriangleMesh> take() { return std::move(meshes_); }

  private:
    std::vector<TriangleMesh> meshes_;
    /// By hash, marks and materials.
    std::map<std::tuple<std::string, std::vector<std::uint8_t>, std::string>, std::uint32_t> known_;
};

/// importMeshInWorker() of a level: in glTF the meshes of nodes, in OBJ each object or group, a placement each.
/// `limits.triangles` counts each mesh once. Errors: also kLimit (kLevelMeshesMax, kLevelBodiesMax).
[[nodiscard]] Result<Level> importLevelInWorker(const std::filesystem::path& path,
                                                const ImportOptions& options = {},
                                                const ImportLimits& limits = {});

/// Cuts the meshes of a level apart, finishes them, and joins equal ones. Those without any area are left out with their
/// bodies and a warning.
/// \param all  with name and hash. Its lists of meshes and bodies may hold anything.
/// \param materials  as of LevelMeshes::add().
/// Errors: kInvalidInput (lists that do not fit, no mesh that is left), without the file's path.
[[nodiscard]] Result<Level> cutLevel(TriangleMesh all, bool materials = true);

}  // namespace relief
