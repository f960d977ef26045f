// Which side of its triangles is out: decided by rays and volumes, not by the order of their corners in a
// file.
#pragma once

#include <cstdint>

#include "bake/mesh/prepared_mesh.h"
#include "formats/base/result.h"

namespace relief {

struct Winding {
    PreparedMesh mesh;         ///< the same triangles in the same order
    std::uint64_t turned = 0;  ///< triangles whose second and third corner changed places
};

/// Turns triangles until those that share an edge run along it in opposite directions, and each patch of them
/// looks outwards. A patch hangs together by edges of two triangles. One that is closed looks out of its
/// volume, or into the hollow, if all of it lies inside an odd number of others. An open one looks where rays
/// (by parity) find the outside behind most of it. Where neither is clear, on sheets, it keeps what
/// most of its triangles say.
///
/// A mesh of one patch that is wound consistently stays as it is, inside out or not: orientation() tells. It keeps its
/// edges() too, which shapeMesh asks for next; those of others are freed.
/// The same for any number of threads.
/// Errors: those of MeshQuery::build.
/// \param mesh  move it: a mesh that is shared is copied.
[[nodiscard]] Result<Winding> windOutwards(PreparedMesh mesh);

}  // namespace relief
