// The air's part of the report's settings.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "runtime/scene/scene.h"

namespace relief {

/// Adds the tables and keys of the air that the scene has, as in its file, every default filled in.
void addAirSettings(const Scene& scene, nlohmann::ordered_json& settings);

}  // namespace relief
