// Pictures of a mesh coloured by a field on its surface, where a perfect field is 0.
#pragma once

#include <glm/vec3.hpp>

#include "bake/measure/accuracy.h"
#include "bake/mesh/mesh_query.h"
#include "bake/picture/color.h"

namespace relief {

struct HeatMapOptions {
    glm::dvec3 direction{-1.0, -0.6, -1.0};  ///< of view; object space, not along ±y
    std::uint32_t size = 400;                ///< pixels along both sides
    double range = 1.0;                      ///< object units: the distance of the strongest colour
};

inline constexpr Color kHeatFarColor{0.62, 0.13, 0.42};      ///< outside without a distance
inline constexpr Color kHeatUnknownColor{0.35, 0.35, 0.37};  ///< no value

/// Orthographic, centred on the mesh's box, y upwards, four rays per pixel: distanceColor() of f / range, shaded by the
/// triangles' normals.
[[nodiscard]] RgbImage drawHeatMap(const MeshQuery& query, const Field& field, const HeatMapOptions& options);

/// The place of a point in such a picture.
struct HeatMapPlace {
    double x = 0.0;       ///< pixels from the left
    double y = 0.0;       ///< pixels from the top
    bool hidden = false;  ///< by the mesh
};
[[nodiscard]] HeatMapPlace placeOnHeatMap(const MeshQuery& query, const HeatMapOptions& options,
                                          const glm::vec3& p);

}  // namespace relief
