// SPDX-License-Identifier: Apache-2.0
// Contacts with a collider and the materials that they should find: what a tree of materials is fitted to.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "bake/materials/material_source.h"
#include "formats/collider.h"

namespace relief {

/// Weight of a contact that lies further than a texel from any other material; of the others it is 1, since texels are no
/// sharper than that.
inline constexpr std::uint32_t kClearContact = 8;

struct MaterialSample {
    glm::dvec3 point;     ///< on the collider's surface
    glm::dvec3 normal;    ///< that the collider has there
    std::uint8_t id = 0;  ///< of the nearest surface of the source
    std::uint32_t weight = kClearContact;
};

/// Of points that are spread evenly over the area of the source, those that belong to a contact: what lies within solids is in
/// no contact's way. The same for any number of threads.
[[nodiscard]] std::vector<MaterialSample> sampleContacts(const Collider& collider,
                                                         const MaterialSource& source);

}  // namespace relief
