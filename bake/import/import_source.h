// SPDX-License-Identifier: Apache-2.0
// The steps of an import before and after the importer itself: the same for an import in this process and for
// one in a worker.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bake/import/animated_import.h"
#include "bake/import/level.h"
#include "bake/mesh/mesh.h"
#include "formats/base/descriptor.h"
#include "formats/base/result.h"

namespace relief {

/// A mesh file, read but not parsed.
class ImportSource {
  public:
    /// Errors: kUnsupported (extension), kInvalidInput (empty), and those of readFile.
    [[nodiscard]] static Result<ImportSource> open(const std::filesystem::path& path);

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] const std::string& extension() const { return extension_; }  ///< lower case, without dot
    [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }
    /// Descriptor, O_PATH; -1 if it cannot be opened.
    [[nodiscard]] int folder() const { return folder_.get(); }
    /// Frees bytes().
    void dropBytes() { bytes_ = {}; }

    /// Completes an importer's result: name, hash, whole paths, and the invariants of TriangleMesh.
    /// \param raw    positions, triangles, marks, unit and warnings; dependencies, relative to the folder, and their
    ///               hashes, without the mesh file itself. May be hostile.
    /// \param names  number of ImportOptions::names: with none there must be no marks.
    /// Errors: as finishMesh; kInvalidInput.
    [[nodiscard]] Result<TriangleMesh> finish(TriangleMesh raw, std::size_t names = 0) const;
    /// The same of a level, whose meshes are cut apart.
    [[nodiscard]] Result<Level> finishLevel(TriangleMesh raw, std::size_t names = 0,
                                            bool materials = true) const;
    /// The same of an animated mesh. \param kind  kAnimated, or kClips: then there are no vertices.
    [[nodiscard]] Result<AnimatedImport> finishAnimated(TriangleMesh raw, ImportKind kind) const;

  private:
    [[nodiscard]] tl::unexpected<Error> lies(const char* what) const;
    /// Name, hash and whole paths.
    [[nodiscard]] Result<TriangleMesh> named(TriangleMesh raw, std::size_t names) const;

    ImportSource(std::filesystem::path path, std::string extension, std::vector<std::byte> bytes);

    std::filesystem::path path_;
    std::string extension_;
    std::vector<std::byte> bytes_;
    std::string hash_;
    Descriptor folder_;
};

}  // namespace relief
