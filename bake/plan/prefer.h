// Settings of a bake of planes beside its maps.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace relief {

/// The worse of two errors, for maps whose decode is plane. kInside: doubtful space is solid, so that no particle enters a
/// wall. kOutside: doubtful space is free, so that no free volume is lost.
enum class Prefer : std::uint8_t { kNeither, kInside, kOutside };
inline constexpr std::array<const char*, 3> kPreferNames = {"neither", "inside", "outside"};

[[nodiscard]] constexpr const char* preferName(Prefer prefer) {
    return kPreferNames.at(static_cast<std::size_t>(prefer));
}

/// The work on texels of maps whose decode is plane: rays along each side of a texel's footprint, and rounds of search among
/// neighbouring normals.
enum class Quality : std::uint8_t { kFast, kNormal, kBest };
inline constexpr std::array<const char*, 3> kQualityNames = {"fast", "normal", "best"};

[[nodiscard]] constexpr const char* qualityName(Quality quality) {
    return kQualityNames.at(static_cast<std::size_t>(quality));
}

}  // namespace relief
