// SPDX-License-Identifier: Apache-2.0
// AC3D: any input gives polygons with valid corners and nodes that form trees, or a one-line error.
#include <span>
#include <string>
#include <vector>

#include "bake/import/import_readers.h"
#include "tests/fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    relief::ImportJob job;
    job.file_name = "fuzz.ac";
    job.extension = "ac";
    job.bytes = std::as_bytes(std::span(data, size));
    job.triangle_max = 100'000;
    const relief::Result<relief::ImportScene> scene = relief::readAc3d(job);
    if (!scene) {
        mustBeLine(scene.error().message);
        return 0;
    }
    std::uint64_t triangles = 0;
    for (const relief::ScenePart& part : scene->parts) {
        triangles += part.triangles.size();
        for (const glm::uvec3& t : part.triangles) {
            mustHold(
                t.x < part.positions.size() && t.y < part.positions.size() && t.z < part.positions.size(),
                "corners exist");
        }
    }
    mustHold(triangles <= job.triangle_max, "no more triangles than allowed");
    std::vector<int> parents(scene->nodes.size(), 0);
    for (std::uint32_t i = 0; i < scene->nodes.size(); ++i) {
        for (const std::uint32_t child : scene->nodes[i].children) {
            mustHold(child > i && child < parents.size(), "children follow their parents");
            ++parents[child];
        }
        for (const std::uint32_t part : scene->nodes[i].parts) {
            mustHold(part < scene->parts.size(), "parts exist");
        }
    }
    for (const std::uint32_t root : scene->roots) {
        ++parents[root];
    }
    for (const int count : parents) {
        mustHold(count == 1, "each node has one parent or is a root");
    }
    const relief::MeshParts& counts = scene->counts;
    mustHold(counts.loose <= counts.unused && counts.unused <= counts.vertices, "loose vertices are unused");
    return 0;
}
