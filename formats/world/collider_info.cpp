// SPDX-License-Identifier: Apache-2.0
#include "formats/world/collider_info.h"

namespace relief {
namespace {

Json json(const glm::vec3& v) {
    return {v.x, v.y, v.z};
}
Json json(const glm::vec4& v) {
    return {v.x, v.y, v.z, v.w};
}

Json describe(const DepthMap& map) {
    const Affine& t = map.object_to_map;
    return {{"format", mapFormatName(map.format)},
            {"encoding", depthEncodingName(map.format)},
            {"compare", compareName(map.compare)},
            {"decode", decodeName(map.decode)},
            {"projection", projectionName(map.projection())},
            {"width", map.width},
            {"height", map.height},
            {"faces", map.faceCount()},
            {"object_to_map", {json(t.row[0]), json(t.row[1]), json(t.row[2])}},
            {"object_per_map", json(map.object_per_map)},
            {"encloses", map.encloses},
            {"empty_is_outside", map.empty_is_outside},
            {"bytes", map.texelBytes()}};
}

}  // namespace

Json colliderInfo(const Collider& collider) {
    Json maps = Json::array();
    for (const DepthMap& map : collider.maps) {
        maps.push_back(describe(map));
    }
    const Provenance& from = collider.provenance;
    return {{"bounds", {{"min", json(collider.bounds.min)}, {"max", json(collider.bounds.max)}}},
            {"unit", collider.unit},
            {"provenance",
             {{"mesh_name", from.mesh_name},
              {"mesh_hash", from.mesh_hash},
              {"triangles", from.triangles},
              {"tool_version", from.tool_version},
              {"options", from.optionsText()}}},
            {"gpu_bytes", collider.texelBytes()},
            {"finest_texel", finestTexel(collider)},
            {"maps", maps}};
}

}  // namespace relief
