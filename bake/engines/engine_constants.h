// SPDX-License-Identifier: Apache-2.0
// Converts colliders to the texels and constants that shaders/engines/relief.glsl reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/patch_constants.h"
#include "formats/patch_tree.h"
#include "formats/world/pose.h"

namespace relief {

/// Width of the texture, texels.
inline constexpr std::uint32_t kEngineTextureWidth = 2048;
/// Maximum number of texels: 16,384 rows.
inline constexpr std::size_t kEngineTexelsMax = std::size_t{kEngineTextureWidth} * 16384;

/// Returns the patch map of a collider that has no other map.
/// Errors: kUsage (several maps, or a map of another format).
[[nodiscard]] Result<const DepthMap*> engineMap(const Collider& collider);

/// Returns the constants of a placed collider: `row` then transforms world space to map space.
[[nodiscard]] PatchConstants placedConstants(PatchConstants constants, const Pose& pose);

/// Pads texels with zeros to a whole number of texture rows.
/// \param row  bytes per row.
void fillRow(std::vector<std::byte>& texels, std::size_t row = kEngineTextureWidth * kPatchTexelBytes);

}  // namespace relief
