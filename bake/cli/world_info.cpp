// SPDX-License-Identifier: Apache-2.0
#include "bake/cli/world_info.h"

#include <filesystem>
#include <system_error>

#include "bake/report/collider_report.h"
#include "formats/base/text.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

std::string boxText(const Bounds& box) {
    return shortest(box.min) + " to " + shortest(box.max);
}

}  // namespace

Result<WorldInfo> readWorldInfo(const std::string& file, const ContainerLimits& limits) {
    const LoadedWorld loaded = RELIEF_TRY(loadWorld(file, limits));
    const World& world = loaded.world;
    WorldInfo info{
        .file = file, .unit = world.unit, .bounds = worldBounds(world), .bodies = world.bodies.size()};
    for (std::size_t i = 0; i < world.colliders.size(); ++i) {
        std::error_code error;  // the file was just read
        const std::uintmax_t bytes =
            fs::file_size(fs::path(file).parent_path() / world.colliders[i].file, error);
        const Collider& collider = loaded.colliders[i];
        info.colliders.push_back(
            {world.colliders[i], 0, collider.maps.size(), error ? 0 : bytes, collider.provenance});
        info.bytes += info.colliders.back().bytes;
        info.gpu_bytes += info.colliders.back().named.gpu_bytes;
    }
    for (const WorldBody& body : world.bodies) {
        ++info.colliders[body.collider].bodies;
    }
    return info;
}

std::string worldInfoText(const WorldInfo& info) {
    std::string text = "Relief world of " + std::to_string(info.bodies) + " bodies of " +
                       std::to_string(info.colliders.size()) + " colliders, " + bytesText(info.bytes) +
                       ", on the GPU " + bytesText(info.gpu_bytes) + "\n";
    text += "bounds   " + boxText(info.bounds) + " " + unitText(info.unit) + "\n";
    std::vector<Provenance> origins;
    std::vector<std::vector<std::string>> rows = {
        {"collider", "mesh", "file", "bodies>", "maps>", "bytes>", "on the GPU>", "box"}};
    for (std::size_t i = 0; i < info.colliders.size(); ++i) {
        const WorldColliderInfo& collider = info.colliders[i];
        rows.push_back({std::to_string(i), cleanUtf8(collider.named.mesh), cleanUtf8(collider.named.file),
                        std::to_string(collider.bodies), std::to_string(collider.maps),
                        bytesText(collider.bytes), bytesText(collider.named.gpu_bytes),
                        boxText(collider.named.box)});
        origins.push_back(collider.provenance);
    }
    return text + commonOriginText(origins) + table(rows);
}

void fields(FieldVisitor& visit, const WorldColliderInfo& collider) {
    FieldRef(collider.named).visit(visit);
    visit("bodies", collider.bodies, {"Number of its bodies"});
    visit("maps", collider.maps, {"Number of its maps"});
    visit("bytes", collider.bytes, {"Size of its file", "bytes"});
    visit("provenance", collider.provenance, {"Its origin"});
}

void fields(FieldVisitor& visit, const WorldInfo& info) {
    visit("file", info.file, {"File of the world"});
    visit("unit", info.unit, {"Unit of lengths: m, or empty"});
    visit("min", info.bounds.min, {"Lower corner of the bounds of all bodies", "world units"});
    visit("max", info.bounds.max, {"Upper corner of the bounds of all bodies", "world units"});
    visit("bodies", info.bodies, {"Number of bodies"});
    visit("bytes", info.bytes, {"Total size of the collider files", "bytes"});
    visit("gpu_bytes", info.gpu_bytes, {"Total size of the colliders on the GPU", "bytes"});
    visit("colliders", info.colliders, {"The distinct colliders"});
}

}  // namespace relief
