// SPDX-License-Identifier: Apache-2.0
// Results of the import worker: any bytes give a valid mesh, or a one-line error that names the mesh file.
#include <stdlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "bake/import/import_protocol.h"
#include "bake/import/import_source.h"
#include "tests/fuzz/target.h"

namespace {

namespace fs = std::filesystem;
using relief::ImportSource;
using relief::Result;
using relief::TriangleMesh;

constexpr double kCoordinateMax = 1e15;  // the limit of finishMesh()
constexpr std::size_t kErrorBytesMax = 5000;
constexpr std::size_t kNames = 3;  // number of requested names, for inputs with marks

/// The mesh file to which the messages belong. It is deleted after it is opened.
ImportSource openSource() {
    std::string pattern = (fs::temp_directory_path() / "relief-fuzz-XXXXXX").string();
    mustHold(::mkdtemp(pattern.data()) != nullptr, "a folder can be created");
    const fs::path path = fs::path(pattern) / "m.obj";
    std::ofstream(path) << "v 0 0 0\n";
    Result<ImportSource> source = ImportSource::open(path);
    fs::remove_all(pattern);
    mustHold(source.has_value(), "a file can be read");
    return std::move(*source);
}

std::vector<std::byte> bytesOf(const Result<TriangleMesh>& raw) {
    std::vector<std::byte> bytes(relief::importMessageSize(raw));
    relief::writeImportMessage(raw, bytes);
    return bytes;
}

void mustBeMesh(const TriangleMesh& mesh) {
    mustHold(!mesh.triangles.empty(), "a mesh has a triangle");
    std::vector<bool> used(mesh.positions.size(), false);
    for (const glm::uvec3& triangle : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            mustHold(triangle[k] < mesh.positions.size(), "indices are in range");
            used[triangle[k]] = true;
        }
    }
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        mustHold(used[i], "every position is used");
        for (int k = 0; k < 3; ++k) {
            const float x = mesh.positions[i][k];
            mustHold(std::isfinite(x) && std::abs(x) <= kCoordinateMax, "coordinates are finite");
            mustHold(x >= mesh.bounds.min[k] && x <= mesh.bounds.max[k], "coordinates are in the bounds");
        }
    }
    mustHold(mesh.marks.empty() || mesh.marks.size() == mesh.triangles.size(),
             "each triangle has a mark, or none has");
    for (const std::uint8_t mark : mesh.marks) {
        mustHold(mark <= kNames, "a mark has a name");
    }
    mustHold(mesh.unit.empty() || mesh.unit == "m", "the unit is known");
    mustHold(mesh.name == "m.obj", "the name is that of the file");
    mustHold(mesh.dependencies.size() == mesh.dependency_hashes.size(), "one hash per file");
    const std::string folder = fs::path(mesh.dependencies.at(0)).parent_path().string() + "/";
    for (std::size_t i = 0; i < mesh.dependencies.size(); ++i) {
        const fs::path normal = fs::path(mesh.dependencies[i]).lexically_normal();
        mustHold(normal.string().starts_with(folder), "files are below the mesh's folder");
        mustHold(mesh.dependency_hashes[i].size() == 32, "a hash has 128 bits");
    }
    for (const std::string& warning : mesh.warnings) {
        mustBeLine(warning);
        mustHold(warning.starts_with("m.obj: "), "a warning names the mesh");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const ImportSource kSource = openSource();
    const auto given = std::as_bytes(std::span(data, size));
    const std::vector<std::byte> bytes(given.begin(), given.end());
    Result<TriangleMesh> raw = relief::readImportMessage(bytes);
    if (!raw) {
        mustBeLine(raw.error().message);
        mustHold(raw.error().message.size() <= kErrorBytesMax, "a message is short");
        return 0;
    }
    const std::vector<std::byte> sent = bytesOf(raw);
    const Result<TriangleMesh> again = relief::readImportMessage(sent);
    mustHold(again.has_value() && bytesOf(again) == sent, "a mesh survives the message");
    const std::size_t names = raw->marks.empty() ? 0 : kNames;
    const Result<TriangleMesh> mesh = kSource.finish(std::move(*raw), names);
    if (!mesh) {
        mustHold(mesh.error().message.find("m.obj") != std::string::npos, "an error names the file");
        mustBeLine(mesh.error().message);
        return 0;
    }
    mustBeMesh(*mesh);
    return 0;
}
