// JSON as every report writes it.
#pragma once

#include <glm/vec3.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace relief {

/// The double whose shortest decimal is that of the float: 0.1F is written as 0.1.
[[nodiscard]] nlohmann::ordered_json jsonNumber(float value);
/// [x, y, z]
[[nodiscard]] nlohmann::ordered_json jsonVector(const glm::vec3& v);

/// Indented, with a newline at the end. Bytes that are not UTF-8 are replaced.
[[nodiscard]] std::string jsonText(const nlohmann::ordered_json& json);

}  // namespace relief
