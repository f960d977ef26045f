// SPDX-License-Identifier: Apache-2.0
#include "runtime/files/mesh_file.h"

#include "formats/base/file_io.h"
#include "formats/base/result.h"
#include "formats/base/text.h"
#include "formats/polygons/polygon_mesh.h"

namespace relief {
namespace {

tl::unexpected<Error> tooMany(std::size_t limit, const char* things) {
    return fail(ErrorCode::kLimit,
                "it has more than " + std::to_string(limit) + " " + things + "; simplify the mesh");
}

Result<NamedMesh> triangulated(PolygonMesh polygons) {
    if (polygons.positions.size() > kMeshVerticesMax) {
        return tooMany(kMeshVerticesMax, "vertices");
    }
    NamedMesh named;
    PictureMesh& mesh = named.mesh;
    mesh.positions = std::move(polygons.positions);
    mesh.colors = std::move(polygons.colors);
    const std::uint32_t* corner = polygons.corners.data();
    auto group = polygons.groups.begin();
    for (std::size_t polygon = 0; polygon < polygons.sizes.size(); ++polygon) {
        for (; group != polygons.groups.end() && group->begin <= polygon; ++group) {
            named.parts.push_back({mesh.triangles.size() / 3, group->node, group->material});
        }
        const std::uint32_t size = polygons.sizes[polygon];
        if (mesh.triangles.size() / 3 + size > kMeshTrianglesMax + 2) {
            return tooMany(kMeshTrianglesMax, "triangles");
        }
        for (std::uint32_t i = 2; i < size; ++i) {
            mesh.triangles.insert(mesh.triangles.end(), {corner[0], corner[i - 1], corner[i]});
        }
        corner += size;
    }
    if (mesh.triangles.empty()) {
        return invalidInput("it has no faces");
    }
    RELIEF_TRY(checkMesh(mesh));
    return named;
}

Result<PolygonMesh> readPolygons(std::span<const std::byte> bytes, std::string_view extension) {
    if (extension == ".ply") {
        return readPly(bytes, PolygonColors::kRead);
    }
    return std::move(RELIEF_TRY(readObj(bytes, PolygonColors::kRead)).polygons);
}

Result<NamedMesh> parseNamedMesh(std::span<const std::byte> bytes, std::string_view extension,
                                 const std::string& name) {
    return withPrefix(name, readPolygons(bytes, extension).and_then(triangulated));
}

}  // namespace

Result<PictureMesh> parsePictureMesh(std::span<const std::byte> bytes, std::string_view extension,
                                     const std::string& name) {
    return std::move(RELIEF_TRY(parseNamedMesh(bytes, extension, name)).mesh);
}

Result<PictureMesh> loadPictureMesh(const std::filesystem::path& path) {
    return std::move(RELIEF_TRY(loadNamedMesh(path)).mesh);
}

Result<NamedMesh> loadNamedMesh(const std::filesystem::path& path) {
    const std::string extension = lowerCase(path.extension().native());
    if (extension != ".obj" && extension != ".ply") {
        return fail(ErrorCode::kUnsupported,
                    quotedPath(path) + " is not a supported mesh file; convert it to .obj or .ply");
    }
    return parseNamedMesh(RELIEF_TRY(readFile(path, kMeshBytesMax)), extension, quotedPath(path));
}

}  // namespace relief
