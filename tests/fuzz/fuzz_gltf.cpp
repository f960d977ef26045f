// SPDX-License-Identifier: Apache-2.0
// glTF and GLB: any input gives triangles with valid positions, or a one-line error.
#include <algorithm>
#include <span>
#include <string>

#include "bake/import/import_readers.h"
#include "bake/import/import_scene.h"
#include "formats/animation/animated_mesh.h"
#include "tests/fuzz/target.h"

namespace {

constexpr std::uint64_t kTriangles = 10'000;

bool isLine(const std::string& text) {
    return text.find_first_of(std::string_view("\n\r\x1b\0", 4)) == std::string::npos;
}

void mustBeTriangles(const relief::TriangleMesh& mesh, std::size_t names) {
    mustHold(!mesh.triangles.empty() && mesh.triangles.size() <= kTriangles, "a mesh has some triangles");
    mustHold(mesh.marks.size() == (names > 0 ? mesh.triangles.size() : 0),
             "each triangle has a mark, or none has");
    for (const glm::uvec3& t : mesh.triangles) {
        mustHold(std::max({t.x, t.y, t.z}) < mesh.positions.size(), "corners exist");
    }
    for (const std::uint8_t mark : mesh.marks) {
        mustHold(mark <= names, "marks have names");
    }
    for (const std::string& warning : mesh.warnings) {
        mustHold(isLine(warning), "a warning is one line");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    relief::ImportJob job;
    job.shown = "'m.gltf'";
    job.file_name = "m.gltf";
    job.extension = "gltf";
    job.bytes = std::as_bytes(std::span(data, size));
    job.triangle_max = kTriangles;
    for (const bool named : {false, true}) {
        job.options.names = named ? std::vector<std::string>{"paint"} : std::vector<std::string>();
        relief::ImportFiles files(-1, job.file_name, job.bytes);
        const relief::Result<relief::TriangleMesh> mesh =
            readGltf(job, files).and_then([&](relief::ImportScene scene) {
                return flatten(std::move(scene), job);
            });
        if (mesh) {
            mustBeTriangles(*mesh, job.options.names.size());
            continue;
        }
        const std::string& words = mesh.error().message;
        mustHold(isLine(words), "an error is one line");
    }
    job.options.names.clear();
    for (const relief::ImportKind kind : {relief::ImportKind::kAnimated, relief::ImportKind::kClips}) {
        job.kind = kind;
        relief::ImportFiles files(-1, job.file_name, job.bytes);
        const relief::Result<relief::TriangleMesh> mesh = readAnimatedGltf(job, files);
        mustHold(mesh || isLine(mesh.error().message), "an error is one line");
        mustHold(!mesh || (kind == relief::ImportKind::kClips ? relief::readAnimatedClips(mesh->animation)
                                                              : relief::readAnimatedMesh(mesh->animation)),
                 "an animated mesh can be read back");
    }
    return 0;
}
