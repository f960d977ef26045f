// SPDX-License-Identifier: Apache-2.0
// Samples contacts with a collider, each with its correct material. A material tree is fitted to the samples.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "bake/materials/material_source.h"
#include "formats/collider.h"

namespace relief {

/// Weight of a contact that is more than a texel away from any other material. A closer contact weighs 1, because
/// texels do not resolve the border between materials.
inline constexpr std::uint32_t kClearContact = 8;

struct MaterialSample {
    glm::dvec3 point;     ///< on the collider's surface
    glm::dvec3 normal;    ///< of the collider at that point
    std::uint8_t id = 0;  ///< of the nearest source triangle, an index into MaterialSource::list
    std::uint32_t weight = kClearContact;
};

/// Samples points evenly over the area of the source, and returns the contacts within 1.5 texels of them along the
/// normal; points within solids have none. The result does not depend on the number of threads.
[[nodiscard]] std::vector<MaterialSample> sampleContacts(const Collider& collider,
                                                         const MaterialSource& source);

}  // namespace relief
