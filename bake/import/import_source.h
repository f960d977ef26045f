// SPDX-License-Identifier: Apache-2.0
// Implements the steps before and after the importer, shared by imports in this process and in a worker.
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
    /// Reads the file. Errors: kUnsupported (extension), kInvalidInput (empty), and those of readFile.
    [[nodiscard]] static Result<ImportSource> open(const std::filesystem::path& path);

    /// Lower case, without the dot.
    [[nodiscard]] const std::string& extension() const { return extension_; }
    [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }
    /// Descriptor of the folder, O_PATH; -1 if it cannot be opened.
    [[nodiscard]] int folder() const { return folder_.get(); }
    void dropBytes() { bytes_ = {}; }

    /// Completes an importer's result: sets name, hash and full paths, and establishes the invariants of TriangleMesh.
    /// \param raw    untrusted: positions, triangles, marks, unit, warnings, and dependencies with their hashes.
    /// Dependencies are relative to the folder and exclude the mesh file itself.
    /// \param names  number of ImportOptions::names; if it is 0, `raw.marks` must be empty.
    /// Errors: those of finishMesh; kInvalidInput.
    [[nodiscard]] Result<TriangleMesh> finish(TriangleMesh raw, std::size_t names = 0) const;
    [[nodiscard]] Result<Level> finishLevel(TriangleMesh raw, std::size_t names = 0,
                                            bool materials = true) const;
    /// Completes an animated mesh. \param kind  kAnimated, or kClips (no vertices).
    [[nodiscard]] Result<AnimatedImport> finishAnimated(TriangleMesh raw, ImportKind kind) const;

  private:
    [[nodiscard]] tl::unexpected<Error> invalidResult(const char* what) const;
    [[nodiscard]] Result<TriangleMesh> named(TriangleMesh raw, std::size_t names) const;

    ImportSource(std::filesystem::path path, std::string extension, std::vector<std::byte> bytes);

    std::filesystem::path path_;
    std::string extension_;
    std::vector<std::byte> bytes_;
    std::string hash_;
    Descriptor folder_;
};

}  // namespace relief
