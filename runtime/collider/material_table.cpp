#include "runtime/collider/material_table.h"

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
    std::vector<std::uint32_t>& words = table.words;
    const std::size_t first_leaf = words.size() + kMaterialHeadWords;
    const std::size_t first_node =
        first_leaf + kMaterialWords * materials.list.size() + materials.sides.size();
    for (int i = 0; i < 3; ++i) {
        words.push_back(bitsOf(materials.origin[i]));
    }
    words.push_back(bitsOf(materials.nodes.empty() ? 0.0F : 1.0F / materials.size));
    words.push_back(static_cast<std::uint32_t>(materials.list.size()));
    words.push_back(materials.nodes.empty() ? 0 : static_cast<std::uint32_t>(first_node));
    for (const Material& one : materials.list) {
        const auto [found, added] =
            numbers.try_emplace(one.name, static_cast<std::uint32_t>(table.names.size()));
        if (added) {
            table.names.push_back(one.name);
        }
        words.insert(words.end(), {bitsOf(one.restitution), bitsOf(1.0F - one.friction),
                                   bitsOf(one.lifetime_loss), found->second});
    }
    for (const MaterialSides& pair : materials.sides) {
        words.push_back(pair.axis | static_cast<std::uint32_t>(pair.towards) << 8U |
                        static_cast<std::uint32_t>(pair.against) << 16U);
    }
    constexpr std::size_t kNodeWords = sizeof(MaterialNode) / sizeof(std::uint32_t);
    static_assert(kNodeWords == kMaterialNodeWords);
    const std::size_t at = words.size();
    words.resize(at + kNodeWords * materials.nodes.size());
    if (!materials.nodes.empty()) {
        std::memcpy(&words[at], materials.nodes.data(), materials.nodes.size() * sizeof(MaterialNode));
    }
}

}  // namespace

MaterialTable makeMaterialTable(std::span<const Materials* const> bodies) {
    MaterialTable table;
    table.words.resize(bodies.size());
    std::map<std::string, std::uint32_t> numbers;
    std::map<const Materials*, std::uint32_t> records;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (bodies[i] == nullptr || bodies[i]->empty()) {
            continue;  // a record lies behind the bodies: 0 is none
        }
        const auto [found, added] =
            records.try_emplace(bodies[i], static_cast<std::uint32_t>(table.words.size()));
        if (added) {
            addRecord(*bodies[i], numbers, table);
        }
        table.words[i] = found->second;
    }
    if (table.names.empty()) {
        return {};
    }
    while ((std::size_t{1} << (2 * table.log2_width)) < table.words.size()) {
        ++table.log2_width;
    }
    const std::size_t width = std::size_t{1} << table.log2_width;
    table.words.resize((table.words.size() + width - 1) / width * width);
    return table;
}

}  // namespace relief
