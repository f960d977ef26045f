#include "formats/polygons/polygon_mesh.h"

namespace relief {

tl::unexpected<Error> wrongLine(std::size_t line, const std::string& what) {
    return invalidInput("line " + std::to_string(line) + ": " + what);
}

Result<void> checkTriangleCount(std::uint64_t triangles) {
    return triangles <= kPolygonTrianglesMax
               ? Result<void>()
               : fail(ErrorCode::kLimit, "it has more than " + std::to_string(kPolygonTrianglesMax) +
                                             " triangles; simplify the mesh");
}

Result<void> checkAnnounced(std::uint64_t vertices) {
    return vertices <= 3 * kPolygonTrianglesMax
               ? Result<void>()
               : fail(ErrorCode::kLimit, "its header announces " + std::to_string(vertices) +
                                             " vertices, more than the limit of " +
                                             std::to_string(3 * kPolygonTrianglesMax) +
                                             "; simplify the mesh");
}

}  // namespace relief
