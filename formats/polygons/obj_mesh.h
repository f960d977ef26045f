// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ: the statements v, f, l, p, g, o, usemtl and mtllib. Free forms are counted, all other statements passed
// over. Not by assimp 5.2, which reads `0,5` as 0 and rejects comments and `\` behind a face (import_text_test.cpp, Obj); the
// runtime, which links no assimp, needs it too.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "formats/polygons/polygon_mesh.h"

namespace relief {

struct ObjMesh {
    PolygonMesh polygons;
    std::vector<std::string> libraries;  ///< of materials, as mtllib names them
};

/// Statements may be indented, continued by a backslash, and followed by a comment. A vertex has three coordinates, a weight
/// by which they are divided, or a colour, 0…1, behind them. Corners are "7", "7/1", "7//3" or "7/1/3"; below 0 they count back
/// from the last vertex so far. Faces may come before their vertices. A face has the names of its material, and of what was
/// begun last, its group or its object: a group's line as a whole and each of its words. The group goes on where a material
/// begins.
/// Errors, naming the line but not the file: kInvalidInput.
[[nodiscard]] Result<ObjMesh> readObj(std::span<const std::byte> bytes,
                                      PolygonColors colors = PolygonColors::kSkip);

}  // namespace relief
