// SPDX-License-Identifier: Apache-2.0
// OBJ, OFF, PLY and STL, and format detection: any input gives polygons with valid corners, or a one-line error.
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "bake/import/import_format.h"
#include "bake/import/import_readers.h"
#include "bake/import/import_scene.h"
#include "bake/import/polygon_cutter.h"
#include "formats/polygons/polygon_mesh.h"
#include "tests/fuzz/target.h"

namespace {

void mustBePolygons(const relief::PolygonMesh& mesh) {
    const std::uint64_t corners = std::accumulate(mesh.sizes.begin(), mesh.sizes.end(), std::uint64_t{0});
    mustHold(corners == mesh.corners.size(), "each corner belongs to a polygon");
    for (const std::uint32_t size : mesh.sizes) {
        mustHold(size > 0, "a polygon has a corner");
    }
    for (const std::uint32_t corner : mesh.corners) {
        mustHold(corner < mesh.positions.size(), "corners exist");
    }
    for (const std::string& warning : mesh.warnings) {
        mustBeLine(warning);
    }
}

/// Format detection before a reader runs.
void mustDetectFormats(std::span<const std::byte> bytes) {
    for (const char* extension : {"obj", "stl", "dae", "glb", "blend"}) {
        mustHold(relief::otherFormat(extension, bytes) != extension,
                 "the other format differs from the extension");
    }
}

void mustBeRead(const relief::Result<relief::PolygonMesh>& mesh) {
    if (!mesh) {
        mustBeLine(mesh.error().message);
        return;
    }
    mustBePolygons(*mesh);
    const relief::MeshParts parts = relief::partsOf(*mesh);
    mustHold(parts.loose <= parts.unused && parts.unused <= parts.vertices, "loose vertices are unused");
    relief::PolygonCutter cutter;
    std::vector<glm::vec3> places;
    std::size_t first = 0;
    for (const std::uint32_t size : mesh->sizes) {
        places.clear();
        for (std::size_t i = first; i < first + size; ++i) {
            places.push_back(mesh->positions[mesh->corners[i]]);
        }
        first += size;
        mustHold(size < 3 || cutter.cut(places).size() == size - 2, "a polygon becomes its triangles");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto bytes = std::as_bytes(std::span(data, size));
    mustDetectFormats(bytes);
    mustBeRead(relief::readOff(bytes));
    mustBeRead(relief::readStl(bytes));
    const relief::Result<relief::ObjMesh> obj = relief::readObj(bytes);
    mustBeRead(obj ? relief::Result<relief::PolygonMesh>(obj->polygons) : tl::unexpected(obj.error()));
    const relief::Result<relief::PolygonMesh> ply = relief::readPly(bytes);
    mustHold(!ply || !ply->sizes.empty(), "a PLY has a polygon");
    mustBeRead(ply);
    return 0;
}
