// SPDX-License-Identifier: Apache-2.0
// Reads Wavefront OBJ: the statements v, f, l, p, g, o, usemtl and mtllib. Free-form surfaces are counted; all other
// statements are skipped. assimp 5.2 is not used because it reads `0,5` as 0 and rejects comments and `\` after a face
// (import_text_test.cpp, Obj). The runtime also needs this reader and does not link assimp.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "formats/polygons/polygon_mesh.h"

namespace relief {

struct ObjMesh {
    PolygonMesh polygons;
    std::vector<std::string> libraries;  ///< material libraries, as named by mtllib
};

/// Reads a mesh. Statements may be indented, continued by a backslash, and followed by a comment. A vertex has three
/// coordinates, optionally followed by a weight that divides them or by a colour in 0…1. Corners are "7", "7/1", "7//3"
/// or "7/1/3"; negative indices count back from the last vertex so far. Faces may precede their vertices. A face has
/// the name of its material, and the names of the current group or object, whichever started last. The names of a group
/// are its whole line and each of its words. A new material does not end the group. Errors, with the line but not the
/// file: kInvalidInput.
[[nodiscard]] Result<ObjMesh> readObj(std::span<const std::byte> bytes,
                                      PolygonColors colors = PolygonColors::kSkip);

}  // namespace relief
