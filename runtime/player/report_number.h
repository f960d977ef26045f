// Floats of a report.
#pragma once

#include <glm/vec3.hpp>
#include <nlohmann/json_fwd.hpp>

namespace relief {

/// A float as the shortest decimal that reads back as it, rather than as the double beside it.
[[nodiscard]] nlohmann::ordered_json shortestJson(float value);
[[nodiscard]] nlohmann::ordered_json triple(const glm::vec3& v);

}  // namespace relief
