// A small part of a plane: the solid of a mesh beside that of a collider.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "bake/mesh/mesh_query.h"
#include "bake/picture/color.h"
#include "formats/collider.h"

namespace relief {

inline constexpr Color kFalseInsideColor{0.85, 0.25, 0.16};   ///< free, but inside by the collider
inline constexpr Color kFalseOutsideColor{0.97, 0.73, 0.20};  ///< solid, but outside by the collider

struct CloseUpOptions {
    glm::vec3 center{0.0F};    ///< object space
    int axis = 2;              ///< 0, 1, 2: the plane is across x, y, z; the other axes as in slice.h
    double half = 1.0;         ///< object units, of the square
    std::uint32_t size = 300;  ///< pixels along its sides
};

struct CloseUp {
    RgbImage truth;     ///< kInsideColor, for the surface too, and kOutsideColor
    RgbImage collider;  ///< the same, and the colours above for errors
};

[[nodiscard]] CloseUp drawCloseUp(const MeshQuery& query, const Collider& collider,
                                  const CloseUpOptions& options);

/// The axis whose plane cuts a surface with this normal most squarely.
[[nodiscard]] int axisAlong(const glm::dvec3& normal);

}  // namespace relief
