// SPDX-License-Identifier: Apache-2.0
// The invariants of a collider, as formats/README.md words them. The container's writer and its reader both
// use them, so that whatever is written can be read back.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/issue.h"

namespace relief {

inline constexpr std::size_t kMeshNameMax = 255;  ///< bytes, as are the next three
inline constexpr std::size_t kUnitMax = 16;
inline constexpr std::size_t kToolVersionMax = 64;
inline constexpr std::size_t kOptionsMax = std::size_t{1} << 20;
inline constexpr float kUnitLengthTolerance = 1e-3F;    ///< of a float texel's normal
inline constexpr double kFrameCosineMax = 1e-4;         ///< between any two of T's rows, either sign
inline constexpr double kObjectPerMapTolerance = 1e-3;  ///< relative, against the inverse of T

// All Results fail with kInvalidInput, or with kLimit for a map of too many texels. A message names the field
// and its value; the functions for one map leave the map's index to the caller.

/// Faults of bounds (first), unit, provenance and materials.
[[nodiscard]] std::vector<Issue> descriptionIssues(const Collider& collider);

/// All of a map but its texels, which may be missing.
[[nodiscard]] Result<void> validateFrame(const DepthMap& map);

/// The texels of a map whose frame is valid.
[[nodiscard]] Result<void> validateTexels(const DepthMap& map);

/// All of the above, and that there is at least one map. Messages name the map ("map 3: …").
[[nodiscard]] Result<void> validate(const Collider& collider);

/// The error of one map with its index in front.
[[nodiscard]] Error inMap(std::size_t index, const Error& error);

/// The name of a mesh in a container, and of its file in a scene's render.meshes: cleanUtf8 with '_' for '/' and '\', at most
/// kMeshNameMax bytes. The name of a node may look like a path.
[[nodiscard]] std::string storedMeshName(std::string name);

/// Well-formed UTF-8 (no overlong forms, no surrogates) without control characters.
[[nodiscard]] bool isPlainText(std::string_view text);

}  // namespace relief
