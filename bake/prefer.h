// The bias of planned and fitted maps.
#pragma once

#include <cstdint>

namespace relief {

/// Which of the two mistakes is worse, in maps whose decode is plane. kInside: doubtful space is solid, so
/// that no particle enters a wall. kOutside: doubtful space is free, so that no free volume is lost.
enum class Prefer : std::uint8_t { kNeither, kInside, kOutside };

[[nodiscard]] const char* preferName(Prefer prefer);  ///< "neither", "inside" or "outside"

}  // namespace relief
