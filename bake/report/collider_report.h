// A collider as `relief info` and `relief bake` report it.
#pragma once

#include <string>
#include <vector>

#include "bake/report/report_text.h"
#include "formats/animation/mesh_parts.h"
#include "formats/collider.h"
#include "formats/container.h"
#include "formats/fields/field.h"

namespace relief {

inline constexpr std::span<const std::string_view> kMapFormatWords =
    kWords<"float", "fixed8", "front-back", "cube", "patches">;
inline constexpr std::string_view kHashPattern = "^([0-9a-f]{32})?$";

template <class Visitor, FieldsOf<Bounds> B>
void fields(Visitor& visit, B& bounds) {
    visit("min", bounds.min, {"Smallest x, y and z", "object units"});
    visit("max", bounds.max, {"Largest x, y and z", "object units"});
}

template <class Visitor, FieldsOf<Provenance> P>
void fields(Visitor& visit, P& from) {
    visit("mesh_name", from.mesh_name, {"File name of the mesh, without its folder"});
    visit("mesh_hash", from.mesh_hash,
          {.help = "XXH3-128 of the mesh file, hexadecimal; empty if unknown", .pattern = kHashPattern});
    visit("triangles", from.triangles, {"Triangles of the mesh"});
    visit("tool_version", from.tool_version, {"Program that made the container"});
    visit("options", from.optionsText(), {"Options of the bake, as words of a shell"});
}

struct ColliderMapReport {
    std::size_t index = 0;
    const DepthMap& map = kNone<DepthMap>;
    const PayloadInfo& payload = kNone<PayloadInfo>;
};

template <class Visitor, FieldsOf<ColliderMapReport> R>
void fields(Visitor& visit, R& report) {
    const auto& [index, map, payload] = report;
    std::array<std::array<float, 4>, 3> rows{};
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::vec4& row = map.object_to_map.row[i];
        rows[i] = {row.x, row.y, row.z, row.w};
    }
    visit("index", index, {"Position in the container, from 0"});
    visit("format", mapFormatName(map.format), {.help = "Format of the texels", .words = kMapFormatWords});
    visit("projection", projectionName(map.projection()),
          {.help = "Projection of the map", .words = kWords<"orthographic", "cube", "local">});
    visit("compare", compareName(map.compare),
          {.help = "Surface kept along each ray: the nearest, the farthest, both, or the two ends of a gap",
           .words = kWords<"less", "greater", "both", "gap">});
    visit("width", map.width, {"Width", "texels", kFromOne});
    visit("height", map.height, {"Height", "texels", kFromOne});
    visit("faces", map.faceCount(), {.help = "Images: 6 of a cube", .words = kWords<"1", "6">});
    visit("bytes", payload.raw_size, {"Size of all texels in memory", "bytes"});
    visit("stored_bytes", payload.stored_size, {"Size in the file", "bytes"});
    visit("compression", packingName(payload.packing),
          {.help = "Encoding in the file: plain, a zstd frame, or rows without their empty ends",
           .words = kWords<"none", "zstd", "rows">});
    visit("offset", payload.offset, {"First byte in the file"});
    visit("object_to_map", rows, {"Rows of the affine map from object space to map space"});
    visit("object_per_map", map.object_per_map,
          {"Length of one unit along each axis of the map", "object units"});
    visit("encloses", map.encloses, {"The volume of the map contains the whole collider"});
    visit("empty_is_outside", map.empty_is_outside, {"A point on a ray that meets no surface is outside"});
}

template <class Visitor, FieldsOf<MeshClip> C>
void fields(Visitor& visit, C& clip) {
    visit("name", clip.name, {"Name, which no other clip has"});
    visit("seconds", clip.seconds, {"Length", "s", kFromZero});
}

/// An animated mesh, without what it is made of.
template <class Visitor, FieldsOf<AnimatedMesh> M>
void fields(Visitor& visit, M& mesh) {
    visit("vertices", mesh.positions.size(), {"Vertices, instances counted one by one"});
    visit("triangles", mesh.triangles.size(), {"Triangles"});
    visit("nodes", mesh.nodes.size(), {"Nodes, those of the skeleton included"});
    visit("joints", mesh.joints.size(), {"Joints: nodes that move vertices"});
    visit("morph_targets", mesh.weights.size(), {"Morph targets"});
    visit("clips", mesh.clips, {"Clips, those of the mesh file first"});
    visit("groups", groupNames(mesh),
          {"Names of joints and nodes with vertices of their own: emitter.group"});
    visit("materials", mesh.materials, {"Names of materials, \"\" for none: emitter.material"});
}

template <class Visitor, FieldsOf<Material> M>
void fields(Visitor& visit, M& material) {
    visit("name", material.name,
          {"Name, which no other material of the collider has; empty of surfaces without one"});
    visit("restitution", material.restitution, {"Factor of the particles' own restitution", {}, kShareRange});
    visit("friction", material.friction,
          {"1 − friction is a factor of the particles' own 1 − friction", {}, kShareRange});
    visit("lifetime_loss", material.lifetime_loss,
          {"Lifetime that each step in contact costs", "s", {0.0, double{kMaterialLossMax}}});
    visit("area_percent", 100.0 * double{material.area_share},
          {"Share of the mesh's surface", "%", kPercentRange});
}

/// Materials as a line with their bytes and a table.
[[nodiscard]] std::string materialsText(const Materials& materials);

/// A line, its groups and materials, and a table of the clips, if there are any.
[[nodiscard]] std::string animationText(const AnimatedMesh& mesh);

/// \tparam Map  ColliderMapReport, or more than that.
template <class Map>
struct ColliderReport {
    const Collider& collider = kNone<Collider>;
    const ContainerInfo& info = kNone<ContainerInfo>;
    std::vector<Map> maps = {};
    const AnimatedMesh* animated = nullptr;  ///< of the collider
};

template <class Visitor, class Map>
void fields(Visitor& visit, const ColliderReport<Map>& report) {
    const auto& [collider, info, maps, animated] = report;
    visit("version", std::to_string(info.major) + "." + std::to_string(info.minor),
          {.help = "Version of the container format", .pattern = "^[0-9]+\\.[0-9]+$"});
    visit("file_size", info.file_size, {"Size of the file", "bytes"});
    visit("bounds", collider.bounds, {"Box of the mesh"});
    visit("unit", collider.unit, {"Unit of lengths: m, or empty if the source names none"});
    visit("texel_bytes", collider.gpuBytes(), {"Size of all maps on the GPU", "bytes"});
    visit("maps", maps, {.help = "Maps, in the order of the file", .items = kFromOne});
    visit("materials", collider.materials.list,
          {"Materials of its surface, by their ids; none: its surface is all the same"});
    visit("material_bytes", collider.materials.bytes(), {"Size of the materials", "bytes"});
    visit("animation", animated == nullptr ? std::nullopt : std::optional(*animated),
          {"How it moves; null if it does not"});
    visit("provenance", collider.provenance, {"Origin of the collider"});
}

/// The report of `relief info`.
/// \param animated  of the collider, if it has one.
[[nodiscard]] inline ColliderReport<ColliderMapReport> infoReport(const Collider& collider,
                                                                  const ContainerInfo& info,
                                                                  const AnimatedMesh* animated) {
    ColliderReport<ColliderMapReport> report{collider, info, {}, animated};
    for (std::size_t i = 0; i < collider.maps.size(); ++i) {
        report.maps.push_back({i, collider.maps[i], info.payloads[i]});
    }
    return report;
}

}  // namespace relief
