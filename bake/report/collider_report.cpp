// SPDX-License-Identifier: Apache-2.0
#include "bake/report/collider_report.h"

#include <algorithm>
#include <set>
#include <utility>

#include "formats/base/text.h"

namespace relief {

std::string originText(const Provenance& from) {
    constexpr std::size_t kLineMax = 80;  // maximum length of a line of options, in characters
    const std::string by = "baked    by " + from.tool_version;
    const std::string options = from.optionsText();
    if (options.size() <= kLineMax) {
        return by + (options.empty() ? "" : " with " + options) + "\n";
    }
    std::string text = by + " with";
    for (const RecordedOption& option : from.options) {
        text += "\n         " + option.text();
    }
    return text + "\n";
}

std::string commonOriginText(const std::vector<Provenance>& colliders) {
    Provenance common = colliders.front();
    std::set<std::pair<std::string_view, std::string_view>> meshes;
    std::set<std::string_view> tools;
    for (const Provenance& from : colliders) {
        meshes.emplace(from.mesh_name, from.mesh_hash);
        tools.insert(from.tool_version);
        std::erase_if(common.options, [&](const RecordedOption& option) {
            return std::ranges::find(from.options, option) == from.options.end();
        });
    }
    common.tool_version = listed(std::vector(tools.begin(), tools.end()));
    return "meshes   " + std::to_string(meshes.size()) + " (--json lists the options of each collider)\n" +
           originText(common);
}

std::string materialsText(const Materials& materials) {
    std::vector<std::vector<std::string>> rows = {
        {"material", "restitution>", "friction>", "lifetime loss>", "area>"}};
    for (const Material& m : materials.list) {
        rows.push_back({m.name.empty() ? "-" : m.name, shortNumber(double{m.restitution}),
                        shortNumber(double{m.friction}), shortNumber(double{m.lifetime_loss}),
                        shortNumber(100.0 * double{m.area_fraction}) + " %"});
    }
    return countText(materials.list.size(), "material") + " in " + bytesText(materials.bytes()) + "\n" +
           table(rows);
}

std::string animationText(const AnimatedMesh& mesh) {
    std::string text = countText(mesh.positions.size(), "vertex", "vertices") + " moved by " +
                       countText(mesh.joints.size(), "joint") + " and " +
                       countText(mesh.weights.size(), "morph target") + "\n";
    for (const auto& [head, names] :
         {std::pair("groups   ", groupNames(mesh)), {"material ", mesh.materials}}) {
        if (const std::string list = listedNames(names); !list.empty()) {
            text += head + list + "\n";
        }
    }
    if (mesh.clips.empty()) {
        return text;
    }
    std::vector<std::vector<std::string>> rows = {{"clip", "seconds>"}};
    for (const MeshClip& clip : mesh.clips) {
        rows.push_back({clip.name, shortNumber(double{clip.seconds})});
    }
    return text + table(rows);
}

void fields(FieldVisitor& visit, const Bounds& bounds) {
    visit("min", bounds.min, {"Smallest x, y and z", "object units"});
    visit("max", bounds.max, {"Largest x, y and z", "object units"});
}

void fields(FieldVisitor& visit, const Provenance& from) {
    visit("mesh_name", from.mesh_name, {"File name of the mesh, without its folder"});
    visit("mesh_hash", from.mesh_hash,
          {.help = "XXH3-128 of the mesh file, hexadecimal; empty if unknown", .pattern = kHashPattern});
    visit("triangles", from.triangles, {"Triangles of the mesh"});
    visit("tool_version", from.tool_version, {"Program that made the container"});
    visit("options", from.optionsText(), {"Options of the bake, as words of a shell"});
}

void fields(FieldVisitor& visit, const ColliderMapReport& report) {
    const auto& [index, map, payload] = report;
    std::array<std::array<float, 4>, 3> rows{};
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::vec4& row = map.object_to_map.row[i];
        rows[i] = {row.x, row.y, row.z, row.w};
    }
    visit("index", index, {"Index in the container, from 0"});
    visit("format", mapFormatName(map.format), {.help = "Format of the texels", .words = kMapFormatWords});
    visit("projection", projectionName(map.projection()),
          {.help = "Projection of the map", .words = kWords<"orthographic", "cube", "local">});
    visit("compare", compareName(map.compare),
          {.help = "Surface kept along each ray: the nearest, the farthest, or both",
           .words = kWords<"less", "greater", "both">});
    visit("width", map.width, {"Width", "texels", kFromOne});
    visit("height", map.height, {"Height", "texels", kFromOne});
    visit("faces", map.faceCount(), {.help = "Number of images: 6 for a cube", .words = kWords<"1", "6">});
    visit("bytes", payload.raw_size, {"Size of all texels in memory", "bytes"});
    visit("stored_bytes", payload.stored_size, {"Size in the file", "bytes"});
    visit("compression", packingName(payload.packing),
          {.help = "Encoding in the file: plain, or a zstd frame", .words = kWords<"none", "zstd">});
    visit("offset", payload.offset, {"First byte in the file"});
    visit("object_to_map", rows, {"Rows of the affine map from object space to map space"});
    visit("object_per_map", map.object_per_map,
          {"Length of one unit along each axis of the map", "object units"});
    visit("encloses", map.encloses, {"Whether the volume of the map contains the whole collider"});
    visit("empty_is_outside", map.empty_is_outside,
          {"Whether a point on a ray that hits no surface is outside"});
}

void fields(FieldVisitor& visit, const MeshClip& clip) {
    visit("name", clip.name, {"Name, unique among the clips"});
    visit("duration", clip.seconds, {"Length", "s", kFromZero});
}

void fields(FieldVisitor& visit, const AnimatedMesh& mesh) {
    visit("vertices", mesh.positions.size(), {"Vertices; each instance counts"});
    visit("triangles", mesh.triangles.size(), {"Triangles"});
    visit("nodes", mesh.nodes.size(), {"Nodes, including those of the skeleton"});
    visit("joints", mesh.joints.size(), {"Joints: nodes that move vertices"});
    visit("morph_targets", mesh.weights.size(), {"Morph targets"});
    visit("clips", mesh.clips, {"Clips; those of the mesh file come first"});
    visit("groups", groupNames(mesh),
          {"Names of joints and nodes with their own vertices, for emitter.group"});
    visit("materials", mesh.materials, {"Names of materials for emitter.material; \"\" for none"});
}

void fields(FieldVisitor& visit, const Material& material) {
    visit("name", material.name, {"Name, unique in the collider; empty for surfaces without a material"});
    visit("restitution", material.restitution,
          {"Restitution; multiplies that of the particles", {}, kFractionRange});
    visit("friction", material.friction,
          {"Friction; 1 − friction multiplies that of the particles", {}, kFractionRange});
    visit("lifetime_loss", material.lifetime_loss,
          {"Lifetime lost per step in contact", "s", {0.0, double{kMaterialLossMax}}});
    visit("area_percent", 100.0 * double{material.area_fraction},
          {"Fraction of the mesh's surface", "%", kPercentRange});
}

void colliderFields(FieldVisitor& visit, const Collider& collider, const ContainerInfo& info, FieldRef maps,
                    const AnimatedMesh* animated) {
    visit("version", std::to_string(info.major) + "." + std::to_string(info.minor),
          {.help = "Version of the container format", .pattern = "^[0-9]+\\.[0-9]+$"});
    visit("file_bytes", info.file_size, {"Size of the file", "bytes"});
    visit("bounds", collider.bounds, {"Bounds of the mesh"});
    visit("unit", collider.unit, {"Unit of lengths: m, or empty if unknown"});
    visit("gpu_bytes", collider.texelBytes(), {"Size of all maps on the GPU", "bytes"});
    visit("maps", maps, {.help = "Maps, in the order of the file", .items = kFromOne});
    visit("materials", collider.materials.list, {"Materials of the surface, by id; empty if it has none"});
    visit("material_bytes", collider.materials.bytes(), {"Size of the materials", "bytes"});
    visit("animation", animated == nullptr ? std::nullopt : std::optional(*animated),
          {"Animation; null for a static mesh"});
    visit("provenance", collider.provenance, {"Origin of the collider"});
}

std::vector<ColliderMapReport> mapReports(const Collider& collider, const ContainerInfo& info) {
    std::vector<ColliderMapReport> reports;
    for (std::size_t i = 0; i < collider.maps.size(); ++i) {
        reports.push_back({i, collider.maps[i], info.payloads[i]});
    }
    return reports;
}

void fields(FieldVisitor& visit, const ColliderJson& report) {
    visit("file", report.file,
          {.help = "File name without its folder, if there are several files",
           .left_out = report.file.empty()});
    colliderFields(visit, report.collider, report.info, mapReports(report.collider, report.info),
                   report.animated);
}

}  // namespace relief
