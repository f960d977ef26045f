#include "runtime/files/mesh_file.h"

#include <string>

#include "formats/base/file_io.h"
#include "formats/base/text.h"

namespace relief {

bool addPolygon(std::span<const std::uint32_t> corners, PictureMesh& mesh) {
    if (mesh.triangles.size() / 3 + corners.size() > kMeshTrianglesMax + 2) {
        return false;
    }
    for (std::size_t i = 2; i < corners.size(); ++i) {
        mesh.triangles.insert(mesh.triangles.end(), {corners[0], corners[i - 1], corners[i]});
    }
    return true;
}

Result<PictureMesh> loadPictureMesh(const std::filesystem::path& path) {
    const std::string extension = lowerCase(path.extension().native());
    if (extension != ".obj" && extension != ".ply") {
        return fail(
            ErrorCode::kUnsupported,
            quotedPath(path) + " is no mesh that a picture can be drawn from; convert it to .obj or .ply");
    }
    const auto bytes = RELIEF_TRY(readFile(path, kMeshBytesMax));
    const std::string name = quotedPath(path);
    if (extension == ".obj") {
        return parseObj({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name);
    }
    return parsePlyMesh(bytes, name);
}

}  // namespace relief
