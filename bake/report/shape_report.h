// What shapeMesh() found a mesh to be, as text and JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bake/shape/shape.h"

namespace relief {

/// One line with its end: "shape: 2 solids, 1 sheet (0.01 m thick)"; empty if nothing was looked at.
[[nodiscard]] std::string shapeText(const ShapeReport& report, const std::string& unit);
/// null if nothing was looked at.
[[nodiscard]] nlohmann::ordered_json jsonShape(const ShapeReport& report);

}  // namespace relief
