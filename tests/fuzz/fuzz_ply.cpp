// PLY meshes, OBJ statements, and what a file is: whatever the bytes, polygons whose corners exist, or one line that names
// the file.
#include <numeric>
#include <span>
#include <string>

#include "bake/import/import_format.h"
#include "bake/import/import_obj.h"
#include "bake/import/import_ply.h"
#include "bake/import/import_text.h"
#include "tests/fuzz/target.h"

namespace {

bool isLine(const std::string& text) {
    return text.find_first_of(std::string_view("\n\r\x1b\0", 4)) == std::string::npos;
}

void mustBePolygons(const relief::PlyMesh& mesh) {
    mustHold(!mesh.sizes.empty(), "a mesh has a polygon");
    const std::uint64_t corners = std::accumulate(mesh.sizes.begin(), mesh.sizes.end(), std::uint64_t{0});
    mustHold(corners == mesh.corners.size(), "each corner belongs to a polygon");
    for (const std::uint32_t size : mesh.sizes) {
        mustHold(size > 0, "a polygon has a corner");
    }
    for (const std::uint32_t corner : mesh.corners) {
        mustHold(corner < mesh.positions.size(), "corners exist");
    }
    for (const std::string& warning : mesh.warnings) {
        mustHold(isLine(warning), "a warning is one line");
    }
}

/// Everything that is said of a file before a reader has it.
void mustBeJudged(std::span<const std::byte> bytes) {
    for (const char* extension : {"obj", "stl", "ac", "glb", "3mf"}) {
        for (const auto& words :
             {relief::noMeshAtAll(extension, bytes), relief::textFault(extension, bytes)}) {
            mustHold(!words || (isLine(*words) && words->find("; ") != std::string::npos),
                     "a fault is one line");
        }
        mustHold(relief::otherFormat(extension, bytes) != extension, "another format is another");
        const auto lower = relief::lowerCaseStl(extension, bytes);
        mustHold(!lower || lower->size() == bytes.size(), "lower case is as long");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = std::as_bytes(std::span(data, size));
    mustBeJudged(bytes);
    const relief::MeshParts parts = relief::objPartsOf(bytes);
    mustHold(parts.loose <= parts.unused && parts.unused <= parts.vertices, "loose vertices are unused ones");
    const relief::Result<relief::PlyMesh> mesh = relief::readPly(bytes, "'m.ply'");
    if (mesh) {
        mustBePolygons(*mesh);
        return 0;
    }
    mustHold(mesh.error().message.find("'m.ply'") != std::string::npos, "an error names the file");
    mustHold(isLine(mesh.error().message), "an error is one line");
    return 0;
}
