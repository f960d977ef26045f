// SPDX-License-Identifier: Apache-2.0
#include "formats/materials.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "formats/base/finite.h"
#include "formats/base/text.h"

namespace relief {
namespace {

std::string faultOfList(const Materials& materials) {
    if (materials.list.size() > kMaterialsMax) {
        return "there are " + std::to_string(materials.list.size()) + " materials, more than " +
               std::to_string(kMaterialsMax);
    }
    std::set<std::string_view> names;
    for (std::size_t i = 0; i < materials.list.size(); ++i) {
        const Material& one = materials.list[i];
        const std::string place = "materials[" + std::to_string(i) + "]";
        if (one.name.size() > kMaterialNameMax || cleanUtf8(one.name) != one.name) {
            return place + " has a name that is not clean UTF-8, or longer than " +
                   std::to_string(kMaterialNameMax) + " bytes";
        }
        if (!names.insert(one.name).second) {
            return place + " repeats the name '" + one.name + "' of an earlier material";
        }
        if (!isFraction(one.restitution) || !isFraction(one.friction) || !isFraction(one.area_fraction)) {
            return place + " has a restitution, friction or area fraction that is not in 0...1";
        }
        if (!(one.lifetime_loss >= 0.0F && one.lifetime_loss <= kMaterialLossMax)) {
            return place + " has a lifetime_loss that is not in 0...1000000";
        }
    }
    return {};
}

std::string faultOfSides(const Materials& materials) {
    if (materials.list.size() + materials.sides.size() > kMaterialSidesMax + 1) {
        return "there are " + std::to_string(materials.sides.size()) +
               " pairs of sides; together with the materials, more than 256";
    }
    const bool valid =
        std::all_of(materials.sides.begin(), materials.sides.end(), [&](const MaterialSides& pair) {
            return pair.axis < kMaterialAxes && pair.towards < materials.list.size() &&
                   pair.against < materials.list.size();
        });
    return valid ? "" : "a pair of sides has an invalid axis or material";
}

/// Checks that the nodes are stored in breadth-first order, so that each has one parent and there are no cycles.
std::string faultOfNodes(const Materials& materials) {
    const std::vector<MaterialNode>& nodes = materials.nodes;
    if (nodes.size() > kMaterialNodesMax) {
        return "there are " + std::to_string(nodes.size()) + " nodes of materials, more than " +
               std::to_string(kMaterialNodesMax);
    }
    const std::size_t leaves = materials.list.size() + materials.sides.size();
    std::size_t known = std::min<std::size_t>(nodes.size(), 1);
    std::size_t level_end = known;
    int level = 1;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (i == level_end) {
            ++level;
            level_end = known;
        }
        const std::string place = "material node " + std::to_string(i);
        if (i >= known || level > kMaterialLevelsMax) {
            return place + (i >= known ? " has no parent" : " is too deep");
        }
        const std::uint32_t mask = nodes[i].head & 0xFFU;
        if ((nodes[i].head >> 8U) != (mask == 0 ? 0 : known)) {
            return place + " has its octants out of order";
        }
        for (std::size_t octant = 0; octant < 8; ++octant) {
            const bool is_node = (mask >> octant & 1U) != 0;
            known += is_node ? 1 : 0;
            if (is_node ? nodes[i].leaves[octant] != 0 : nodes[i].leaves[octant] >= leaves) {
                return place + " has an octant with an invalid material";
            }
        }
    }
    return known == nodes.size() ? "" : "material nodes are missing";
}

}  // namespace

std::size_t Materials::bytes() const {
    std::size_t bytes = nodes.size() * sizeof(MaterialNode) + sides.size() * sizeof(MaterialSides);
    for (const Material& one : list) {
        bytes += one.name.size();
    }
    return bytes;
}

std::string faultOfMaterials(const Materials& materials) {
    if (materials.empty()) {
        return materials == Materials() ? "" : "there is a material tree, but no materials";
    }
    if (!isFinite(materials.origin) || !(materials.size >= 0.0F && std::isfinite(materials.size)) ||
        (materials.size == 0.0F && !materials.nodes.empty())) {
        return "the cube of the materials is not finite, or empty";
    }
    std::string fault = faultOfList(materials);
    fault = fault.empty() ? faultOfSides(materials) : fault;
    return fault.empty() ? faultOfNodes(materials) : fault;
}

std::size_t materialAt(const Materials& materials, const glm::vec3& p, const glm::vec3& normal) {
    if (materials.nodes.empty()) {
        return 0;
    }
    float q[3];
    for (int i = 0; i < 3; ++i) {
        const float fraction = (p[i] - materials.origin[i]) * (1.0F / materials.size);
        q[i] = fraction > 0.0F ? std::min(fraction, 1.0F) : 0.0F;  // also handles NaN
    }
    std::size_t node = 0;
    std::size_t leaf = 0;
    for (;;) {
        std::uint32_t octant = 0;
        for (int i = 0; i < 3; ++i) {
            q[i] *= 2.0F;
            const bool upper = q[i] >= 1.0F;
            q[i] -= upper ? 1.0F : 0.0F;
            octant |= (upper ? 1U : 0U) << i;
        }
        const MaterialNode& at = materials.nodes[node];
        if ((at.head >> octant & 1U) == 0) {
            leaf = at.leaves[octant];
            break;
        }
        node = at.head >> 8U;
        for (std::uint32_t before = 0; before < octant; ++before) {
            node += at.head >> before & 1U;
        }
    }
    if (leaf < materials.list.size()) {
        return leaf;
    }
    const MaterialSides& pair = materials.sides[leaf - materials.list.size()];
    return alongMaterialAxis(normal, pair.axis) >= 0.0F ? pair.towards : pair.against;
}

}  // namespace relief
