// What a bake found out about its mesh, and did to it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bake/repair/mesh_care.h"

namespace relief {

/// For people: lines that end with a newline; none if nothing was counted.
[[nodiscard]] std::string careText(const MeshCare& care, bool verbose);
/// Adds mesh_health, repair and turned_triangles.
void addCareJson(const MeshCare& care, nlohmann::ordered_json& json);

}  // namespace relief
