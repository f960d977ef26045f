#include "tests/formats/pinned_text.h"

#include <array>
#include <cstdio>
#include <initializer_list>

#include "formats/base/text.h"

namespace relief::test {
namespace {

constexpr int kPoints = 64;
/// Points lie in the bounds, made larger by this on every side, in parts of their size.
constexpr float kAround = 0.25F;

void add(std::string& text, float value) {
    std::array<char, 32> digits{};
    std::snprintf(digits.data(), digits.size(), " %.9g", static_cast<double>(value));
    text += digits.data();
}

void add(std::string& text, const char* name, std::initializer_list<float> values) {
    text += name;
    for (const float value : values) {
        add(text, value);
    }
    text += '\n';
}

void add(std::string& text, const char* name, const glm::vec3& v) {
    add(text, name, {v.x, v.y, v.z});
}

void addTexels(std::string& text, const DepthMap& map) {
    constexpr const char* kDigits = "0123456789abcdef";
    for (std::uint32_t face = 0; face < map.faceCount(); ++face) {
        for (std::uint32_t y = 0; y < map.height; ++y) {
            text += "texels " + std::to_string(face) + " " + std::to_string(y);
            for (std::uint32_t x = 0; x < map.width; ++x) {
                text += ' ';
                for (const std::byte byte : map.texelAt(face, x, y)) {
                    text += kDigits[std::to_integer<unsigned>(byte) >> 4U];
                    text += kDigits[std::to_integer<unsigned>(byte) & 15U];
                }
            }
            text += '\n';
        }
    }
}

void addMap(std::string& text, const DepthMap& map) {
    text += "map format " + std::to_string(static_cast<int>(map.format)) + " compare " +
            compareName(map.compare) + " decode " + decodeName(map.decode) + " size " +
            std::to_string(map.width) + " " + std::to_string(map.height) + " encloses " +
            std::to_string(static_cast<int>(map.encloses)) + " empty_is_outside " +
            std::to_string(static_cast<int>(map.empty_is_outside)) + "\n";
    for (const glm::vec4& row : map.object_to_map.row) {
        add(text, "object_to_map", {row.x, row.y, row.z, row.w});
    }
    add(text, "object_per_map", map.object_per_map);
    addTexels(text, map);
}

void addAnswer(std::string& text, const Collider& collider, const glm::vec3& p) {
    const FieldSample sample = evaluate(collider, p);
    const InsideSample inside = evaluateInside(collider, p);
    text += "at";
    for (const float value : {p.x, p.y, p.z}) {
        add(text, value);
    }
    text += " map " + std::to_string(sample.map) + " distance";
    add(text, sample.map < 0 ? 0.0F : sample.distance);
    text += " normal";
    for (const float value : {sample.normal.x, sample.normal.y, sample.normal.z}) {
        add(text, value);
    }
    text += " inside " + std::to_string(static_cast<int>(inside.inside)) + " by " +
            std::to_string(inside.map) + "\n";
}

/// In [0, 1), of 16 bits: exact in a float.
float next(std::uint32_t& state) {
    state = state * 1664525U + 1013904223U;
    return static_cast<float>(state >> 16U) / 65536.0F;
}

void addMaterials(std::string& text, const Materials& materials) {
    for (const Material& one : materials.list) {
        text += "material '" + one.name + "' " + shortest(one.restitution) + " " + shortest(one.friction) +
                " " + shortest(one.lifetime_loss) + " " + shortest(one.area_share) + "\n";
    }
    add(text, "materials_origin", materials.origin);
    text += "materials_size " + shortest(materials.size) + "\n";
    for (const MaterialSides& pair : materials.sides) {
        text += "sides " + std::to_string(pair.axis) + " " + std::to_string(pair.towards) + " " +
                std::to_string(pair.against) + "\n";
    }
    for (const MaterialNode& node : materials.nodes) {
        text += "node " + std::to_string(node.head);
        for (const std::uint8_t leaf : node.leaves) {
            text += " " + std::to_string(leaf);
        }
        text += "\n";
    }
}

}  // namespace

std::string pinnedText(const Collider& collider) {
    const Provenance& from = collider.provenance;
    std::string text = "unit '" + collider.unit + "'\nmesh '" + from.mesh_name + "' " + from.mesh_hash +
                       " of " + std::to_string(from.triangles) + " triangles\nby '" + from.tool_version +
                       "' '" + from.optionsText() + "'\n";
    add(text, "bounds_min", collider.bounds.min);
    add(text, "bounds_max", collider.bounds.max);
    if (!collider.materials.empty()) {
        addMaterials(text, collider.materials);
    }
    for (const DepthMap& map : collider.maps) {
        addMap(text, map);
    }
    const glm::vec3 size = collider.bounds.size();
    std::uint32_t state = 1;
    for (int i = 0; i < kPoints; ++i) {
        glm::vec3 p{0.0F};
        for (int axis = 0; axis < 3; ++axis) {
            const float share = (1.0F + 2.0F * kAround) * next(state) - kAround;
            p[axis] = collider.bounds.min[axis] + share * size[axis];
        }
        addAnswer(text, collider, p);
        if (!collider.materials.empty()) {
            text += "material " + std::to_string(materialAt(collider.materials, p, p)) + "\n";
        }
    }
    return text;
}

}  // namespace relief::test
