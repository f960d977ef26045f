// One particle to be born.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace relief {

struct Birth {
    glm::vec3 position{0.0F};  ///< object units
    glm::vec3 velocity{0.0F};  ///< object units a second
    float lifetime = 1.0F;     ///< seconds, > 0
    std::uint32_t type = 0;    ///< carried along for the renderer, below 2^24
    /// Seconds that it has lived already when it enters the next step, ≥ 0. The particle system moves it on
    /// by as much, so that those born within one step do not all start from one place.
    float age = 0.0F;
};

}  // namespace relief
