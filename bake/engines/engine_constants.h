// SPDX-License-Identifier: Apache-2.0
// Colliders as shaders/engines/relief.glsl reads them: texels and constants.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/world/pose.h"

namespace relief {

/// Width of the texture, texels.
inline constexpr std::uint32_t kEngineTextureWidth = 2048;
/// Maximum number of texels: 16,384 rows.
inline constexpr std::size_t kEngineTexelsMax = std::size_t{kEngineTextureWidth} * 16384;
inline constexpr std::size_t kEngineTexelBytes = 8;

/// `ReliefCollider`, laid out as std140.
struct EngineConstants {
    std::array<std::array<float, 4>, 3> rows{};  ///< object space to map space
    std::array<float, 4> size{};          ///< edge of a root cell; number of root cells along x, y and z
    std::array<std::int32_t, 4> place{};  ///< first texel; texels from root to root along y and z; levels
};
static_assert(sizeof(EngineConstants) == 80);

/// Returns the map of patches of a collider with one map.
/// Errors: kUsage (several maps, or a map of another format).
[[nodiscard]] Result<const DepthMap*> engineMap(const Collider& collider);

/// \param map  of patches. \param first  index of its first texel in the texture.
[[nodiscard]] EngineConstants engineConstants(const DepthMap& map, std::uint32_t first = 0);

/// Returns the constants of a collider in world space: the rows transform world space to map space.
[[nodiscard]] EngineConstants placedConstants(const EngineConstants& constants, const Pose& pose);

/// Appends zeros up to a whole row of a texture.
/// \param row  bytes.
void fillRow(std::vector<std::byte>& texels, std::size_t row = kEngineTextureWidth * kEngineTexelBytes);

}  // namespace relief
