// SPDX-License-Identifier: Apache-2.0
// Classifies the open parts of a mesh (solids with holes, sheets, terrains), and closes parts with holes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "bake/mesh/prepared_mesh.h"
#include "bake/shape/shape_options.h"
#include "bake/shape/sheet.h"
#include "formats/base/result.h"

namespace relief {

enum class OpenKind : std::uint8_t { kHoled, kPossiblyHoled, kJoined, kSheet, kTerrain };
struct OpenRole {
    OpenKind kind = OpenKind::kSheet;
    int axis = 1;  ///< up axis of a terrain
};

struct OpenPart {
    Sheet sheet;
    ShapeAs as = ShapeAs::kAuto;
    OpenRole role;
    bool full = false;  ///< it was closed separately, into a solid
};

[[nodiscard]] double sizeOf(const Sheet& sheet);

/// Finds the solids with holes and the terrains among the open parts of a mesh.
/// \param kinds  per triangle; empty: all of one kind.
/// \param parts  number of parts of the mesh, including the closed ones.
/// Errors: those of MeshQuery::build.
[[nodiscard]] Result<void> classifyOpenParts(std::span<OpenPart> open, const PreparedMesh& mesh,
                                             std::span<const ShapeAs> kinds, std::size_t parts);

/// A part with holes, after closing.
struct ClosedPart {
    std::optional<PreparedMesh> mesh;
    bool balanced = true;  ///< Part::balanced
    bool is_body = true;   ///< a body such as a statue, possibly cut off at its foot; false: a vessel
};

/// Closes a part. Returns no mesh if the holes cannot be closed, or if the result encloses nothing.
/// \param is_body  already known to be a body.
/// \param z_is_up  +z may be up; otherwise only +y.
[[nodiscard]] Result<ClosedPart> closePart(const TriangleMesh& open, bool is_body, bool z_is_up);

}  // namespace relief
