// PLY for assimp: what import_ply.h has read, so that its polygons are triangulated as those of the other formats.
#pragma once

#include <assimp/BaseImporter.h>

#include "bake/import/import_ply.h"

namespace relief {

/// A reader for Assimp::Importer::RegisterLoader. It gives the same scene for whatever file it is asked for.
class PlyLoader final : public Assimp::BaseImporter {
  public:
    explicit PlyLoader(PlyMesh mesh) : mesh_(std::move(mesh)) {}

    bool CanRead(const std::string& /*path*/, Assimp::IOSystem* /*files*/,
                 bool /*signature*/) const override {
        return true;
    }
    [[nodiscard]] const aiImporterDesc* GetInfo() const override;

  private:
    void InternReadFile(const std::string& path, aiScene* scene, Assimp::IOSystem* files) override;

    PlyMesh mesh_;  // empty once the scene has it
};

}  // namespace relief
