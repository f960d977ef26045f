// A small part of a plane: the solid as a mesh has it, and as a collider has it.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "bake/mesh/mesh_query.h"
#include "bake/picture/color.h"
#include "formats/collider.h"

namespace relief {

inline constexpr Color kFalseInsideColor{0.85, 0.25, 0.16};   ///< free, but the collider says inside
inline constexpr Color kFalseOutsideColor{0.97, 0.73, 0.20};  ///< solid, but the collider says outside

struct CloseUpOptions {
    glm::vec3 center{0.0F};    ///< object space
    int axis = 2;              ///< 0, 1, 2: the plane is across x, y, z; the others run as in slice.h
    double half = 1.0;         ///< object units, of the square
    std::uint32_t size = 300;  ///< pixels along its sides
};

struct CloseUp {
    RgbImage truth;     ///< kInsideColor, also where the surface is, and kOutsideColor
    RgbImage collider;  ///< the same, and where it is wrong the two above
};

[[nodiscard]] CloseUp drawCloseUp(const MeshQuery& query, const Collider& collider,
                                  const CloseUpOptions& options);

/// The axis of a plane that cuts a surface with this normal as squarely as a plane across an axis can.
[[nodiscard]] int axisAlong(const glm::dvec3& normal);

}  // namespace relief
