#include "runtime/collider/material_table.h"

#include <array>
#include <cstring>
#include <map>

#include "shaders/collider/constants.h"

namespace relief {
namespace {

static_assert(kMaterialLevels == kMaterialLevelsMax);

std::uint32_t bitsOf(float value) {
    return __builtin_bit_cast(std::uint32_t, value);
}

/// Adds the record of a collider: materials.glsl.
/// \param numbers  of all names so far.
void addRecord(const Materials& materials, std::map<std::string, std::uint32_t>& numbers,
               MaterialTable& table) {
    std::vector<glm::uvec4>& texels = table.texels;
    const bool tree = !materials.nodes.empty();
    const auto count = static_cast<std::uint32_t>(materials.list.size());
    const std::size_t root = texels.size() + kMaterialHeadTexels + count + materials.sides.size();
    texels.emplace_back(bitsOf(materials.origin.x), bitsOf(materials.origin.y), bitsOf(materials.origin.z),
                        bitsOf(tree ? 1.0F / materials.size : 0.0F));
    texels.emplace_back(count, tree ? static_cast<std::uint32_t>(root) : 0, 0, 0);
    for (const Material& one : materials.list) {
        const auto [found, added] =
            numbers.try_emplace(one.name, static_cast<std::uint32_t>(table.names.size()));
        if (added) {
            table.names.push_back(one.name);
        }
        table.responds =
            table.responds || one.restitution != 1.0F || one.friction != 0.0F || one.lifetime_loss != 0.0F;
        texels.emplace_back(bitsOf(one.restitution), bitsOf(1.0F - one.friction), bitsOf(one.lifetime_loss),
                            found->second);
    }
    for (const MaterialSides& pair : materials.sides) {
        texels.emplace_back(pair.axis, pair.towards, pair.against, 0);
    }
    for (const MaterialNode& node : materials.nodes) {
        std::array<std::uint32_t, 2> leaves{};
        std::memcpy(leaves.data(), node.leaves.data(), sizeof(leaves));
        texels.emplace_back(node.head, leaves[0], leaves[1], 0);
    }
}

}  // namespace

MaterialTable makeMaterialTable(std::span<const Materials* const> bodies) {
    MaterialTable table;
    table.texels.resize(bodies.size());
    std::map<std::string, std::uint32_t> numbers;
    std::map<const Materials*, std::uint32_t> records;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (bodies[i] == nullptr || bodies[i]->empty()) {
            continue;  // a record lies behind the bodies: 0 is none
        }
        const auto [found, added] =
            records.try_emplace(bodies[i], static_cast<std::uint32_t>(table.texels.size()));
        if (added) {
            addRecord(*bodies[i], numbers, table);
        }
        table.texels[i].x = found->second;
    }
    if (table.names.empty()) {
        return {};
    }
    while ((std::size_t{1} << (2 * table.log2_width)) < table.texels.size()) {
        ++table.log2_width;
    }
    const std::size_t width = std::size_t{1} << table.log2_width;
    table.texels.resize((table.texels.size() + width - 1) / width * width);
    return table;
}

}  // namespace relief
