#include "bake/report/report.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "runtime/tool/json_text.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

/// Characters, where each is one column wide: continuation bytes of UTF-8 do not count.
std::size_t columns(const std::string& text) {
    std::size_t count = 0;
    for (const char c : text) {
        count += (static_cast<unsigned char>(c) & 0xc0U) != 0x80 ? 1 : 0;
    }
    return count;
}

}  // namespace

Json jsonBounds(const Bounds& bounds) {
    return {{"min", jsonVector(bounds.min)}, {"max", jsonVector(bounds.max)}};
}

Json jsonMap(const DepthMap& map, std::size_t index, const PayloadInfo& payload) {
    Json rows = Json::array();
    for (const glm::vec4& row : map.object_to_map.row) {
        rows.push_back({jsonNumber(row.x), jsonNumber(row.y), jsonNumber(row.z), jsonNumber(row.w)});
    }
    return {{"index", index},
            {"format", mapFormatName(map.format)},
            {"projection", map.projection() == Projection::kCube ? "cube" : "orthographic"},
            {"compare", compareName(map.compare)},
            {"width", map.width},
            {"height", map.height},
            {"faces", map.faceCount()},
            {"bytes", payload.raw_size},
            {"stored_bytes", payload.stored_size},
            {"compression", packingName(payload.packing)},
            {"offset", payload.offset},
            {"object_to_map", rows},
            {"object_per_map", jsonVector(map.object_per_map)},
            {"encloses", map.encloses},
            {"empty_is_outside", map.empty_is_outside}};
}

Json jsonCollider(const Collider& collider, const ContainerInfo& info) {
    Json maps = Json::array();
    for (std::size_t i = 0; i < collider.maps.size(); ++i) {
        maps.push_back(jsonMap(collider.maps[i], i, info.payloads[i]));
    }
    const Provenance& from = collider.provenance;
    return {{"version", std::to_string(info.major) + "." + std::to_string(info.minor)},
            {"file_size", info.file_size},
            {"bounds", jsonBounds(collider.bounds)},
            {"unit", collider.unit},
            {"texel_bytes", collider.gpuBytes()},
            {"maps", maps},
            {"provenance",
             {{"mesh_name", from.mesh_name},
              {"mesh_hash", from.mesh_hash},
              {"triangles", from.triangles},
              {"tool_version", from.tool_version},
              {"options", from.options}}}};
}

std::string colliderJson(const Collider& collider, const ContainerInfo& info) {
    return jsonText(jsonCollider(collider, info));
}

std::string bytesText(std::uint64_t bytes) {
    constexpr const char* kUnits[] = {"B", "kB", "MB", "GB", "TB"};
    auto value = static_cast<double>(bytes);
    int unit = 0;
    while (value >= 999.5 && unit < 4) {
        value /= 1000.0;
        ++unit;
    }
    char text[32];
    std::snprintf(text, sizeof(text), unit == 0 || value >= 99.95 ? "%.0f %s" : "%.1f %s", value,
                  kUnits[unit]);
    return text;
}

std::vector<std::string> optionList(const std::string& options) {
    std::vector<std::string> list;
    for (std::size_t at = 0; at < options.size();) {
        const std::size_t end = std::min(options.find(" --", at), options.size());
        list.push_back(options.substr(at, end - at));
        at = end + 1;
    }
    return list;
}

std::string table(const std::vector<std::vector<std::string>>& rows) {
    const std::size_t count = rows.front().size();
    std::vector<bool> right(count);
    std::vector<std::vector<std::string>> cells = rows;
    std::vector<std::size_t> widths(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
        std::string& heading = cells.front()[i];
        right[i] = heading.ends_with('>');
        if (right[i]) {
            heading.pop_back();
        }
        for (const std::vector<std::string>& row : cells) {
            widths[i] = std::max(widths[i], columns(row[i]));
        }
    }
    std::string text;
    for (const std::vector<std::string>& row : cells) {
        std::string line = " ";
        for (std::size_t i = 0; i < count; ++i) {
            const std::string space(widths[i] - columns(row[i]), ' ');
            line += " " + (right[i] ? space + row[i] : row[i] + space) + " ";
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

}  // namespace relief
