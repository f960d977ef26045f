// SPDX-License-Identifier: Apache-2.0
#include "formats/material_response.h"

#include <algorithm>
#include <string_view>

#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::size_t kListedMax = 20;

}  // namespace

std::optional<std::size_t> repeatedName(std::span<const MaterialResponse> responses) {
    std::set<std::string_view> names;
    for (std::size_t i = 0; i < responses.size(); ++i) {
        if (!names.insert(responses[i].name).second) {
            return i;
        }
    }
    return std::nullopt;
}

void MaterialResponses::recordNames(const Materials& materials) {
    for (const Material& one : materials.list) {
        names_.insert(one.name);
    }
}

void MaterialResponses::apply(Materials& materials) {
    recordNames(materials);
    for (Material& one : materials.list) {
        for (const MaterialResponse& response : responses_) {
            if (response.name == one.name) {
                one.restitution = response.restitution.value_or(one.restitution);
                one.friction = response.friction.value_or(one.friction);
                one.lifetime_loss = response.lifetime_loss.value_or(one.lifetime_loss);
            }
        }
    }
}

std::optional<std::string> MaterialResponses::faultOf(const std::string& name) const {
    if (names_.count(name) > 0) {
        return std::nullopt;
    }
    if (names_.empty()) {
        return "is not the name of a material: the colliders have none; bake a mesh with several, or with "
               "--materials keep";
    }
    const std::vector<std::string_view> known(names_.begin(), names_.end());
    std::string text = "is not the name of a material" + didYouMean(name, known);
    text += text.back() == '?' ? " There are " : "; there are ";
    for (std::size_t i = 0; i < std::min(known.size(), kListedMax); ++i) {
        text += (i == 0 ? "'" : ", '") + cleanUtf8(known[i], kMaterialNameMax) + "'";
    }
    return text + (known.size() > kListedMax ? " and more" : "");
}

void fields(FieldVisitor& visit, MaterialResponse& response) {
    visit("name", FieldPlaced{response.name, response.origin.text},
          {.help = "Name of a material of the colliders, as in relief info", .rules = kRequired});
    visit("restitution", response.restitution,
          leftOut({.help = "Multiplies the restitution of particles and colliders",
                   .range = kFractionRange,
                   .fallback = "the container's value: the mesh's, or 1"}));
    visit("friction", response.friction,
          leftOut({.help = "1 − friction multiplies 1 − friction of particles and colliders",
                   .range = kFractionRange,
                   .fallback = "the container's value: the mesh's, or 0"}));
    visit("lifetime_loss", response.lifetime_loss,
          leftOut({.help = "Lifetime lost in each step in contact, in addition to the particle type's",
                   .unit = "s",
                   .range = {0.0, double{kMaterialLossMax}},
                   .fallback = "0"}));
}

}  // namespace relief
