// How a collider was baked, as its container records it.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bake/mesh/prepared_mesh.h"
#include "bake/plan/map_spec.h"
#include "bake/plan/prefer.h"
#include "bake/shape/shape.h"
#include "formats/base/result.h"

namespace relief {

struct RecordedBake {
    std::vector<MapSpec> maps;
    Quality quality = Quality::kNormal;
    Prefer prefer = Prefer::kNeither;
    bool keeps_holes = false;
    std::string repair;  ///< as on the command line; empty: none
    ShapeOptions shape;  ///< thickness 0: none is recorded
    /// What a command needs beside the maps to bake alike: options and their values, quoted where they hold something that
    /// means something to a shell.
    std::vector<std::pair<std::string, std::string>> options;
    /// Every word is understood; otherwise another version baked it, or somebody made the record up.
    bool understood = true;

    /// The options but one, each word after a space.
    [[nodiscard]] std::string words(std::string_view without = {}) const;
};

/// \param options  Provenance::options; any text.
[[nodiscard]] RecordedBake recordedBake(const std::string& options);

/// The solid that a bake makes of a mesh: the mesh itself with `--holes keep`.
/// \param mesh  wound outwards.
/// Errors: those of shapeMesh.
[[nodiscard]] Result<ShapedMesh> shapedMesh(const RecordedBake& recorded, const PreparedMesh& mesh);

/// The same of the mesh as the recorded repair leaves it.
/// Errors: those of careFor and shapeMesh; kUnsupported: a repair that takes too long to be made again.
[[nodiscard]] Result<ShapedMesh> repairedMesh(const RecordedBake& recorded, const PreparedMesh& mesh);

/// A path as a word of a command line.
[[nodiscard]] std::string shellWord(const std::string& path);

}  // namespace relief
