// The parts of a mesh that a collider loses, as text and JSON: which they are, how large, and what would keep them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bake/measure/part_accuracy.h"
#include "bake/mesh/surface_parts.h"
#include "formats/collider.h"

namespace relief {

/// The worse of gradeOf(wrong_percent) and that of the parts: poor if one is lost, fair if one is coarse.
[[nodiscard]] std::string gradeOf(double wrong_percent, const PartsAccuracy& accuracy);
/// "0.4 % wrong near the surface: good", "0.3 % wrong near the surface, but 27 of 82 parts are lost: poor"
[[nodiscard]] std::string verdictText(double wrong_percent, const PartsAccuracy& accuracy);

/// "pillar_17 (stone)", "part 17 of wood" or "part 17". \param index  of SurfaceParts::parts; counted from 1 in the text.
[[nodiscard]] std::string partName(const SurfacePart& part, std::size_t index);
/// "9 m long at (1, 2, 3): 48 % of the points near it are on the wrong side, called outside; …" and what would keep it.
[[nodiscard]] std::string partText(const PartAccuracy& accuracy, const SurfaceParts& parts,
                                   const Collider& collider);

/// For people: the worst parts and the worst named nodes and materials, and how many parts do not count; "" if there is
/// nothing to say.
[[nodiscard]] std::string partsText(const PartsAccuracy& accuracy, const SurfaceParts& parts,
                                    const Collider& collider);
/// detail, count, held, coarse, lost, hidden, small, rest, worst (of at most 100 parts), groups (of at most 100).
[[nodiscard]] nlohmann::ordered_json jsonParts(const PartsAccuracy& accuracy, const SurfaceParts& parts,
                                               const Collider& collider);

/// One line of a warning without the mesh's name; nullopt if no part is lost.
[[nodiscard]] std::optional<std::string> lostPartsWarning(const PartsAccuracy& accuracy,
                                                          const SurfaceParts& parts,
                                                          const Collider& collider);
/// Parts far from all others, in one line; nullopt if there are none.
[[nodiscard]] std::optional<std::string> strayText(const SurfaceParts& parts, const std::string& unit);
/// The same, and shells that were asked to be a quarter as thick as their parts are long: a line each.
[[nodiscard]] std::vector<std::string> partWarnings(const SurfaceParts& parts, const std::string& unit);

}  // namespace relief
